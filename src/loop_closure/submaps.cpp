// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/submaps.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

void AppendMoved(const ScanPoints& points_in_robot, const Pose2& T_node_robot,
                 ScanPoints& points_in_node) {
  for (const pcl::PointXY& point : points_in_robot) {
    const Eigen::Vector2d in_node = T_node_robot * Eigen::Vector2d(point.x, point.y);
    pcl::PointXY moved;
    moved.x = static_cast<float>(in_node.x());
    moved.y = static_cast<float>(in_node.y());
    points_in_node.push_back(moved);
  }
}

}  // namespace

std::vector<LocalMap::PosedPoints> Submaps::ScansAround(NodeId node) const {
  const Node& center = result_.graph.nodes()[static_cast<std::size_t>(node)];
  std::vector<LocalMap::PosedPoints> scans;
  const std::vector<KeptScan>& kept = result_.kept_scans;
  const auto pose_of = [&](const KeptScan& scan) -> const TrajectoryPose& {
    return result_.trajectory[scan.trajectory_index];
  };
  // Those of the node's own drive: another's motion path is another.
  const IndexRange poses = PosesOfDrive(result_, DriveOfNode(result_, node));
  const auto is_before = [](const KeptScan& scan, std::size_t pose) {
    return scan.trajectory_index < pose;
  };
  const auto begin = std::lower_bound(kept.begin(), kept.end(), poses.begin, is_before);
  const auto end = std::lower_bound(begin, kept.end(), poses.end, is_before);
  const auto first_after =
      std::lower_bound(begin, end, center.stamp,
                       [](const KeptScan& scan, double stamp) { return scan.scan.stamp < stamp; });
  // Outwards in both directions until the way travelled is long enough; another floor ends it.
  const auto add = [&](auto scan, auto last, auto next) {
    double travelled = 0.0;
    Pose2 T_odom_before = center.T_odom_robot;
    for (; scan != last; scan = next(scan)) {
      const TrajectoryPose& pose = pose_of(*scan);
      travelled += Distance(T_odom_before, pose.T_odom_robot);
      if (travelled > options_.half_length_m || pose.floor != center.floor) break;
      T_odom_before = pose.T_odom_robot;
      scans.push_back({PointsInRobot(scan->scan), Between(center.T_odom_robot, pose.T_odom_robot)});
    }
  };
  add(first_after, end, [](auto scan) { return scan + 1; });
  add(std::make_reverse_iterator(first_after), std::make_reverse_iterator(begin),
      [](auto scan) { return scan + 1; });
  return scans;
}

LocalMap Submaps::Build(NodeId node) const {
  LocalMap map(options_.map, Eigen::Vector2d::Zero());
  map.Add(ScansAround(node));
  return map;
}

ScanPoints::ConstPtr Submaps::PointsAround(NodeId node) const {
  const ScanPoints::Ptr points_in_node(new ScanPoints);
  for (const LocalMap::PosedPoints& scan : ScansAround(node)) {
    AppendMoved(*scan.points_in_robot, scan.T_map_robot, *points_in_node);
  }
  return points_in_node;
}

const LocalMap& Submaps::SubmapOf(NodeId node) {
  const Node& center = result_.graph.nodes()[static_cast<std::size_t>(node)];
  const auto found = submaps_.find(node);
  if (found != submaps_.end()) {
    if (found->second.is_complete) {
      recently_used_.splice(recently_used_.begin(), recently_used_, found->second.place);
      return found->second.map;
    }
    recently_used_.erase(found->second.place);
    submaps_.erase(found);
  }
  while (submaps_.size() >= std::max<std::size_t>(1, options_.cached)) {
    submaps_.erase(recently_used_.back());
    recently_used_.pop_back();
  }
  recently_used_.push_front(node);
  // By the scan kept last, at which Build() would stop: what is kept later changes nothing then,
  // and the submap depends on the node alone, not on when it was built.
  const std::size_t last_kept = result_.kept_scans.empty()
                                    ? result_.trajectory.size() - 1
                                    : result_.kept_scans.back().trajectory_index;
  const TrajectoryPose& last = result_.trajectory[last_kept];
  const bool is_complete =
      Distance(center.T_odom_robot, last.T_odom_robot) > options_.half_length_m ||
      center.floor != last.floor ||
      DriveOfNode(result_, node) + 1 < std::max<std::size_t>(1, result_.drives.size());
  return submaps_.emplace(node, Entry{Build(node), recently_used_.begin(), is_complete})
      .first->second.map;
}

ScanPoints::ConstPtr Submaps::PointsAt(NodeId node) const {
  const Node& center = result_.graph.nodes()[static_cast<std::size_t>(node)];
  if (center.HasScan()) return center.points_in_robot;
  const std::vector<KeptScan>& kept = result_.kept_scans;
  const IndexRange poses = PosesOfDrive(result_, DriveOfNode(result_, node));
  const auto after =
      std::lower_bound(kept.begin(), kept.end(), center.stamp,
                       [](const KeptScan& scan, double stamp) { return scan.scan.stamp < stamp; });
  const KeptScan* nearest = nullptr;
  Pose2 T_node_scan;
  const auto look_at = [&](const KeptScan& scan) {
    const TrajectoryPose& pose = result_.trajectory[scan.trajectory_index];
    const Pose2 T_node_here = Between(center.T_odom_robot, pose.T_odom_robot);
    const double distance = T_node_here.Translation().norm();
    if (pose.floor != center.floor || distance > options_.half_length_m) return;
    if (scan.trajectory_index < poses.begin || scan.trajectory_index >= poses.end) return;
    if (nearest != nullptr && distance >= T_node_scan.Translation().norm()) return;
    nearest = &scan;
    T_node_scan = T_node_here;
  };
  if (after != kept.begin()) look_at(*std::prev(after));
  if (after != kept.end()) look_at(*after);
  if (nearest == nullptr) return nullptr;
  const ScanPoints::Ptr points_in_node(new ScanPoints);
  AppendMoved(*PointsInRobot(nearest->scan), T_node_scan, *points_in_node);
  return points_in_node;
}

std::optional<SubmapMatch> Submaps::Refine(NodeId node, const ScanPoints& points_in_robot,
                                           const UncertainPose2& T_node_robot) {
  Eigen::Matrix3d prior_covariance = T_node_robot.covariance;
  prior_covariance.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-7);
  const Eigen::Matrix3d prior = options_.prior_weight * prior_covariance.inverse();
  const Alignment aligned = SubmapOf(node).Align(points_in_robot, T_node_robot.mean, prior);
  if (aligned.inlier_share < options_.min_inlier_share ||
      Distance(aligned.T_map_robot, T_node_robot.mean) > options_.max_correction_m ||
      std::abs(WrapAngle(aligned.T_map_robot.theta - T_node_robot.mean.theta)) >
          DegToRad(options_.max_correction_deg)) {
    return std::nullopt;
  }
  SubmapMatch refined;
  refined.inlier_share = aligned.inlier_share;
  refined.T_node_robot.mean = aligned.T_map_robot;
  refined.T_node_robot.covariance = (aligned.information + prior).inverse();
  const double floor_m = options_.sigma_floor_m;
  const double floor_rad = DegToRad(options_.sigma_floor_deg);
  refined.T_node_robot.covariance.diagonal() +=
      Eigen::Vector3d(floor_m * floor_m, floor_m * floor_m, floor_rad * floor_rad);
  return refined;
}

}  // namespace masked_mapper
