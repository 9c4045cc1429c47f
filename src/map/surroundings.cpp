// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/surroundings.hpp"

#include <algorithm>
#include <iterator>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

using KeptIterator = std::vector<KeptScan>::const_iterator;

struct KeptRange {
  KeptIterator begin;
  KeptIterator after;  ///< the first at or behind the node's stamp
  KeptIterator end;
};

// Those of the node's own drive: another's motion path is another.
KeptRange KeptOfDrive(const BuildingMap& map, NodeId node) {
  const IndexRange poses = PosesOfDrive(map, DriveOfNode(map, node));
  const auto is_before = [](const KeptScan& kept, std::size_t pose) {
    return kept.trajectory_index < pose;
  };
  KeptRange range;
  range.begin =
      std::lower_bound(map.kept_scans.begin(), map.kept_scans.end(), poses.begin, is_before);
  range.end = std::lower_bound(range.begin, map.kept_scans.end(), poses.end, is_before);
  range.after =
      std::lower_bound(range.begin, range.end, map.graph.node(node).stamp,
                       [](const KeptScan& kept, double stamp) { return kept.scan.stamp < stamp; });
  return range;
}

ScanNearNode ScanNearestTo(const BuildingMap& map, NodeId node, double most_m) {
  const Node& center = map.graph.node(node);
  const KeptRange range = KeptOfDrive(map, node);
  ScanNearNode nearest;
  const auto look_at = [&](const KeptScan& kept) {
    const TrajectoryPose& pose = map.trajectory[kept.trajectory_index];
    const Pose2 T_node_robot = Between(center.T_odom_robot, pose.T_odom_robot);
    const double distance = T_node_robot.Translation().norm();
    if (pose.floor != center.floor || distance > most_m) return;
    if (nearest.scan != nullptr && distance >= nearest.T_node_robot.Translation().norm()) return;
    nearest = {&kept.scan, T_node_robot};
  };
  if (range.after != range.begin) look_at(*std::prev(range.after));
  if (range.after != range.end) look_at(*range.after);
  return nearest;
}

}  // namespace

std::vector<ScanNearNode> ScansAround(const BuildingMap& map, NodeId node,
                                      const SurroundingsOptions& options) {
  const Node& center = map.graph.node(node);
  const bool by_motion = options.laid_out_by == LaidOutBy::kMotion;
  const auto pose_of = [&](const auto& placed) -> const Pose2& {
    return by_motion ? placed.T_odom_robot : placed.T_world_robot;
  };
  std::vector<ScanNearNode> scans;
  // Outwards in each direction until the way travelled is long enough; another floor ends it.
  const auto add = [&](auto kept, auto last) {
    double travelled = 0.0;
    double taken = -options.spacing_m;
    const Pose2* before = &pose_of(center);
    for (; kept != last; ++kept) {
      const TrajectoryPose& pose = map.trajectory[kept->trajectory_index];
      travelled += Distance(*before, pose_of(pose));
      if (travelled > options.half_length_m || pose.floor != center.floor || pose.in_transit)
        return;
      before = &pose_of(pose);
      if (travelled - taken < options.spacing_m) continue;
      taken = travelled;
      scans.push_back({&kept->scan, Between(pose_of(center), pose_of(pose))});
    }
  };
  const KeptRange range = KeptOfDrive(map, node);
  add(range.after, range.end);
  add(std::make_reverse_iterator(range.after), std::make_reverse_iterator(range.begin));
  return scans;
}

ScanPoints::Ptr PointsAround(const BuildingMap& map, NodeId node,
                             const SurroundingsOptions& options, double max_range_m) {
  ScanPoints::Ptr points_in_node(new ScanPoints);
  for (const ScanNearNode& near : ScansAround(map, node, options)) {
    AppendTransformed(*PointsInRobot(*near.scan), near.T_node_robot, max_range_m, *points_in_node);
  }
  return points_in_node;
}

ScanPoints::ConstPtr PointsAt(const BuildingMap& map, NodeId node, double most_m) {
  const Node& center = map.graph.node(node);
  ScanNearNode seen;
  if (center.HasScan()) {
    const KeptScan& own = map.kept_scans[static_cast<std::size_t>(center.scan)];
    seen = {&own.scan,
            Between(center.T_odom_robot, map.trajectory[own.trajectory_index].T_odom_robot)};
  } else {
    seen = ScanNearestTo(map, node, most_m);
  }
  if (seen.scan == nullptr) return nullptr;
  return Transformed(*PointsInRobot(*seen.scan), seen.T_node_robot);
}

}  // namespace masked_mapper
