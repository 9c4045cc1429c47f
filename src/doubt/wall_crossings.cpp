// SPDX-License-Identifier: BSD-3-Clause
#include "wall_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "masked_mapper/doubt/doubt.hpp"
#include "place_index.hpp"

namespace masked_mapper {
namespace {

constexpr double kCell = 0.3;          // m
constexpr double kLongestStep = 1.0;   // m between kept scans of one way
constexpr double kFarthestWall = 5.0;  // m from the scanner: farther ones move with its heading
constexpr double kWholeWall = 0.2;     // m between neighbouring hits of one wall
constexpr double kBeside = 0.3;        // m of wall on either side of the way: no person is as wide
constexpr double kOtherVisit = 15.0;   // m of travel
constexpr double kOnePass = 5.0;       // m of travel
constexpr double kAtDoor = 3.0;        // m from where a change of floor begins or ends

/// How far along `from`-`to` another line crosses it, and how far along that; 0 to 1 is on both.
bool Cross(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& one,
           const Eigen::Vector2d& other) {
  const Eigen::Vector2d way = to - from;
  const Eigen::Vector2d wall = other - one;
  const double area = way.x() * wall.y() - way.y() * wall.x();
  if (std::abs(area) < 0.5 * way.norm() * wall.norm()) return false;  // along it
  const Eigen::Vector2d apart = one - from;
  const double on_way = (apart.x() * wall.y() - apart.y() * wall.x()) / area;
  const double on_wall = (apart.x() * way.y() - apart.y() * way.x()) / area;
  return on_way >= 0.0 && on_way < 1.0 && on_wall >= 0.0 && on_wall <= 1.0;
}

/// The steps of all ways, by the place: hits of a wall are many, and few lie where a robot drove.
class Ways {
 public:
  explicit Ways(const std::vector<Visit>& visits) : visits_(visits) {
    for (std::size_t i = 1; i < visits.size(); ++i) {
      if (visits[i].floor != visits[i - 1].floor || visits[i].drive != visits[i - 1].drive ||
          Distance(visits[i].T_world_robot, visits[i - 1].T_world_robot) > kLongestStep) {
        continue;
      }
      Enter(i);
    }
  }

  /// Steps that cross from one point to another, no farther than kWholeWall apart, each by its
  /// later end.
  template <class Use>
  void ForEachThrough(const Eigen::Vector2d& one, const Eigen::Vector2d& other, FloorId floor,
                      Use use) const {
    for (const std::size_t i : steps_.Near(floor, 0.5 * (one + other))) {
      if (Cross(visits_[i - 1].T_world_robot.Translation(), visits_[i].T_world_robot.Translation(),
                one, other)) {
        use(i);
      }
    }
  }

 private:
  // Into every cell in which the middle of a piece of wall may lie that the step crosses.
  void Enter(std::size_t i) {
    constexpr double kSpacing = 0.1;
    constexpr double kReach = 0.5 * (kWholeWall + kSpacing);
    const Eigen::Vector2d from = visits_[i - 1].T_world_robot.Translation();
    const Eigen::Vector2d way = visits_[i].T_world_robot.Translation() - from;
    const int samples = static_cast<int>(std::ceil(way.norm() / kSpacing));
    for (int sample = 0; sample <= samples; ++sample) {
      const Eigen::Vector2d at = from + way * (static_cast<double>(sample) / std::max(1, samples));
      steps_.Add(visits_[i].floor, at, kReach, i);
    }
  }

  const std::vector<Visit>& visits_;
  PlaceIndex steps_{kCell};
};

/// Points of one scan in the world, in the order of its beams.
std::vector<Eigen::Vector2d> HitsOf(const BuildingMap& map, const Visit& visit) {
  std::vector<Eigen::Vector2d> hits;
  const ScanPoints::ConstPtr points = PointsInRobot(map.kept_scans[visit.kept].scan);
  const PointTransform to_world(visit.T_world_robot);
  for (const pcl::PointXY& point : *points) {
    const Eigen::Vector2d in_robot(point.x, point.y);
    if (in_robot.norm() <= kFarthestWall) hits.push_back(to_world * in_robot);
  }
  return hits;
}

/// Whether a wall goes on for long enough from hit to hit.
bool GoesOn(const std::vector<Eigen::Vector2d>& hits, std::size_t from, std::ptrdiff_t step) {
  std::size_t i = from;
  while ((hits[i] - hits[from]).norm() < kBeside) {
    const auto next = static_cast<std::ptrdiff_t>(i) + step;
    if (next < 0 || next >= static_cast<std::ptrdiff_t>(hits.size())) return false;
    const auto at = static_cast<std::size_t>(next);
    if ((hits[at] - hits[i]).norm() > kWholeWall) return false;
    i = at;
  }
  return true;
}

}  // namespace

std::vector<FloorPlace> DoorsOf(const BuildingMap& map) {
  std::vector<FloorPlace> doors;
  for (std::size_t i = 1; i < map.trajectory.size(); ++i) {
    const TrajectoryPose& before = map.trajectory[i - 1];
    const TrajectoryPose& pose = map.trajectory[i];
    if (before.in_transit == pose.in_transit) continue;
    const TrajectoryPose& outside = before.in_transit ? pose : before;
    doors.push_back({outside.floor, outside.T_world_robot.Translation()});
  }
  return doors;
}

std::vector<WallCrossing> FindWallCrossings(
    const BuildingMap& map, const std::vector<Visit>& visits, const std::vector<FloorPlace>& doors,
    const std::function<bool(std::size_t driven, std::size_t seen)>& are_asked) {
  const Ways ways(visits);
  std::map<std::size_t, std::vector<std::size_t>> seen_of_driven;
  for (std::size_t seen = 0; seen < visits.size(); ++seen) {
    const std::vector<Eigen::Vector2d> hits = HitsOf(map, visits[seen]);
    for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
      if ((hits[i + 1] - hits[i]).norm() > kWholeWall) continue;
      ways.ForEachThrough(hits[i], hits[i + 1], visits[seen].floor, [&](std::size_t driven) {
        if (!are_asked(driven, seen)) return;
        if (GoesOn(hits, i, -1) && GoesOn(hits, i + 1, 1)) seen_of_driven[driven].push_back(seen);
      });
    }
  }
  const auto is_at_door = [&](const Visit& visit) {
    return std::any_of(doors.begin(), doors.end(), [&](const FloorPlace& door) {
      return door.floor == visit.floor &&
             (door.in_world - visit.T_world_robot.Translation()).norm() <= kAtDoor;
    });
  };
  std::vector<WallCrossing> crossings;
  for (auto& [driven, seen] : seen_of_driven) {
    if (is_at_door(visits[driven])) continue;
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    if (seen.size() < kLeastSeen) continue;
    if (!crossings.empty() &&
        visits[driven].travelled_m - visits[crossings.back().driven].travelled_m < kOnePass) {
      continue;
    }
    crossings.push_back({driven, std::move(seen)});
  }
  return crossings;
}

std::vector<WallCrossing> FindWallCrossings(const BuildingMap& map,
                                            const std::vector<Visit>& visits) {
  return FindWallCrossings(map, visits, DoorsOf(map), [&](std::size_t driven, std::size_t seen) {
    return std::abs(visits[driven].travelled_m - visits[seen].travelled_m) >= kOtherVisit;
  });
}

std::size_t WallsDrivenThrough(const BuildingMap& map, FloorId older, FloorId newer,
                               const Pose2& T_older_newer) {
  std::vector<Visit> visits;
  std::vector<bool> is_newer;
  for (Visit visit : VisitsOf(map)) {
    if (visit.floor != older && visit.floor != newer) continue;
    is_newer.push_back(visit.floor == newer);
    if (visit.floor == newer) visit.T_world_robot = T_older_newer * visit.T_world_robot;
    visit.floor = older;
    visits.push_back(visit);
  }
  std::vector<FloorPlace> doors = DoorsOf(map);
  for (FloorPlace& door : doors) {
    if (door.floor != newer) continue;
    door = {older, T_older_newer * door.in_world};
  }
  return FindWallCrossings(map, visits, doors,
                           [&](std::size_t driven, std::size_t seen) {
                             return is_newer[driven] != is_newer[seen];
                           })
      .size();
}

}  // namespace masked_mapper
