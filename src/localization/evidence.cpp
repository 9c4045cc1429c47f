// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

bool IsWall(const OccupancyGrid& grid, const Eigen::Vector2d& point_in_world) {
  const double column = std::floor((point_in_world.x() - grid.origin_x) / grid.resolution_m);
  const double row = std::floor((point_in_world.y() - grid.origin_y) / grid.resolution_m);
  if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height)) return false;
  return grid.at(static_cast<int>(column), static_cast<int>(row)) == Cell::kOccupied;
}

constexpr PatchFit kFits = 50;   // percent, from which on a patch agrees: within 0.18 m of a wall
constexpr PatchFit kClear = 20;  // percent, by which a patch speaks for one of two places
constexpr double kKnownShare = 0.6;  // of a patch's points, of which the map must say something

// Beams went where the map has a wall. That they went where it has none tells next to nothing
// alone, but tells two places apart.
PatchFit FitOfFree(const Patch& patch, const SearchableFloor& floor, const Pose2& T_world_odom) {
  constexpr double kWallShare =
      0.2;  // of the lattice's points of a square metre that a wall crosses
  int walls = 0;
  int seen = 0;
  const PointTransform to_world(T_world_odom);
  for (const Eigen::Vector2d& point : patch.points_in_odom) {
    const Eigen::Vector2d in_world = to_world * point;
    seen += floor.IsSeen(in_world) ? 1 : 0;
    walls += IsWall(floor.seen(), in_world) ? 1 : 0;
  }
  const auto count = static_cast<double>(patch.points_in_odom.size());
  if (walls >= kWallShare * count) return 0;
  return seen >= kKnownShare * count && walls == 0 ? kFreeAsSeen : kMapSaysNothing;
}

}  // namespace

PatchFit FitOf(const Patch& patch, const SearchableFloor& floor, const Pose2& T_world_odom) {
  if (patch.is_free) return FitOfFree(patch, floor, T_world_odom);
  double sum = 0.0;
  int known = 0;
  const PointTransform to_world(T_world_odom);
  for (const Eigen::Vector2d& point : patch.points_in_odom) {
    const Eigen::Vector2d in_world = to_world * point;
    // Behind a wall that was seen from one side the map knows nothing.
    if (!floor.IsSeen(in_world)) continue;
    sum += floor.fine().ValueAt(in_world);
    ++known;
  }
  if (known < kKnownShare * static_cast<double>(patch.points_in_odom.size())) {
    return kMapSaysNothing;
  }
  return static_cast<PatchFit>(100.0 * sum / known);
}

bool FitsBetter(const LaserScan& scan, const SearchableFloor& floor, const Pose2& T_world_robot,
                const Pose2& T_world_other) {
  // Where the map says nothing a patch fits neither well nor badly.
  const auto percent = [&](const Patch& patch, const Pose2& T_world) {
    const PatchFit fit = FitOf(patch, floor, T_world);
    return int{fit == kMapSaysNothing ? kFits : fit};
  };
  int lead = 0;
  for (const Patch& patch : HitsOf(scan, Pose2())) {
    lead += percent(patch, T_world_robot) - percent(patch, T_world_other);
  }
  return lead > 0;
}

void Tally::Add(PatchFit fit) {
  if (fit == kMapSaysNothing || fit == kFreeAsSeen) return;
  if (fit >= kFits) {
    ++agreeing;
  } else {
    ++contradicting;
  }
}

double NatsOf(const Tally& tally, double agrees_wrong, const EvidenceOptions& options) {
  const double right = options.agrees_in_place;
  return tally.agreeing * std::log(right / agrees_wrong) +
         tally.contradicting * std::log((1.0 - right) / (1.0 - agrees_wrong));
}

namespace {

// How likely it is that so many patches are of a share, and so many are not.
double NatsOfShare(const UnknownShare& share, int with, int without) {
  const auto log_beta = [](double a, double b) {
    return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  };
  return log_beta(share.with + with, share.without + without) - log_beta(share.with, share.without);
}

}  // namespace

double NatsOfWay(const Tally& tally, const EvidenceOptions& options) {
  const double wrong = options.agrees_elsewhere;
  return NatsOfShare(options.strays_in_place, tally.contradicting, tally.agreeing) -
         tally.agreeing * std::log(wrong) - tally.contradicting * std::log(1.0 - wrong);
}

void WayOffTheMap::Add(PatchFit fit, double at_m, const EvidenceOptions& options) {
  constexpr double kLook = 3.0;   // m
  constexpr int kLeast = 5;       // patches
  constexpr int kMuch = 20;       // patches, which tell before a look is over
  constexpr double kShare = 0.5;  // of them, of which the map says nothing: most
  if (at_m >= look_begins_m_ + kLook) {
    if (known_ + unknown_ >= kLeast) {
      const bool is_off = unknown_ > kShare * (known_ + unknown_);
      if (is_off) {
        nats_ += is_off_ ? kLook * std::log(1.0 - options.comes_back_per_m)
                         : std::log(kLook * options.leaves_map_per_m);
      }
      is_off_ = is_off;
    }
    look_begins_m_ = at_m;
    known_ = unknown_ = 0;
  }
  ++(fit == kMapSaysNothing ? unknown_ : known_);
  const int seen = known_ + unknown_;
  const bool leaves = !is_off_ && seen >= kMuch && unknown_ > kShare * seen;
  leaves_nats_ = leaves ? std::log(kLook * options.leaves_map_per_m) : 0.0;
}

double SlipNats(double slip_m, double way_m) {
  constexpr double kAtOnce = 0.1;      // m, standard deviation
  constexpr double kPerMetre = 0.005;  // m per m of the way
  constexpr double kMost = 4.0;        // standard deviations: more, and motion broke
  const double slip = std::min(kMost, slip_m / std::hypot(kAtOnce, kPerMetre * way_m));
  return -0.5 * slip * slip;
}

namespace {

/// What patches say of two places.
struct PairTally {
  int both = 0;       ///< agree at both
  int first = 0;      ///< at the first, not at the second
  int second = 0;     ///< at the second, not at the first
  int neither = 0;    ///< at none of the two
  Tally first_only;   ///< of those of which the map says nothing at the second
  Tally second_only;  ///< nothing at the first

  void Add(PatchFit one, PatchFit other);
  PairTally Swapped() const { return {both, second, first, neither, second_only, first_only}; }
};

void PairTally::Add(PatchFit one, PatchFit other) {
  if (other == kMapSaysNothing) return first_only.Add(one);
  if (one == kMapSaysNothing) return second_only.Add(other);
  if (one == kFreeAsSeen && other == kFreeAsSeen) return;
  // What fits both about as well tells nothing, wherever the line between them is drawn.
  const bool is_clear = std::abs(int{one} - int{other}) >= kClear;
  const bool agrees_first = (is_clear ? one : std::max(one, other)) >= kFits;
  const bool agrees_second = (is_clear ? other : std::max(one, other)) >= kFits;
  int& count = agrees_first ? (agrees_second ? both : first) : (agrees_second ? second : neither);
  ++count;
}

double Nats(const Tally& tally, double share_agreeing) {
  return tally.agreeing * std::log(share_agreeing) +
         tally.contradicting * std::log(1.0 - share_agreeing);
}

double LogSum(double a, double b) {
  const double most = std::max(a, b);
  return most + std::log(std::exp(a - most) + std::exp(b - most));
}

// How likely the patches are when the first place is right. What the second shows may have nothing
// to do with it, or it is a copy: of all places of a map, about one. Whether a copy is told apart
// by noise alone, or by what is really different, is open.
double NatsOfFirst(const PairTally& tally, const EvidenceOptions& options) {
  const double right = options.agrees_in_place;
  const Tally at_first{tally.both + tally.first, tally.second + tally.neither};
  const Tally at_second{tally.both + tally.second, tally.first + tally.neither};
  const double first = Nats(at_first, right) + Nats(tally.first_only, right);
  const double unrelated = first + Nats(at_second, options.agrees_elsewhere) +
                           Nats(tally.second_only, options.agrees_elsewhere);
  // Of copies, which of the two agrees is a question of its own. What only one of them shows goes
  // on to be a copy, or not, as what both show is one.
  const int different = tally.first + tally.second;
  const int alike = tally.both + tally.neither + tally.second_only.agreeing;
  const double seen = Nats({tally.both, tally.neither}, right) + Nats(tally.first_only, right) +
                      Nats(tally.second_only, right);
  const double by_noise =
      NatsOfShare(options.differs_by_noise, different, alike) + different * std::log(0.5);
  const double told_apart = NatsOfShare(options.differs_in_copies, different, alike) +
                            tally.first * std::log(options.speaks_for_right) +
                            tally.second * std::log(1.0 - options.speaks_for_right);
  return LogSum(unrelated, seen + LogSum(by_noise, told_apart) - options.copy_nats);
}

}  // namespace

double LeadOf(const std::vector<PatchFit>& one, const std::vector<PatchFit>& other,
              const EvidenceOptions& options) {
  PairTally tally;
  const std::size_t count = std::min(one.size(), other.size());
  for (std::size_t i = 0; i < count; ++i) tally.Add(one[i], other[i]);
  return NatsOfFirst(tally, options) - NatsOfFirst(tally.Swapped(), options);
}

}  // namespace masked_mapper
