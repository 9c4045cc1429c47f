// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/piece_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "masked_mapper/geometry/rigid_alignment.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/map/surroundings.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/scan_matching/correlative_search.hpp"
#include "masked_mapper/scan_matching/floor_search.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"

namespace masked_mapper {
namespace {

constexpr double kSameHeight = 1.2;   // m; well below a storey, well above what a barometer drifts
constexpr double kScanEvery = 0.5;    // m of travel between scans that make a floor or a place
constexpr double kFineStretch = 2.0;  // m of travel to either side, of what is held against the map
constexpr double kFloorSpacing = 0.1;        // m between points of a floor
constexpr double kFarthest = 1e4;            // m, from the origin
constexpr std::size_t kPlacesPerFloor = 60;  // looked at for a guess
constexpr std::size_t kMostGuesses = 40;     // looked at
constexpr double kSeenCell = 0.2;            // m
constexpr double kLeastShared = 40;   // points of a place where the older piece has seen something
constexpr double kLeastShare = 0.3;   // and of all its points
constexpr double kLeastCoarse = 0.2;  // of score, below which next to nothing is shared
constexpr double kAlike = 0.08;       // of score, within which two fits of a place are both kept
constexpr double kSameShiftM = 2.0;   // two guesses that differ by less are one
constexpr double kSameTurnDeg = 6.0;

/// Fine enough to tell rooms that only nearly look alike, and of what is near: a floor bends.
FloorSearchOptions FineOptions(const FloorSearchOptions& coarse) {
  FloorSearchOptions fine = coarse;
  fine.resolution_m = 0.1;
  fine.sigma_m = 0.15;
  fine.angle_step_deg = 0.5;
  fine.point_spacing_m = 0.3;
  fine.max_range_m = 12.0;
  fine.min_score = 0.0;
  return fine;
}

/// A floor of the older piece.
struct OldFloor {
  FloorId id = 0;
  std::unique_ptr<FloorSearch> coarse;
  std::unique_ptr<FloorSearch> fine;
  OccupancyGrid seen;
};

/// What the newer piece saw around one of its nodes.
struct Place {
  NodeId node = 0;
  FloorId floor = 0;
  Pose2 T_world_place;
  std::vector<Eigen::Vector2d> coarse_points;  ///< in the place's frame
  std::vector<Eigen::Vector2d> fine_points;
};

struct Guess {
  std::map<FloorId, FloorId> older_floor_of;
  Pose2 T_older_newer;
  int votes = 0;
  std::vector<std::optional<double>> score_of_place;  ///< empty: not within the older piece
  int fitting = 0;
  int within = 0;
  double spread_m = 0.0;
  bool is_valid = false;
};

class PieceFinder {
 public:
  PieceFinder(const BuildingMap& map, const DriveJoinOptions& options,
              const MatcherOptions& matcher)
      : map_(map), matcher_(matcher), joins_(options) {}

  PieceSearchResult Find(const std::vector<std::size_t>& older,
                         const std::vector<std::size_t>& newer) {
    ReadPlaces(newer);
    if (places_.empty()) return {std::nullopt, "no place of it was seen well enough"};
    ReadFloors(older);
    std::vector<Guess> guesses = MakeGuesses();
    if (guesses.empty()) return {std::nullopt, "none of its places was found in the map"};
    ForEach(guesses.size(), matcher_.threads, [&](std::size_t i) { LookAt(guesses[i]); });
    return Decide(guesses);
  }

 private:
  const Node& At(NodeId node) const { return map_.graph.nodes()[static_cast<std::size_t>(node)]; }
  const Floor& FloorAt(FloorId floor) const {
    return map_.graph.floors()[static_cast<std::size_t>(floor)];
  }
  const OldFloor& OldFloorOf(FloorId floor) const {
    return *std::find_if(floors_.begin(), floors_.end(),
                         [&](const OldFloor& known) { return known.id == floor; });
  }

  // Kept scans of a drive, as indices.
  IndexRange KeptOf(std::size_t drive) const {
    const IndexRange poses = PosesOfDrive(map_, drive);
    const auto first = [&](std::size_t pose) {
      return static_cast<std::size_t>(std::lower_bound(map_.kept_scans.begin(),
                                                       map_.kept_scans.end(), pose,
                                                       [](const KeptScan& kept, std::size_t index) {
                                                         return kept.trajectory_index < index;
                                                       }) -
                                      map_.kept_scans.begin());
    };
    return {first(poses.begin), first(poses.end)};
  }

  ScanPoints::ConstPtr StretchAround(NodeId node, double half_length_m) const {
    return PointsAround(map_, node, {half_length_m, kScanEvery, LaidOutBy::kOptimisation},
                        joins_.search.max_range_m);
  }

  const TrajectoryPose& PoseOf(std::size_t kept) const {
    return map_.trajectory[map_.kept_scans[kept].trajectory_index];
  }

  void ReadFloors(const std::vector<std::size_t>& drives) {
    std::map<FloorId, ScanPoints> points;
    std::map<FloorId, std::vector<PosedScan>> scans;
    for (const std::size_t drive : drives) {
      const IndexRange kept = KeptOf(drive);
      std::optional<Pose2> T_world_before;
      for (std::size_t i = kept.begin; i < kept.end; ++i) {
        const TrajectoryPose& pose = PoseOf(i);
        if (T_world_before && Distance(*T_world_before, pose.T_world_robot) < kScanEvery) continue;
        T_world_before = pose.T_world_robot;
        if (pose.in_transit || pose.T_world_robot.Translation().norm() > kFarthest) continue;
        AppendTransformed(*PointsInRobot(map_.kept_scans[i].scan), pose.T_world_robot,
                          matcher_.table.max_range_m, points[pose.floor]);
        scans[pose.floor].push_back({pose.T_world_robot, pose.floor, &map_.kept_scans[i].scan});
      }
    }
    GridOptions seen = joins_.seen;
    seen.resolution_m = kSeenCell;
    seen.min_hits = 1;
    seen.threads = matcher_.threads;
    for (const auto& [floor, cloud] : points) {
      const ScanPoints::ConstPtr thinned =
          AsScanPoints(ThinPoints(cloud, kFloorSpacing, 2.0 * kFarthest));
      OldFloor known;
      known.id = floor;
      known.coarse = std::make_unique<FloorSearch>(*thinned, joins_.search);
      if (!known.coarse->HasFloor()) continue;
      known.fine = std::make_unique<FloorSearch>(*thinned, FineOptions(joins_.search));
      known.seen = RenderGrid(scans[floor], floor, seen);
      floors_.push_back(std::move(known));
    }
  }

  void ReadPlaces(const std::vector<std::size_t>& drives) {
    std::map<FloorId, std::vector<NodeId>> nodes;
    for (const std::size_t drive : drives) {
      const IndexRange range = NodesOfDrive(map_, drive);
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const Node& node = map_.graph.nodes()[i];
        if (!node.HasScan() || node.T_world_robot.Translation().norm() > kFarthest) continue;
        auto& taken = nodes[node.floor];
        const bool is_far = std::all_of(taken.begin(), taken.end(), [&](NodeId other) {
          return Distance(At(other).T_world_robot, node.T_world_robot) > joins_.place_spacing_m;
        });
        if (is_far) taken.push_back(static_cast<NodeId>(i));
      }
    }
    const FloorSearch coarse({}, joins_.search);
    const FloorSearch fine({}, FineOptions(joins_.search));
    for (const auto& [floor, taken] : nodes) {
      const std::size_t step = (taken.size() + kPlacesPerFloor - 1) / kPlacesPerFloor;
      for (std::size_t i = 0; i < taken.size(); i += step) {
        const NodeId node = taken[i];
        Place place{node, floor, At(node).T_world_robot,
                    coarse.Thinned(*StretchAround(node, joins_.stretch_m)),
                    fine.Thinned(*StretchAround(node, kFineStretch))};
        constexpr std::size_t kLeastPoints = 20;
        if (place.coarse_points.size() >= kLeastPoints) places_.push_back(std::move(place));
      }
    }
  }

  bool MayBeOne(FloorId older, FloorId newer) const {
    const Floor& one = FloorAt(older);
    const Floor& other = FloorAt(newer);
    return !(one.label_given && other.label_given) || one.label == other.label;
  }

  // Heights are compared where both were measured, and neither floor's label says more.
  bool HeightsCount(FloorId older, FloorId newer) const {
    const Floor& one = FloorAt(older);
    const Floor& other = FloorAt(newer);
    return one.elevation_measured && other.elevation_measured &&
           !(one.label_given && other.label_given);
  }

  // The pairing of floors that follows from one pair; floors whose heights say nothing stay out.
  std::map<FloorId, FloorId> PairingFrom(FloorId older, FloorId newer) const {
    std::map<FloorId, FloorId> pairing{{newer, older}};
    std::set<FloorId> taken{older};
    std::set<FloorId> newer_floors;
    for (const Place& place : places_) newer_floors.insert(place.floor);
    const double shift = FloorAt(older).elevation - FloorAt(newer).elevation;
    for (const FloorId floor : newer_floors) {
      if (floor == newer) continue;
      std::optional<FloorId> best;
      double smallest = kSameHeight;
      for (const OldFloor& known : floors_) {
        if (taken.count(known.id) != 0 || !MayBeOne(known.id, floor)) continue;
        if (FloorAt(known.id).label_given && FloorAt(floor).label_given) {
          best = known.id;
          break;
        }
        if (!HeightsCount(older, newer) || !HeightsCount(known.id, floor)) continue;
        const double off = std::abs(FloorAt(known.id).elevation - FloorAt(floor).elevation - shift);
        if (off >= smallest) continue;
        smallest = off;
        best = known.id;
      }
      if (!best) continue;
      pairing[floor] = *best;
      taken.insert(*best);
    }
    return pairing;
  }

  // Whether the heights leave it open which floor this one is.
  bool IsOpen(const Guess& guess, FloorId newer) const {
    if (guess.older_floor_of.count(newer) != 0) return false;
    return std::any_of(floors_.begin(), floors_.end(), [&](const OldFloor& known) {
      return MayBeOne(known.id, newer) && !HeightsCount(known.id, newer);
    });
  }

  // A few places, evenly over all of them, are looked for on every floor that they may be on.
  std::vector<Guess> MakeGuesses() const {
    const auto most = static_cast<std::size_t>(joins_.searched_places);
    const std::size_t step = std::max<std::size_t>(1, (places_.size() + most - 1) / most);
    struct Search {
      const Place* place;
      const OldFloor* floor;
      std::optional<PlaceFit> fit;
    };
    std::vector<Search> searches;
    for (std::size_t i = 0; i < places_.size(); i += step) {
      for (const OldFloor& floor : floors_) {
        if (MayBeOne(floor.id, places_[i].floor)) searches.push_back({&places_[i], &floor, {}});
      }
    }
    ForEach(searches.size(), matcher_.threads, [&](std::size_t i) {
      searches[i].fit = searches[i].floor->coarse->Find(searches[i].place->coarse_points);
    });
    std::map<const Place*, double> best;
    for (const Search& search : searches) {
      if (search.fit) best[search.place] = std::max(best[search.place], search.fit->score);
    }
    std::vector<Guess> guesses;
    for (const Search& search : searches) {
      if (!search.fit || search.fit->score < best[search.place] - kAlike) continue;
      Guess guess;
      guess.older_floor_of = PairingFrom(search.floor->id, search.place->floor);
      guess.T_older_newer = search.fit->T_world_place * Inverse(search.place->T_world_place);
      const auto same = std::find_if(guesses.begin(), guesses.end(), [&](const Guess& known) {
        return known.older_floor_of == guess.older_floor_of &&
               AreNear(known.T_older_newer, guess.T_older_newer, search.place->T_world_place);
      });
      Guess& counted = same == guesses.end() ? guesses.emplace_back(std::move(guess)) : *same;
      ++counted.votes;
    }
    std::stable_sort(guesses.begin(), guesses.end(),
                     [](const Guess& a, const Guess& b) { return a.votes > b.votes; });
    if (guesses.size() > kMostGuesses) guesses.resize(kMostGuesses);
    return guesses;
  }

  // About a place: a small turn is a long way far off.
  static bool AreNear(const Pose2& T_one, const Pose2& T_other, const Pose2& T_world_place) {
    return Distance(T_one * T_world_place, T_other * T_world_place) < kSameShiftM &&
           std::abs(WrapAngle(T_one.theta - T_other.theta)) < DegToRad(kSameTurnDeg);
  }

  static bool IsSeen(const OccupancyGrid& grid, const Eigen::Vector2d& point) {
    const double column = std::floor((point.x() - grid.origin_x) / grid.resolution_m);
    const double row = std::floor((point.y() - grid.origin_y) / grid.resolution_m);
    if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height)) return false;
    return grid.at(static_cast<int>(column), static_cast<int>(row)) != Cell::kUnknown;
  }

  // The place near a guess, and its score by those of its points that lie where the older piece has
  // seen something: drives share a part of their ways only. Empty when those are too few.
  std::optional<PlaceFit> FitOf(const Place& place, FloorId older, const Pose2& T_older_newer,
                                double within_m) const {
    const OldFloor& floor = OldFloorOf(older);
    constexpr double kWithinDeg = 4.0;
    constexpr double kFineM = 0.5;
    constexpr double kFineDeg = 2.0;
    const PlaceFit coarse = floor.coarse->FindNear(
        place.coarse_points, T_older_newer * place.T_world_place, within_m, kWithinDeg);
    PlaceFit fit = coarse;
    if (coarse.score >= kLeastCoarse) {
      fit = floor.fine->FindNear(place.fine_points, coarse.T_world_place, kFineM, kFineDeg);
    }
    double sum = 0.0;
    std::size_t shared = 0;
    for (const Eigen::Vector2d& point : place.fine_points) {
      const Eigen::Vector2d in_world = fit.T_world_place * point;
      const double value = floor.fine->ValueAt(in_world);
      if (value == 0.0 && !IsSeen(floor.seen, in_world)) continue;
      sum += value;
      ++shared;
    }
    if (static_cast<double>(shared) <
        std::max(kLeastShared, kLeastShare * static_cast<double>(place.fine_points.size()))) {
      return std::nullopt;
    }
    fit.score = sum / static_cast<double>(shared);
    return fit;
  }

  // Finds every place near where the guess puts it, and the guess anew from all of those.
  void LookAt(Guess& guess) const {
    constexpr int kRounds = 3;
    constexpr std::size_t kFewPlaces = 24;
    constexpr std::size_t kLeastAgreeing = 2;
    constexpr double kWithinM = 2.0;  // floors bend, and the guess comes from one place
    // Most guesses are wrong, which a few places tell.
    const std::size_t few = std::max<std::size_t>(1, places_.size() / kFewPlaces);
    for (int round = 0; round < kRounds; ++round) {
      if (round == 1) PairOpenFloors(guess);
      const std::size_t step = round == 0 ? few : 1;
      std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
      std::vector<std::size_t> fitting;
      std::vector<PlaceFit> fits(places_.size());
      guess.score_of_place.assign(places_.size(), std::nullopt);
      for (std::size_t i = 0; i < places_.size(); i += step) {
        const auto older = guess.older_floor_of.find(places_[i].floor);
        if (older == guess.older_floor_of.end()) continue;
        const std::optional<PlaceFit> fit =
            FitOf(places_[i], older->second, guess.T_older_newer, kWithinM);
        if (!fit) continue;
        guess.score_of_place[i] = fit->score;
        fits[i] = *fit;
        if (fit->score < joins_.min_score) continue;
        fitting.push_back(i);
        pairs.emplace_back(fit->T_world_place.Translation(),
                           places_[i].T_world_place.Translation());
      }
      guess.within =
          static_cast<int>(std::count_if(guess.score_of_place.begin(), guess.score_of_place.end(),
                                         [](const auto& score) { return score.has_value(); }));
      constexpr std::size_t kLeastToAlign = 3;
      if (pairs.size() >= kLeastToAlign && SpreadOf(fitting) > joins_.min_spread_m) {
        guess.T_older_newer = AlignRigidly(pairs);
      }
      std::vector<std::size_t> agreeing;
      for (const std::size_t i : fitting) {
        const bool agrees = Distance(guess.T_older_newer * places_[i].T_world_place,
                                     fits[i].T_world_place) <= joins_.agree_m;
        if (agrees) agreeing.push_back(i);
      }
      if (round == 0 && agreeing.size() < kLeastAgreeing) return;
      guess.fitting = static_cast<int>(agreeing.size());
      guess.spread_m = SpreadOf(agreeing);
    }
    guess.is_valid = guess.fitting >= joins_.min_places &&
                     guess.fitting >= joins_.min_share * guess.within &&
                     guess.spread_m >= joins_.min_spread_m;
  }

  // Floors that heights do not tell: the older floor that most of their places fit.
  void PairOpenFloors(Guess& guess) const {
    std::map<FloorId, std::vector<const Place*>> open;
    for (const Place& place : places_) {
      if (IsOpen(guess, place.floor)) open[place.floor].push_back(&place);
    }
    for (const auto& [newer, places] : open) {
      std::optional<FloorId> best;
      int most = joins_.min_places - 1;
      for (const OldFloor& floor : floors_) {
        const bool is_taken =
            std::any_of(guess.older_floor_of.begin(), guess.older_floor_of.end(),
                        [&](const auto& pair) { return pair.second == floor.id; });
        if (is_taken || !MayBeOne(floor.id, newer)) continue;
        int within = 0;
        int fitting = 0;
        for (const Place* place : places) {
          const auto fit = FitOf(*place, floor.id, guess.T_older_newer, joins_.agree_m);
          within += fit ? 1 : 0;
          fitting += fit && fit->score >= joins_.min_score ? 1 : 0;
        }
        if (fitting <= most || fitting < joins_.min_share * within) continue;
        most = fitting;
        best = floor.id;
      }
      if (best) guess.older_floor_of[newer] = *best;
    }
  }

  double SpreadOf(const std::vector<std::size_t>& places) const {
    double spread = 0.0;
    for (const std::size_t one : places) {
      for (const std::size_t other : places) {
        spread =
            std::max(spread, Distance(places_[one].T_world_place, places_[other].T_world_place));
      }
    }
    return spread;
  }

  // Places that fit the one clearly better, less those that fit the other clearly better; of those
  // that both speak of.
  int LeadOf(const Guess& best, const Guess& other, int* shared) const {
    int lead = 0;
    *shared = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!best.score_of_place[i] || !other.score_of_place[i]) continue;
      ++*shared;
      const double difference = *best.score_of_place[i] - *other.score_of_place[i];
      lead += difference > joins_.clear_lead ? 1 : difference < -joins_.clear_lead ? -1 : 0;
    }
    return lead;
  }

  bool IsSame(const Guess& one, const Guess& other) const {
    if (one.older_floor_of != other.older_floor_of) return false;
    return std::all_of(places_.begin(), places_.end(), [&](const Place& place) {
      return one.older_floor_of.count(place.floor) == 0 ||
             AreNear(one.T_older_newer, other.T_older_newer, place.T_world_place);
    });
  }

  static std::string Count(const Guess& guess) {
    return std::to_string(guess.fitting) + " of " + std::to_string(guess.within) + " places";
  }

  PieceSearchResult Decide(std::vector<Guess>& guesses) const {
    const auto sum = [](const Guess& guess) {
      double all = 0.0;
      for (const auto& score : guess.score_of_place) all += score.value_or(0.0);
      return all;
    };
    std::stable_sort(guesses.begin(), guesses.end(), [&](const Guess& a, const Guess& b) {
      return std::make_tuple(a.is_valid, a.fitting, sum(a)) >
             std::make_tuple(b.is_valid, b.fitting, sum(b));
    });
    const Guess& best = guesses.front();
    if (!best.is_valid) {
      return {std::nullopt, "its places do not agree: at best " + Count(best) + " fit alike"};
    }
    for (std::size_t i = 1; i < guesses.size(); ++i) {
      const Guess& other = guesses[i];
      if (!other.is_valid || IsSame(best, other)) continue;
      int shared = 0;
      const int lead = LeadOf(best, other, &shared);
      const bool is_behind = shared > 0 ? 2 * lead >= shared && lead >= joins_.min_places
                                        : 2 * other.fitting < best.fitting;
      if (is_behind) continue;
      return {std::nullopt, "it fits in more than one way: " + Count(best) + " fit one, " +
                                Count(other) + " another"};
    }
    PiecePlacement placement{best.T_older_newer, best.older_floor_of, best.fitting, best.within};
    return {placement, Count(best) + " fit"};
  }

  const BuildingMap& map_;
  const MatcherOptions& matcher_;
  const DriveJoinOptions& joins_;
  std::vector<OldFloor> floors_;
  std::vector<Place> places_;
};

}  // namespace

PieceSearchResult FindPiece(const BuildingMap& map, const std::vector<std::size_t>& older,
                            const std::vector<std::size_t>& newer, const DriveJoinOptions& options,
                            const MatcherOptions& matcher) {
  return PieceFinder(map, options, matcher).Find(older, newer);
}

}  // namespace masked_mapper
