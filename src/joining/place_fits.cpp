// SPDX-License-Identifier: BSD-3-Clause
#include "place_fits.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "masked_mapper/map/surroundings.hpp"

namespace masked_mapper {
namespace {

constexpr double kScanEvery = 0.5;    // m of travel between scans that make a floor or a place
constexpr double kFineStretch = 2.0;  // m of travel to either side, of what is held against the map
constexpr double kFarthest = 1e4;     // m, from the origin
constexpr std::size_t kPlacesPerFloor = 60;  // looked at for a guess
constexpr double kSeenCell = 0.2;            // m
constexpr double kPassed = 2.0;              // m from the other robot's way
constexpr double kLeastShared = 40;   // points of a place where the older part has seen something
constexpr double kLeastShare = 0.3;   // and of all its points
constexpr double kLeastCoarse = 0.2;  // of score, below which next to nothing is shared

}  // namespace

MapPart PartOfDrives(const BuildingMap& map, const std::vector<std::size_t>& drives) {
  MapPart part;
  for (const std::size_t drive : drives) {
    part.nodes.push_back(NodesOfDrive(map, drive));
    part.poses.push_back(PosesOfDrive(map, drive));
  }
  return part;
}

PlaceFits::PlaceFits(const BuildingMap& map, const DriveJoinOptions& options,
                     const MatcherOptions& matcher, std::vector<FloorId> is_floor)
    : map_(map), joins_(options), matcher_(matcher), is_floor_(std::move(is_floor)) {}

FloorId PlaceFits::CountsAs(FloorId floor) const {
  return is_floor_.empty() ? floor : is_floor_[static_cast<std::size_t>(floor)];
}

IndexRange PlaceFits::KeptOf(const IndexRange& poses) const {
  const auto first = [&](std::size_t pose) {
    return static_cast<std::size_t>(
        std::lower_bound(
            map_.kept_scans.begin(), map_.kept_scans.end(), pose,
            [](const KeptScan& kept, std::size_t index) { return kept.trajectory_index < index; }) -
        map_.kept_scans.begin());
  };
  return {first(poses.begin), first(poses.end)};
}

ScanPoints::ConstPtr PlaceFits::StretchAround(NodeId node, double half_length_m) const {
  return PointsAround(map_, node, {half_length_m, kScanEvery, LaidOutBy::kOptimisation},
                      joins_.search.max_range_m);
}

ScanPoints::ConstPtr PlaceFits::StretchAround(const IndexRange& kept, std::size_t middle,
                                              double half_length_m) const {
  const TrajectoryPose& center = PoseOf(middle);
  ScanPoints::Ptr points_in_place(new ScanPoints);
  // Outwards from the middle, which is taken once.
  const auto go = [&](std::ptrdiff_t step, double taken) {
    double travelled = 0.0;
    Pose2 T_world_before = center.T_world_robot;
    for (auto i = static_cast<std::ptrdiff_t>(middle);
         i >= static_cast<std::ptrdiff_t>(kept.begin) && i < static_cast<std::ptrdiff_t>(kept.end);
         i += step) {
      const TrajectoryPose& pose = PoseOf(static_cast<std::size_t>(i));
      travelled += Distance(T_world_before, pose.T_world_robot);
      T_world_before = pose.T_world_robot;
      if (travelled > half_length_m || pose.in_transit) return;
      if (travelled - taken < kScanEvery) continue;
      taken = travelled;
      AppendTransformed(*PointsInRobot(map_.kept_scans[static_cast<std::size_t>(i)].scan),
                        Between(center.T_world_robot, pose.T_world_robot),
                        joins_.search.max_range_m, *points_in_place);
    }
  };
  go(1, -kScanEvery);
  go(-1, 0.0);
  return points_in_place;
}

void PlaceFits::ReadFloors(const MapPart& older) {
  std::map<FloorId, std::vector<PosedScan>> scans;
  for (const IndexRange& poses : older.poses) {
    const IndexRange kept = KeptOf(poses);
    std::optional<Pose2> T_world_before;
    for (std::size_t i = kept.begin; i < kept.end; ++i) {
      const TrajectoryPose& pose = PoseOf(i);
      if (T_world_before && Distance(*T_world_before, pose.T_world_robot) < kScanEvery) continue;
      T_world_before = pose.T_world_robot;
      if (pose.in_transit || pose.T_world_robot.Translation().norm() > kFarthest) continue;
      const FloorId floor = CountsAs(pose.floor);
      scans[floor].push_back({pose.T_world_robot, floor, &map_.kept_scans[i].scan});
    }
  }
  SearchableFloorOptions options{joins_.search, FineSearchOptions(), joins_.seen,
                                 matcher_.table.max_range_m};
  options.seen.resolution_m = kSeenCell;
  options.seen.min_hits = 1;
  options.seen.threads = matcher_.threads;
  for (const auto& [floor, scans_of_floor] : scans) {
    OldFloor known{floor, SearchableFloor(scans_of_floor, floor, options), {}};
    if (!known.scene.HasFloor()) continue;
    for (const PosedScan& scan : scans_of_floor) {
      known.way_in_world.push_back(scan.T_world_robot.Translation());
    }
    floors_.push_back(std::move(known));
  }
}

void PlaceFits::AddPlace(FloorId floor, const Pose2& T_world_place, const ScanPoints& wide,
                         const ScanPoints& near) {
  const FloorSearch coarse({}, joins_.search);
  const FloorSearch fine({}, FineSearchOptions());
  Place place{floor, T_world_place, coarse.Thinned(wide), fine.Thinned(near)};
  constexpr std::size_t kLeastPoints = 20;
  if (place.coarse_points.size() >= kLeastPoints) places_.push_back(std::move(place));
}

void PlaceFits::ReadPlacesAtNodes(const MapPart& newer) {
  std::map<FloorId, std::vector<NodeId>> nodes;
  for (const IndexRange& range : newer.nodes) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Node& node = map_.graph.nodes()[i];
      if (!node.HasScan() || node.T_world_robot.Translation().norm() > kFarthest) continue;
      auto& taken = nodes[CountsAs(node.floor)];
      const bool is_far = std::all_of(taken.begin(), taken.end(), [&](NodeId other) {
        return Distance(At(other).T_world_robot, node.T_world_robot) > joins_.place_spacing_m;
      });
      if (is_far) taken.push_back(static_cast<NodeId>(i));
    }
  }
  for (const auto& [floor, taken] : nodes) {
    const std::size_t step = (taken.size() + kPlacesPerFloor - 1) / kPlacesPerFloor;
    for (std::size_t i = 0; i < taken.size(); i += step) {
      AddPlace(floor, At(taken[i]).T_world_robot, *StretchAround(taken[i], joins_.stretch_m),
               *StretchAround(taken[i], kFineStretch));
    }
  }
}

void PlaceFits::ReadPlacesAlongTheWay(const MapPart& newer) {
  struct Taken {
    IndexRange kept;
    std::size_t middle;
  };
  std::map<FloorId, std::vector<Taken>> kept_of;
  for (const IndexRange& poses : newer.poses) {
    const IndexRange kept = KeptOf(poses);
    for (std::size_t i = kept.begin; i < kept.end; ++i) {
      const TrajectoryPose& pose = PoseOf(i);
      if (pose.in_transit || pose.T_world_robot.Translation().norm() > kFarthest) continue;
      auto& taken = kept_of[CountsAs(pose.floor)];
      const bool is_far = std::all_of(taken.begin(), taken.end(), [&](const Taken& other) {
        return Distance(PoseOf(other.middle).T_world_robot, pose.T_world_robot) >
               joins_.place_spacing_m;
      });
      if (is_far) taken.push_back({kept, i});
    }
  }
  for (const auto& [floor, taken] : kept_of) {
    const std::size_t step = (taken.size() + kPlacesPerFloor - 1) / kPlacesPerFloor;
    for (std::size_t i = 0; i < taken.size(); i += step) {
      const auto& [kept, middle] = taken[i];
      AddPlace(floor, PoseOf(middle).T_world_robot, *StretchAround(kept, middle, joins_.stretch_m),
               *StretchAround(kept, middle, kFineStretch));
    }
  }
}

bool PlaceFits::WasPassed(FloorId older, const Pose2& T_world_place) const {
  const std::vector<Eigen::Vector2d>& way = OldFloorOf(older).way_in_world;
  return std::any_of(way.begin(), way.end(), [&](const Eigen::Vector2d& position) {
    return (position - T_world_place.Translation()).norm() <= kPassed;
  });
}

const OldFloor& PlaceFits::OldFloorOf(FloorId older) const {
  return *std::find_if(floors_.begin(), floors_.end(),
                       [&](const OldFloor& known) { return known.id == older; });
}

const TrajectoryPose& PlaceFits::PoseOf(std::size_t kept) const {
  return map_.trajectory[map_.kept_scans[kept].trajectory_index];
}

std::optional<PlaceFit> PlaceFits::FitOf(const Place& place, FloorId older,
                                         const Pose2& T_older_newer, double within_m) const {
  const OldFloor& floor = OldFloorOf(older);
  constexpr double kWithinDeg = 4.0;
  constexpr double kFineM = 0.5;
  constexpr double kFineDeg = 2.0;
  const PlaceFit coarse = floor.scene.coarse().FindNear(
      place.coarse_points, T_older_newer * place.T_world_place, within_m, kWithinDeg);
  PlaceFit fit = coarse;
  if (coarse.score >= kLeastCoarse) {
    fit = floor.scene.fine().FindNear(place.fine_points, coarse.T_world_place, kFineM, kFineDeg);
  }
  double sum = 0.0;
  std::size_t shared = 0;
  const PointTransform to_world(fit.T_world_place);
  for (const Eigen::Vector2d& point : place.fine_points) {
    const Eigen::Vector2d in_world = to_world * point;
    const double value = floor.scene.fine().ValueAt(in_world);
    if (value == 0.0 && !floor.scene.IsSeen(in_world)) continue;
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

double PlaceFits::SpreadOf(const std::vector<std::size_t>& places) const {
  double spread = 0.0;
  for (const std::size_t one : places) {
    for (const std::size_t other : places) {
      spread = std::max(spread, Distance(places_[one].T_world_place, places_[other].T_world_place));
    }
  }
  return spread;
}

}  // namespace masked_mapper
