// SPDX-License-Identifier: BSD-3-Clause
#include "clouds_at_poses.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr double kLeastTravel = 0.15;    // m
constexpr double kLeastTurn_deg = 10.0;  // or so much of a turn

bool WentOn(const TrajectoryPose& before, const TrajectoryPose& now) {
  const double turned = WrapAngle(now.T_world_robot.theta - before.T_world_robot.theta);
  return now.floor != before.floor ||
         Distance(before.T_world_robot, now.T_world_robot) >= kLeastTravel ||
         std::abs(turned) >= DegToRad(kLeastTurn_deg);
}

}  // namespace

std::vector<KeptCloud> CloudsAtPoses(const std::vector<StampedCloud>& clouds,
                                     const std::vector<TrajectoryPose>& trajectory) {
  std::unordered_map<double, std::size_t> poses;
  for (std::size_t i = 0; i < trajectory.size(); ++i) poses.emplace(trajectory[i].log_stamp, i);
  std::vector<KeptCloud> kept;
  for (const StampedCloud& cloud : clouds) {
    const auto pose = poses.find(cloud.log_stamp);
    if (pose != poses.end()) kept.push_back({pose->second, cloud.packed});
  }
  const auto is_before = [](const KeptCloud& a, const KeptCloud& b) {
    return a.trajectory_index < b.trajectory_index;
  };
  std::stable_sort(kept.begin(), kept.end(), is_before);
  std::vector<KeptCloud> apart;
  for (KeptCloud& cloud : kept) {
    const TrajectoryPose& pose = trajectory[cloud.trajectory_index];
    if (pose.in_transit) continue;
    if (apart.empty() || WentOn(trajectory[apart.back().trajectory_index], pose)) {
      apart.push_back(std::move(cloud));
    }
  }
  return apart;
}

}  // namespace masked_mapper
