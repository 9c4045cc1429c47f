// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

/// 40 m by 2 m with niches, as a building's corridor has them.
BoxScene Corridor(bool has_niches) {
  BoxScene corridor;
  corridor.AddBox(0.0, -1.0, 40.0, 1.0);
  for (int i = 1; has_niches && i < 13; ++i) {
    corridor.AddBox(3.0 * i, i % 2 == 0 ? 0.7 : -1.0, 3.0 * i + 0.9, i % 2 == 0 ? 1.0 : -0.7);
  }
  return corridor;
}

using Motion = std::function<Pose2(double stamp)>;

std::vector<FalseRest> Found(const BoxScene& scene, double duration_s, const Motion& truth,
                             const Motion& wheels) {
  StandstillCheck check{MotionOptions{}};
  std::mt19937 random(3);
  for (double stamp = 0.0; stamp < duration_s; stamp += 0.2) {
    LaserScan scan = scene.Scan(truth(stamp), 361, 270.0, &random, 0.01);
    scan.stamp = stamp;
    scan.T_odom_robot = wheels(stamp);
    check.Observe(scan);
  }
  return check.Find();
}

/// Along x at half a metre a second; wheels stop telling of it between `from` and `to`.
Pose2 Along(double stamp) { return {2.0 + 0.5 * stamp, 0.0, 0.0}; }

TEST(StandstillCheck, HonestWheelsAreBelieved) {
  EXPECT_TRUE(Found(Corridor(true), 60.0, Along, Along).empty());
  const auto rests = [](double stamp) { return Along(std::min(stamp, 20.0)); };
  EXPECT_TRUE(Found(Corridor(true), 60.0, rests, rests).empty());
}

TEST(StandstillCheck, ARobotThatIsCarriedMoves) {
  for (const double carried_s : {3.0, 8.0, 20.0}) {
    const auto wheels = [&](double stamp) {
      return Along(stamp < 20.0 ? stamp : std::max(20.0, stamp - carried_s));
    };
    const std::vector<FalseRest> found = Found(Corridor(true), 60.0, Along, wheels);
    ASSERT_EQ(found.size(), 1U) << "s carried: " << carried_s;
    EXPECT_NEAR(found[0].span.start, 20.0, 0.3);
    EXPECT_NEAR(found[0].span.end, 20.0 + carried_s, 0.5);
    EXPECT_EQ(found[0].leap_m, 0.0);
  }
}

TEST(StandstillCheck, AFreezeToTheEndEndsWithTheLog) {
  const auto wheels = [](double stamp) { return Along(std::min(stamp, 20.0)); };
  const std::vector<FalseRest> found = Found(Corridor(true), 40.0, Along, wheels);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].span.end, 40.0, 0.5);
}

TEST(StandstillCheck, AFreezeEndsInALeap) {
  for (const double frozen_s : {1.0, 4.0}) {
    const auto wheels = [&](double stamp) {
      return Along(stamp > 20.0 && stamp < 20.0 + frozen_s ? 20.0 : stamp);
    };
    // A freeze of a second leaps by half a metre, no faster than a robot may go.
    const std::vector<FalseRest> found = Found(Corridor(true), 40.0, Along, wheels);
    ASSERT_EQ(found.size(), frozen_s < 2.0 ? 0U : 1U);
    if (found.empty()) continue;
    EXPECT_NEAR(found[0].span.end, 24.0, 0.5);
  }
}

TEST(StandstillCheck, OdometryThatBeginsAnewLeaps) {
  const auto wheels = [](double stamp) {
    return stamp < 20.0 ? Along(stamp) : Pose2{0.5 * (stamp - 20.0), 0.0, 2.0};
  };
  const std::vector<FalseRest> found = Found(Corridor(true), 40.0, Along, wheels);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].leap_m, 12.0, 0.5);
  EXPECT_LT(found[0].span.Duration(), 1.0) << "s";
}

TEST(StandstillCheck, PeopleAndDoorsMoveNoRobot) {
  // Somebody walks ahead of a robot at rest, all along a corridor that is blank but for him.
  StandstillCheck check{MotionOptions{}};
  std::mt19937 random(3);
  for (double stamp = 0.0; stamp < 40.0; stamp += 0.2) {
    BoxScene scene = Corridor(false);
    const double x = 3.5 + 0.5 * stamp;
    scene.AddBox(x, -0.25, x + 0.3, 0.25);
    // And a door to a room opens beside it.
    if (stamp > 20.0) scene.AddBox(2.5, 0.9, 3.4, 1.0);
    LaserScan scan = scene.Scan({2.0, 0.0, 0.0}, 361, 270.0, &random, 0.01);
    scan.stamp = stamp;
    scan.T_odom_robot = Pose2{};
    check.Observe(scan);
  }
  EXPECT_TRUE(check.Find().empty());
}

TEST(StandstillCheck, AnotherSceneIsNoMotion) {
  // The door of a cab opens on another place.
  StandstillCheck check{MotionOptions{}};
  for (double stamp = 0.0; stamp < 30.0; stamp += 0.2) {
    BoxScene cab;
    cab.AddBox(-1.0, -1.0, 1.0, 1.0);
    const Pose2 place{stamp < 15.0 ? 12.0 : 30.0, 0.3, 0.4};
    LaserScan scan =
        (stamp < 5.0 ? cab : Corridor(true)).Scan(stamp < 5.0 ? Pose2{} : place, 361, 270.0);
    scan.stamp = stamp;
    scan.T_odom_robot = Pose2{};
    check.Observe(scan);
  }
  EXPECT_TRUE(check.Find().empty());
}

TEST(StandstillCheck, ScansWithoutReturnsOrOdometrySayNothing) {
  StandstillCheck check{MotionOptions{}};
  EXPECT_TRUE(check.Find().empty());
  for (int i = 0; i < 50; ++i) {
    LaserScan scan;
    scan.stamp = 0.2 * i;
    scan.ranges.assign(static_cast<std::size_t>(i % 3) * 90, kNoReturn);
    if (i % 2 == 0) scan.T_odom_robot = Pose2{};
    check.Observe(scan);
  }
  EXPECT_TRUE(check.Find().empty());
}

}  // namespace
}  // namespace masked_mapper
