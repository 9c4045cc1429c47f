// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/motion_estimator.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

// A drive through a furnished room: 0.06 m and up to 3.5 degrees a scan, five scans a second.
std::vector<Pose2> Drive(int steps) {
  std::vector<Pose2> poses = {Pose2{2.0, 2.5, 0.0}};
  for (int i = 1; i < steps; ++i) {
    poses.push_back(poses.back() * Pose2{0.06, 0.0, DegToRad(i % 60 < 30 ? 3.5 : 2.5)});
  }
  return poses;
}

Pose2 RunAll(MotionSource source, bool give_odometry, double heading_error_deg_per_step,
             const std::vector<Pose2>& truth) {
  MotionOptions options;
  options.source = source;
  MotionEstimator motion(options);
  const BoxScene room = FurnishedRoom();
  Pose2 odometry;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) {
      Pose2 step = Between(truth[i - 1], truth[i]);
      step.theta += DegToRad(heading_error_deg_per_step);
      odometry = odometry * step;
    }
    LaserScan scan = room.Scan(truth[i], 361, 270.0);
    scan.stamp = 0.2 * static_cast<double>(i);
    if (give_odometry) scan.T_odom_robot = odometry;
    motion.Observe(scan);
  }
  return motion.T_odom_robot();
}

TEST(MotionEstimator, WheelsAloneReproduceTheWheels) {
  const std::vector<Pose2> truth = Drive(200);
  const Pose2 end = RunAll(MotionSource::kOdometry, true, 0.0, truth);
  const Pose2 expected = Between(truth.front(), truth.back());
  EXPECT_NEAR(Distance(end, expected), 0.0, 1e-9);
}

TEST(MotionEstimator, FusedUndoesADriftOfHalfADegreeAStep) {
  const std::vector<Pose2> truth = Drive(200);
  const Pose2 expected = Between(truth.front(), truth.back());
  const Pose2 wheels = RunAll(MotionSource::kOdometry, true, 0.5, truth);
  EXPECT_GT(std::abs(WrapAngle(wheels.theta - expected.theta)), DegToRad(60.0));
  const Pose2 end = RunAll(MotionSource::kFused, true, 0.5, truth);
  EXPECT_LT(Distance(end, expected), 0.05) << "m";
  EXPECT_LT(RadToDeg(std::abs(WrapAngle(end.theta - expected.theta))), 0.5) << "deg";
}

TEST(MotionEstimator, ScansAloneNeedNoWheels) {
  const std::vector<Pose2> truth = Drive(200);
  const Pose2 expected = Between(truth.front(), truth.back());
  const Pose2 end = RunAll(MotionSource::kScans, false, 0.0, truth);
  EXPECT_LT(Distance(end, expected), 0.05) << "m";
  EXPECT_LT(RadToDeg(std::abs(WrapAngle(end.theta - expected.theta))), 0.5) << "deg";
}

TEST(MotionEstimator, SilenceOfTheWheelsIsNoRest) {
  // Wheels are silent for a while, or from somewhere on, and tell of another frame when they
  // return.
  for (const std::size_t back : {std::size_t{120}, std::size_t{200}}) {
    const std::vector<Pose2> truth = Drive(200);
    const Pose2 expected = Between(truth.front(), truth.back());
    MotionOptions options;
    options.source = MotionSource::kFused;
    MotionEstimator motion(options);
    const BoxScene room = FurnishedRoom();
    double worst = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      LaserScan scan = room.Scan(truth[i], 361, 270.0);
      scan.stamp = 0.2 * static_cast<double>(i);
      if (i < 60) scan.T_odom_robot = truth[i];
      if (i >= back) scan.T_odom_robot = Pose2{70.0, -3.0, 2.0} * truth[i];
      motion.Observe(scan);
      worst = std::max(worst, Distance(motion.T_odom_robot(), Between(truth.front(), truth[i])));
    }
    EXPECT_LT(worst, 0.06) << "m";
    EXPECT_LT(Distance(motion.T_odom_robot(), expected), 0.05) << "m";
  }
}

TEST(MotionEstimator, OfWheelsWithoutTurnsTheWayIsTaken) {
  // On, round on the place, back; then through a blank corridor, where only wheels tell the way.
  std::vector<Pose2> in_room = {Pose2{2.0, 2.5, 0.0}};
  for (const Pose2& step :
       {Pose2{0.06, 0.0, 0.0}, Pose2{0.0, 0.0, DegToRad(6.0)}, Pose2{-0.06, 0.0, 0.02}}) {
    for (int i = 0; i < 40; ++i) in_room.push_back(in_room.back() * step);
  }
  std::vector<Pose2> in_corridor = {Pose2{0.0, 0.1, 0.05}};
  for (int i = 0; i < 200; ++i) in_corridor.push_back(in_corridor.back() * Pose2{0.06, 0.0, 0.0});
  for (const auto& [truth, scene] :
       {std::pair{in_room, FurnishedRoom()}, std::pair{in_corridor, BlankCorridor()}}) {
    MotionOptions options;
    options.source = MotionSource::kFused;
    options.wheels_tell_turns = false;
    MotionEstimator motion(options);
    std::mt19937 random(4);
    double way = 0.0;
    double worst = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (i > 0) way += Distance(truth[i - 1], truth[i]);
      LaserScan scan = scene.Scan(truth[i], 361, 270.0, &random, 0.01);
      scan.stamp = 0.2 * static_cast<double>(i);
      scan.T_odom_robot = Pose2{way, 0.0, 0.0};
      motion.Observe(scan);
      worst = std::max(worst, Distance(motion.T_odom_robot(), Between(truth.front(), truth[i])));
    }
    EXPECT_LT(worst, 0.25) << "m, in a scene of " << scene.walls.size() << " walls";
    const double turned_rad = Between(truth.front(), truth.back()).theta;
    EXPECT_LT(RadToDeg(std::abs(WrapAngle(motion.T_odom_robot().theta - turned_rad))), 0.5)
        << "deg";
  }
}

TEST(MotionEstimator, ScansWithoutReturnsLeaveTheWheels) {
  MotionOptions options;
  options.source = MotionSource::kFused;
  MotionEstimator motion(options);
  for (int i = 0; i < 20; ++i) {
    LaserScan scan;
    scan.stamp = 0.2 * i;
    scan.max_range = 30.0F;
    scan.angle_step = 0.01;
    scan.ranges.assign(100, kNoReturn);
    scan.T_odom_robot = Pose2{0.1 * i, 0.0, 0.0};
    motion.Observe(scan);
  }
  EXPECT_NEAR(motion.T_odom_robot().x, 1.9, 1e-9);
}

TEST(MotionEstimator, AfterAGapOfScansTheWheelsAreBelieved) {
  // Two rooms of one plan, 8 m apart: the second matches the map of the first, 6 m off.
  BoxScene rooms = FurnishedRoom();
  for (BoxScene::Wall wall : FurnishedRoom().walls) {
    wall.from.x() += 8.0;
    wall.to.x() += 8.0;
    rooms.walls.push_back(wall);
  }
  MotionOptions options;
  options.source = MotionSource::kFused;
  MotionEstimator motion(options);
  double x = 2.0;
  for (int i = 0; i < 60; ++i) {
    const bool is_gap = i == 30;
    x += is_gap ? 6.0 : 0.05;
    LaserScan scan = rooms.Scan({x, 3.0, 0.0}, 181, 270.0);
    scan.stamp = 0.2 * i + (i >= 30 ? 10.0 : 0.0);
    scan.T_odom_robot = Pose2{x, 0.0, 0.0};
    motion.Observe(scan);
  }
  EXPECT_NEAR(motion.T_odom_robot().x, x - 2.05, 0.05);
  EXPECT_NEAR(motion.T_odom_robot().y, 0.0, 0.05);
}

// Stairs: blank walls at hand, and a landing at each end that is farther off than a cab's walls.
TEST(MotionEstimator, OnStairsWithoutWheelsTheLandingsTellTheWay) {
  BoxScene stairs;
  stairs.walls.push_back({{-4.0, -0.9}, {8.0, -0.9}});
  stairs.walls.push_back({{-4.0, 0.9}, {8.0, 0.9}});
  stairs.walls.push_back({{-4.0, -0.9}, {-4.0, 0.9}});
  stairs.walls.push_back({{8.0, -0.9}, {8.0, 0.9}});
  MotionOptions options;
  options.source = MotionSource::kScans;
  MotionEstimator motion(options);
  std::mt19937 random(3);
  Pose2 truth;
  for (int i = 0; i < 90; ++i) {
    if (i == 10) motion.EnterTransit();
    // At a walk, slowly, at rest for a while, and on.
    const double step = i < 20 ? 0.1 : i < 40 ? 0.03 : i < 60 ? 0.0 : 0.05;
    if (i > 0) truth.x += step;
    LaserScan scan = stairs.Scan(truth, 361, 270.0, &random);
    scan.stamp = 0.2 * i;
    motion.Observe(scan);
  }
  EXPECT_LT(Distance(motion.T_odom_robot(), truth), 0.05) << "m of " << truth.x;
}

}  // namespace
}  // namespace masked_mapper
