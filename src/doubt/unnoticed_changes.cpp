// SPDX-License-Identifier: BSD-3-Clause
// A robot that drove through walls it saw on another visit was on two floors of one plan, or a door
// was opened. Two floors have a way between them that was driven between the two visits: stairs of
// two flights, among near walls up to a landing and back beside the way in, not on it as in a room;
// or a cab whose doors were not seen to move.
#include "masked_mapper/doubt/doubt.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "visit_agreement.hpp"
#include "wall_crossings.hpp"

namespace masked_mapper {
namespace {

constexpr double kFarthestSeen = 10.0;  // m; through an open door, or past all echoes, is no matter
constexpr double kMostSeen = 30.0;      // m^2 of a scan: two flights and the landing
constexpr double kShortest = 4.0;       // m driven
constexpr double kLongest = 60.0;       // m
constexpr double kLeastTurn = 135.0;    // deg from the way in to the way out
constexpr double kMostBeside = 3.0;     // m from where the stairs began to where they ended
constexpr double kLeastBeside = 0.8;    // m between the flights, at least a wall
constexpr double kFlight = 0.35;        // of the way at either end
constexpr double kCabSeen = 15.0;       // m^2 of a scan in a cab and through its open door
constexpr double kCab = 0.5;            // m moved in it
constexpr double kShortestRide = 8.0;   // s

/// Visits from `begin` to before `end`, one after the other on one floor.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// What may have been the way to another floor.
struct Passage {
  Stretch visits;
  TimeSpan span;
};

/// Two visits that cannot have been to one floor.
struct Contradiction {
  std::size_t earlier = 0;
  std::size_t later = 0;
};

double SeenArea(const LaserScan& scan) {
  double squares = 0.0;
  for (const float range : scan.ranges) {
    if (std::isnan(range)) continue;
    const double seen = std::min<double>(range, kFarthestSeen);
    squares += seen * seen;
  }
  return 0.5 * squares * std::abs(scan.angle_step);
}

std::vector<Stretch> StretchesAmongNearWalls(const BuildingMap& map,
                                             const std::vector<Visit>& visits) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (SeenArea(map.kept_scans[visits[i].kept].scan) > kMostSeen) continue;
    const bool goes_on = !stretches.empty() && stretches.back().end == i &&
                         visits[i].floor == visits[i - 1].floor &&
                         visits[i].drive == visits[i - 1].drive;
    if (!goes_on) stretches.push_back({i, i});
    stretches.back().end = i + 1;
  }
  return stretches;
}

/// By the motion alone: what is wrongly closed bends the map.
bool LeadsUpAndBack(const BuildingMap& map, const std::vector<Visit>& visits,
                    const Stretch& stretch) {
  const double before = visits[stretch.begin].travelled_m;
  const double driven = visits[stretch.end - 1].travelled_m - before;
  if (driven < kShortest || driven > kLongest) return false;
  const auto pose_of = [&](std::size_t visit) -> const Pose2& {
    return map.trajectory[map.kept_scans[visits[visit].kept].trajectory_index].T_odom_robot;
  };
  const Pose2 T_in_out = Between(pose_of(stretch.begin), pose_of(stretch.end - 1));
  if (std::abs(T_in_out.theta) < DegToRad(kLeastTurn) ||
      T_in_out.Translation().norm() > kMostBeside) {
    return false;
  }
  for (std::size_t in = stretch.begin; in < stretch.end; ++in) {
    if (visits[in].travelled_m - before > kFlight * driven) break;
    for (std::size_t out = stretch.end - 1; out > in; --out) {
      if (visits[out].travelled_m - before < (1.0 - kFlight) * driven) break;
      if (Distance(pose_of(in), pose_of(out)) < kLeastBeside) return false;
    }
  }
  return true;
}

std::vector<Passage> StairsOfTwoFlights(const BuildingMap& map, const std::vector<Visit>& visits) {
  std::vector<Passage> stairs;
  for (const Stretch& stretch : StretchesAmongNearWalls(map, visits)) {
    if (!LeadsUpAndBack(map, visits, stretch)) continue;
    const auto stamp_of = [&](std::size_t visit) {
      return map.kept_scans[visits[visit].kept].scan.stamp;
    };
    stairs.push_back({stretch, {stamp_of(stretch.begin), stamp_of(stretch.end - 1)}});
  }
  return stairs;
}

/// Where the robot stood among walls as near as those of a cab.
std::vector<Passage> StandsAsInACab(const BuildingMap& map, const std::vector<Visit>& visits) {
  std::vector<Passage> cabs;
  const std::vector<TrajectoryPose>& poses = map.trajectory;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (!cabs.empty() && i < cabs.back().visits.end) continue;
    if (SeenArea(map.kept_scans[visits[i].kept].scan) > kCabSeen) continue;
    const std::size_t first = map.kept_scans[visits[i].kept].trajectory_index;
    std::size_t last = first;
    while (last + 1 < poses.size() && poses[last + 1].floor == visits[i].floor &&
           !poses[last + 1].in_transit &&
           Distance(poses[first].T_odom_robot, poses[last + 1].T_odom_robot) <= kCab) {
      ++last;
    }
    if (poses[last].stamp - poses[first].stamp < kShortestRide) continue;
    Stretch stretch{i, i + 1};
    while (stretch.end < visits.size() &&
           map.kept_scans[visits[stretch.end].kept].trajectory_index <= last) {
      ++stretch.end;
    }
    cabs.push_back({stretch, {poses[first].stamp, poses[last].stamp}});
  }
  return cabs;
}

/// Of each crossing the visits next to it in time: what lies between these lies between all.
std::vector<Contradiction> ContradictionsOf(const std::vector<WallCrossing>& crossings) {
  std::vector<Contradiction> contradictions;
  for (const WallCrossing& crossing : crossings) {
    const std::vector<std::size_t>& seen = crossing.seen;
    const auto after = std::upper_bound(seen.begin(), seen.end(), crossing.driven);
    if (static_cast<std::size_t>(after - seen.begin()) >= kLeastSeen) {
      contradictions.push_back({*(after - 1), crossing.driven});
    }
    if (static_cast<std::size_t>(seen.end() - after) >= kLeastSeen) {
      contradictions.push_back({crossing.driven, *after});
    }
  }
  return contradictions;
}

bool Parts(const Passage& passage, const Contradiction& contradiction) {
  return contradiction.earlier < passage.visits.begin && contradiction.later >= passage.visits.end;
}

bool Overlap(const TimeSpan& one, const TimeSpan& other) {
  return one.start <= other.end && other.start <= one.end;
}

/// Takes out of `open` what is parted by the passages that part the most; these go into `found`.
void Settle(std::vector<Passage> passages, std::ptrdiff_t least_parted,
            std::vector<Contradiction>& open, std::vector<TimeSpan>& found) {
  while (!passages.empty()) {
    const auto parted_by = [&](const Passage& passage) {
      return std::count_if(open.begin(), open.end(),
                           [&](const Contradiction& one) { return Parts(passage, one); });
    };
    const Passage best = *std::max_element(passages.begin(), passages.end(),
                                           [&](const Passage& one, const Passage& other) {
                                             return parted_by(one) < parted_by(other);
                                           });
    if (parted_by(best) < least_parted) return;
    found.push_back(best.span);
    const auto is_settled = [&](const Contradiction& one) { return Parts(best, one); };
    open.erase(std::remove_if(open.begin(), open.end(), is_settled), open.end());
    const auto is_taken = [&](const Passage& one) { return Overlap(best.span, one.span); };
    passages.erase(std::remove_if(passages.begin(), passages.end(), is_taken), passages.end());
  }
}

std::vector<Passage> Unheard(std::vector<Passage> passages, const std::vector<TimeSpan>& heard) {
  const auto was_heard = [&](const Passage& passage) {
    return std::any_of(heard.begin(), heard.end(), [&](const TimeSpan& span) {
      return span.start <= passage.span.start && passage.span.end <= span.end;
    });
  };
  passages.erase(std::remove_if(passages.begin(), passages.end(), was_heard), passages.end());
  return passages;
}

}  // namespace

std::vector<TimeSpan> FindUnnoticedChanges(const BuildingMap& map,
                                           const std::vector<TimeSpan>& heard) {
  const std::vector<Visit> visits = VisitsOf(map);
  const std::vector<Passage> stairs = Unheard(StairsOfTwoFlights(map, visits), heard);
  const std::vector<Passage> cabs = Unheard(StandsAsInACab(map, visits), heard);
  if (stairs.empty() && cabs.empty()) return {};
  std::vector<Contradiction> open = ContradictionsOf(FindWallCrossings(map, visits));
  std::vector<TimeSpan> found;
  // Robots stand in many a narrow place, and one wall may be a door; flights of stairs are rare.
  // What these leave open is seen once the log is mapped with them.
  Settle(stairs, 1, open, found);
  if (found.empty()) Settle(cabs, 2, open, found);
  std::sort(found.begin(), found.end(),
            [](const TimeSpan& one, const TimeSpan& other) { return one.start < other.start; });
  return found;
}

}  // namespace masked_mapper
