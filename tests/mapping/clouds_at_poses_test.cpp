// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/clouds_at_poses.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(CloudsAtPosesTest, AreThoseOfKnownStampsOnFloorsAndApart) {
  std::vector<TrajectoryPose> trajectory;
  std::vector<StampedCloud> clouds;
  const auto add = [&](double x, double theta, FloorId floor, bool in_transit) {
    TrajectoryPose pose;
    pose.log_stamp = 0.1 * static_cast<double>(trajectory.size());
    pose.stamp = pose.log_stamp + 7.0;
    pose.T_world_robot = {x, 0.0, theta};
    pose.floor = floor;
    pose.in_transit = in_transit;
    trajectory.push_back(pose);
    clouds.push_back({pose.log_stamp, std::make_shared<const std::string>("c")});
  };
  add(0.0, 0.0, 0, false);   // the first
  add(0.05, 0.0, 0, false);  // too near
  add(0.2, 0.0, 0, false);
  add(0.2, 0.3, 0, false);  // turned
  add(1.0, 0.3, 0, true);   // between floors
  add(0.2, 0.3, 1, false);  // on another floor
  add(1.0, 0.3, 1, false);
  clouds.push_back({99.0, clouds[0].packed});
  clouds.erase(clouds.begin() + 6);  // a pose without a cloud
  std::vector<std::size_t> kept;
  for (const KeptCloud& cloud : CloudsAtPoses(clouds, trajectory)) {
    kept.push_back(cloud.trajectory_index);
  }
  EXPECT_EQ(kept, (std::vector<std::size_t>{0, 2, 3, 5}));
  EXPECT_TRUE(CloudsAtPoses({}, trajectory).empty());
}

}  // namespace
}  // namespace masked_mapper
