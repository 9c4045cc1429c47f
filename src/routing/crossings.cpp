// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

/// Travel in transit above which it was no cab (as mapping has it, mapping_options.hpp).
constexpr double kLongestWayInCab = 3.0;  // m
/// A robot stands anywhere in a cab of two metres; two cabs stand further apart.
constexpr double kSameCab = 1.2;  // m
constexpr double kSameStairs = 1.5;

struct Passage {
  Stop from;
  Stop to;
  std::vector<Eigen::Vector2d> way;
  double travelled_m = 0.0;
};

/// The first pose of the floor's visit that is outside, going from `at` by `step`.
Eigen::Vector2d OutsideOf(const std::vector<TrajectoryPose>& poses, const IndexRange& range,
                          std::size_t at, int step) {
  constexpr double kOutside = 1.8;  // m: through the door of a cab that is entered to its middle
  std::size_t i = at;
  while (Distance(poses[i].T_world_robot, poses[at].T_world_robot) < kOutside) {
    if (step < 0 ? i == range.begin : i + 1 == range.end) break;
    const std::size_t next = step < 0 ? i - 1 : i + 1;
    if (poses[next].in_transit || poses[next].floor != poses[at].floor) break;
    i = next;
  }
  return poses[i].T_world_robot.Translation();
}

/// From floor to floor, in order of driving.
std::vector<Passage> PassagesOf(const BuildingMap& map) {
  std::vector<Passage> passages;
  const std::vector<TrajectoryPose>& poses = map.trajectory;
  for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
    const IndexRange range = PosesOfDrive(map, drive);
    std::optional<std::size_t> last;  // on a floor
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (poses[i].in_transit) continue;
      if (last && poses[*last].floor != poses[i].floor) {
        Passage passage;
        passage.from = {poses[*last].floor, poses[*last].T_world_robot,
                        OutsideOf(poses, range, *last, -1)};
        passage.to = {poses[i].floor, poses[i].T_world_robot, OutsideOf(poses, range, i, 1)};
        for (std::size_t at = *last; at <= i; ++at) {
          passage.way.push_back(poses[at].T_world_robot.Translation());
          if (at == *last) continue;
          passage.travelled_m += Distance(poses[at - 1].T_odom_robot, poses[at].T_odom_robot);
        }
        passages.push_back(std::move(passage));
      }
      last = i;
    }
  }
  return passages;
}

const Stop* StopOn(const Crossing& crossing, FloorId floor) {
  for (const Stop& stop : crossing.stops) {
    if (stop.floor == floor) return &stop;
  }
  return nullptr;
}

bool IsNear(const Stop& a, const Stop& b, double reach_m) {
  return Distance(a.T_world_robot, b.T_world_robot) <= reach_m;
}

/// Whether two cabs stood at one place of the plan, on whatever floors: a shaft has one cab.
bool IsSameCab(const Crossing& a, const Crossing& b) {
  return std::any_of(a.stops.begin(), a.stops.end(), [&](const Stop& stop) {
    return std::any_of(b.stops.begin(), b.stops.end(),
                       [&](const Stop& other) { return IsNear(stop, other, kSameCab); });
  });
}

void AddRide(const Passage& passage, std::vector<Crossing>& crossings) {
  Crossing cab;
  cab.stops = {passage.from, passage.to};
  // It may be the ride that shows that two cabs of before are one.
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < crossings.size();) {
    if (crossings[i].kind != CrossingKind::kElevator || !IsSameCab(crossings[i], cab)) {
      ++i;
      continue;
    }
    if (!first) {
      first = i++;
      continue;
    }
    for (const Stop& stop : crossings[i].stops) {
      if (StopOn(crossings[*first], stop.floor) == nullptr) crossings[*first].stops.push_back(stop);
    }
    crossings.erase(crossings.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (!first) {
    crossings.push_back(std::move(cab));
    return;
  }
  for (const Stop& stop : cab.stops) {
    if (StopOn(crossings[*first], stop.floor) == nullptr) crossings[*first].stops.push_back(stop);
  }
}

void AddStairs(Passage passage, std::vector<Crossing>& crossings) {
  for (const Crossing& known : crossings) {
    if (known.kind != CrossingKind::kStairs) continue;
    const Stop* const from = StopOn(known, passage.from.floor);
    const Stop* const to = StopOn(known, passage.to.floor);
    if (from != nullptr && to != nullptr && IsNear(*from, passage.from, kSameStairs) &&
        IsNear(*to, passage.to, kSameStairs)) {
      return;
    }
  }
  Crossing stairs;
  stairs.kind = CrossingKind::kStairs;
  stairs.stops = {passage.from, passage.to};
  stairs.way = std::move(passage.way);
  crossings.push_back(std::move(stairs));
}

}  // namespace

std::vector<Crossing> CrossingsOf(const BuildingMap& map) {
  std::vector<Crossing> crossings;
  for (Passage& passage : PassagesOf(map)) {
    if (passage.travelled_m <= kLongestWayInCab) {
      AddRide(passage, crossings);
    } else {
      AddStairs(std::move(passage), crossings);
    }
  }
  const auto elevation = [&](const Stop& stop) { return map.graph.floor(stop.floor).elevation; };
  for (Crossing& crossing : crossings) {
    const FloorId first = crossing.stops.front().floor;
    std::stable_sort(crossing.stops.begin(), crossing.stops.end(),
                     [&](const Stop& a, const Stop& b) { return elevation(a) < elevation(b); });
    if (!crossing.way.empty() && crossing.stops.front().floor != first) {
      std::reverse(crossing.way.begin(), crossing.way.end());
    }
  }
  return crossings;
}

}  // namespace masked_mapper
