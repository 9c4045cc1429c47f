// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/cloud_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "log/temporary_file.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

TEST(CloudSourceTest, GivesEverySweepLevelledAndWithItsStamp) {
  RoomCloud room;
  room.T_world_lidar = Tilted(3.0, -2.0, 0.6);
  CloudReading reading;
  reading.points = room.Seen();
  reading.T_robot_lidar = Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.5));
  const TemporaryFile file(".mcap");
  {
    LogWriter log(file.path());
    for (int i = 0; i < 5; ++i) {
      reading.stamp = 1.7e9 + 0.1 * i;
      reading.T_odom_robot = Pose2{0.01 * i, 0.0, 0.0};
      log.WriteCloud(reading);
    }
    log.Close();
  }
  CloudSource source({file.path()}, {});
  for (int i = 0; i < 5; ++i) {
    const std::optional<LevelledCloud> cloud = source.Next();
    ASSERT_TRUE(cloud);
    EXPECT_NEAR(cloud->log_stamp, 1.7e9 + 0.1 * i, 1e-6);
    EXPECT_EQ(cloud->points.size(), reading.points.size());
    EXPECT_NEAR(cloud->lidar.z(), 0.6, 0.03);
    const auto lowest = std::min_element(
        cloud->points.begin(), cloud->points.end(),
        [](const auto& a, const auto& b) { return a.position.z() < b.position.z(); });
    EXPECT_NEAR(lowest->position.z(), 0.0, 0.06);
  }
  EXPECT_FALSE(source.Next());
}

TEST(CloudSourceTest, WhatHoldsNoCloudsIsRefused) {
  const TemporaryFile text(".log", "# nothing\n");
  EXPECT_THROW(CloudSource({text.path()}, {}), InputError);
  const TemporaryFile bag(".mcap");
  {
    LogWriter log(bag.path());
    LaserScan scan;
    scan.stamp = 1.7e9;
    scan.angle_step = 0.01;
    scan.max_range = 10.0F;
    scan.ranges.assign(100, 2.0F);
    log.Write(scan);
    log.Close();
  }
  EXPECT_THROW(CloudSource({bag.path()}, {}), InputError);
}

}  // namespace
}  // namespace masked_mapper
