// SPDX-License-Identifier: BSD-3-Clause
#include "submaps.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {

LocalMap Submaps::Build(NodeId node) const {
  LocalMap map(options_.map, Eigen::Vector2d::Zero());
  for (const ScanNearNode& near : ScansAround(building_, node, Surroundings())) {
    map.Add(*PointsInRobot(*near.scan), near.T_node_robot);
  }
  return map;
}

ScanPoints::ConstPtr Submaps::PointsAround(NodeId node) const {
  return masked_mapper::PointsAround(building_, node, Surroundings(),
                                     std::numeric_limits<double>::infinity());
}

// By the scan kept last, at which Build() would stop: what is kept later changes nothing then, and
// the submap depends on the node alone, not on when it was built.
bool Submaps::IsComplete(NodeId node) const {
  const Node& center = building_.graph.node(node);
  const std::size_t last_kept = building_.kept_scans.empty()
                                    ? building_.trajectory.size() - 1
                                    : building_.kept_scans.back().trajectory_index;
  const TrajectoryPose& last = building_.trajectory[last_kept];
  return Distance(center.T_odom_robot, last.T_odom_robot) > options_.half_length_m ||
         center.floor != last.floor ||
         DriveOfNode(building_, node) + 1 < std::max<std::size_t>(1, building_.drives.size());
}

const LocalMap& Submaps::SubmapOf(NodeId node) {
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
  return submaps_.emplace(node, Entry{Build(node), recently_used_.begin(), IsComplete(node)})
      .first->second.map;
}

ScanPoints::ConstPtr Submaps::PointsAt(NodeId node) const {
  return masked_mapper::PointsAt(building_, node, options_.half_length_m);
}

void Submaps::Forget() {
  submaps_.clear();
  recently_used_.clear();
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
