// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/stretch.hpp"

#include <algorithm>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

constexpr double kScanEvery = 0.5;  // m of travel

}  // namespace

void AppendPoints(const LaserScan& scan, const Pose2& T_frame_robot, double max_range_m,
                  ScanPoints& points_in_frame) {
  const ScanPoints::ConstPtr points = PointsInRobot(scan);
  for (const pcl::PointXY& point : *points) {
    const Eigen::Vector2d in_robot(point.x, point.y);
    if (in_robot.norm() > max_range_m) continue;
    const Eigen::Vector2d in_frame = T_frame_robot * in_robot;
    pcl::PointXY moved;
    moved.x = static_cast<float>(in_frame.x());
    moved.y = static_cast<float>(in_frame.y());
    points_in_frame.push_back(moved);
  }
}

ScanPoints::Ptr StretchAround(const MappingResult& map, NodeId node, double half_length_m,
                              double max_range_m) {
  const Node& center = map.graph.nodes()[static_cast<std::size_t>(node)];
  const IndexRange poses = PosesOfDrive(map, DriveOfNode(map, node));
  const auto is_before = [](const KeptScan& kept, std::size_t pose) {
    return kept.trajectory_index < pose;
  };
  const auto begin =
      std::lower_bound(map.kept_scans.begin(), map.kept_scans.end(), poses.begin, is_before);
  const auto end = std::lower_bound(begin, map.kept_scans.end(), poses.end, is_before);
  const auto after =
      std::lower_bound(begin, end, center.stamp,
                       [](const KeptScan& kept, double stamp) { return kept.scan.stamp < stamp; });
  ScanPoints::Ptr points(new ScanPoints);
  const auto add = [&](auto scan, auto last) {
    double travelled = 0.0;
    double taken = -kScanEvery;
    Pose2 T_world_before = center.T_world_robot;
    for (; scan != last; ++scan) {
      const TrajectoryPose& pose = map.trajectory[scan->trajectory_index];
      travelled += Distance(T_world_before, pose.T_world_robot);
      if (travelled > half_length_m || pose.floor != center.floor || pose.in_transit) return;
      T_world_before = pose.T_world_robot;
      if (travelled - taken < kScanEvery) continue;
      taken = travelled;
      AppendPoints(scan->scan, Between(center.T_world_robot, pose.T_world_robot), max_range_m,
                   *points);
    }
  };
  add(after, end);
  add(std::make_reverse_iterator(after), std::make_reverse_iterator(begin));
  return points;
}

}  // namespace masked_mapper
