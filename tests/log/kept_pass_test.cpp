// SPDX-License-Identifier: BSD-3-Clause
#include "log/kept_pass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace masked_mapper {
namespace {

LaserScan SomeScan(double stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.log_stamp = stamp - 1.0;
  scan.T_robot_laser = {0.1, -0.2, 0.3};
  scan.first_angle = -3.0;
  scan.angle_step = 0.01;
  scan.max_range = 40.0F;
  scan.ranges = {1.5F, kNoReturn, kInvalidRange, 0.25F};
  scan.beam_time = 1e-4;
  return scan;
}

TEST(KeptPassTest, GivesWhatItWasGiven) {
  ObservationBatch first;
  first.progress = 0.5;
  LaserScan with_odometry = SomeScan(3.0);
  with_odometry.T_odom_robot = Pose2{4.0, 5.0, 0.5};
  first.observations = {OdometryReading{1.0, {2.0, 3.0, -1.0}}, SomeScan(2.0), with_odometry};
  ObservationBatch second;
  second.progress = 1.0;
  second.statistics.scans = 2;
  second.statistics.other_messages["/rosout"] = 7;
  second.observations = {PressureReading{4.0, 101325.0}, AccelerationReading{5.0, {0.1, 0.2, 9.8}},
                         FloorLabel{6.0, "ground"}, FloorLabel{7.0, ""}};
  KeptPass kept;
  kept.Add(first);
  kept.Add({});
  kept.Add(second);
  kept.AddClouds({{2.0, std::make_shared<const std::string>("a cloud")}});
  EXPECT_FALSE(kept.IsWhole());
  EXPECT_TRUE(kept.Clouds().empty());
  kept.Finish();
  ASSERT_EQ(kept.Clouds().size(), 1U);
  EXPECT_EQ(*kept.Clouds()[0].packed, "a cloud");
  ASSERT_TRUE(kept.IsWhole());

  for (int time = 0; time < 2; ++time) {
    std::vector<Observation> read;
    std::vector<double> progress;
    LogStatistics statistics;
    kept.Replay([&](ObservationBatch batch) {
      read.insert(read.end(), batch.observations.begin(), batch.observations.end());
      progress.push_back(batch.progress);
      statistics = batch.statistics;
      return true;
    });
    EXPECT_EQ(progress, (std::vector<double>{0.5, 0.0, 1.0}));
    EXPECT_EQ(statistics.scans, 2U);
    EXPECT_EQ(statistics.other_messages.at("/rosout"), 7U);
    ASSERT_EQ(read.size(), 7U);
    EXPECT_EQ(std::get<OdometryReading>(read[0]).T_odom_robot.y, 3.0);
    const auto& scan = std::get<LaserScan>(read[1]);
    EXPECT_FALSE(scan.T_odom_robot);
    EXPECT_EQ(scan.log_stamp, 1.0);
    EXPECT_EQ(scan.T_robot_laser.theta, 0.3);
    EXPECT_EQ(scan.angle_step, 0.01);
    EXPECT_EQ(scan.beam_time, 1e-4);
    ASSERT_EQ(scan.size(), 4U);
    EXPECT_EQ(scan.ranges[0], 1.5F);
    EXPECT_EQ(scan.ranges[1], kNoReturn);
    EXPECT_TRUE(std::isnan(scan.ranges[2]));
    EXPECT_EQ(std::get<LaserScan>(read[2]).T_odom_robot->theta, 0.5);
    EXPECT_EQ(std::get<PressureReading>(read[3]).pressure_pa, 101325.0);
    EXPECT_EQ(std::get<AccelerationReading>(read[4]).acceleration_in_robot.z(), 9.8);
    EXPECT_EQ(std::get<FloorLabel>(read[5]).label, "ground");
    EXPECT_EQ(std::get<FloorLabel>(read[6]).stamp, 7.0);
  }
}

TEST(KeptPassTest, WhatIsTooLargeIsNotKept) {
  ObservationBatch batch;
  batch.observations = {SomeScan(2.0)};
  KeptPass large(100'000);
  KeptPass small(100);
  for (KeptPass* kept : {&large, &small}) {
    kept->Add(batch);
    kept->Add(batch);
    kept->Finish();
  }
  EXPECT_TRUE(large.IsWhole());
  EXPECT_FALSE(small.IsWhole());
}

TEST(KeptPassTest, EndsWhenNobodyWantsMore) {
  KeptPass kept;
  for (int i = 0; i < 3; ++i) kept.Add({});
  kept.Finish();
  int batches = 0;
  kept.Replay([&batches](const ObservationBatch&) { return ++batches < 2; });
  EXPECT_EQ(batches, 2);
}

}  // namespace
}  // namespace masked_mapper
