// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_poses.hpp"

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// As stamps are written in bags of ours, and finer than sweeps follow each other.
std::int64_t Microseconds(double stamp) { return std::llround(stamp * 1e6); }

}  // namespace

CloudPoses::CloudPoses(const BuildingMap& map, const CloudSpacing& spacing,
                       std::optional<FloorId> floor)
    : map_(map), spacing_(spacing), floor_(floor) {
  for (std::size_t i = 0; i < map.trajectory.size(); ++i) {
    poses_.emplace(Microseconds(map.trajectory[i].log_stamp), i);
  }
}

const TrajectoryPose* CloudPoses::Take(double log_stamp) {
  const auto known = poses_.find(Microseconds(log_stamp));
  if (known == poses_.end()) {
    ++counts_.unknown;
    return nullptr;
  }
  return TakeIfApart(map_.trajectory[known->second]);
}

const TrajectoryPose* CloudPoses::TakeAt(std::size_t trajectory_index) {
  return TakeIfApart(map_.trajectory[trajectory_index]);
}

const TrajectoryPose* CloudPoses::TakeIfApart(const TrajectoryPose& pose) {
  if (pose.in_transit || (floor_ && *floor_ != pose.floor)) return nullptr;
  if (last_ != nullptr && last_->floor == pose.floor) {
    const double turned = WrapAngle(pose.T_world_robot.theta - last_->T_world_robot.theta);
    if (Distance(last_->T_world_robot, pose.T_world_robot) < spacing_.distance_m &&
        std::abs(turned) < DegToRad(spacing_.angle_deg)) {
      return nullptr;
    }
  }
  last_ = &pose;
  ++counts_.taken;
  return &pose;
}

Eigen::Isometry3d CloudPoses::T_world_level(const TrajectoryPose& pose) const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::AngleAxisd(pose.T_world_robot.theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() =
      Eigen::Vector3d(pose.T_world_robot.x, pose.T_world_robot.y,
                      map_.graph.floors()[static_cast<std::size_t>(pose.floor)].elevation);
  return T;
}

}  // namespace masked_mapper
