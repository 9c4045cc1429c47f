// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

/// What wheels make of the truth.
struct Wheels {
  double travel = 1.0;  ///< of the true travel is told
  double turn = 1.0;    ///< of the true turn is told
  double late_s = 0.0;  ///< scans are stamped as much ahead
  bool stand = false;   ///< they tell of no motion at all
  bool turn_at_random = false;
};

/// Rounds and straights in a furnished room, for `duration_s`, at 5 Hz.
WheelReport Drive(const Wheels& wheels, double duration_s = 120.0) {
  const BoxScene room = FurnishedRoom();
  WheelCheck check{MotionOptions{}};
  std::mt19937 random(1);
  Pose2 T_world_robot{2.5, 1.2, 0.0};
  Pose2 T_odom_robot{40.0, -7.0, 1.0};
  const int steps = static_cast<int>(5.0 * duration_s);
  std::deque<Observation> scans;
  int left = 10;
  bool turns = false;
  for (int i = 0; i < steps; ++i) {
    const double stamp = 0.2 * i;
    // Nothing that repeats itself: it would fit itself at several clocks.
    if (--left == 0) {
      left = 5 + static_cast<int>(random() % 15);
      turns = !turns;
    }
    const Pose2 step = turns ? Pose2{0.0, 0.0, DegToRad(6.0)} : Pose2{0.05, 0.0, 0.0};
    T_world_robot = T_world_robot * step;
    double turn = wheels.turn * step.theta;
    if (wheels.turn_at_random) turn = DegToRad(static_cast<double>(random() % 13) - 6.0);
    if (!wheels.stand) T_odom_robot = T_odom_robot * Pose2{wheels.travel * step.x, 0.0, turn};
    check.Observe(OdometryReading{stamp, T_odom_robot});
    LaserScan scan = room.Scan(T_world_robot, 271, 270.0, &random, 0.01);
    scan.stamp = stamp + wheels.late_s;
    scans.emplace_back(scan);
    // As a reader hands them out: in order of stamps.
    while (!scans.empty() && Stamp(scans.front()) <= stamp + 0.01) {
      check.Observe(std::get<LaserScan>(scans.front()));
      scans.pop_front();
    }
  }
  return check.Find({});
}

TEST(WheelCheck, HonestWheelsHaveNoFault) {
  EXPECT_TRUE(Drive({}).fault.IsNone());
  EXPECT_TRUE(Drive({1.04, 0.95}).fault.IsNone()) << "as much is in their noise";
}

TEST(WheelCheck, FindsWhatWheelsTellOfTheWay) {
  for (const double travel : {0.5, 0.8, 1.3, 2.0}) {
    const WheelFault fault = Drive({travel}).fault;
    ASSERT_TRUE(fault.travel_factor) << travel;
    EXPECT_NEAR(fault.travel_factor->value * travel, 1.0, 0.03);
    EXPECT_LT(fault.travel_factor->sigma, 0.05 / travel);
    EXPECT_FALSE(fault.turn_factor);
    EXPECT_FALSE(fault.scan_clock_s);
  }
}

TEST(WheelCheck, FindsWhatWheelsTellOfTurns) {
  for (const double turn : {0.6, 1.4}) {
    const WheelFault fault = Drive({1.0, turn}).fault;
    ASSERT_TRUE(fault.turn_factor) << turn;
    EXPECT_NEAR(fault.turn_factor->value * turn, 1.0, 0.03);
    EXPECT_FALSE(fault.scan_clock_s);
  }
}

TEST(WheelCheck, FindsAnotherClock) {
  for (const double late_s : {0.5, 1.7, 5.0}) {
    const WheelFault fault = Drive({1.0, 1.0, late_s}).fault;
    ASSERT_TRUE(fault.scan_clock_s) << "s: " << late_s;
    EXPECT_NEAR(fault.scan_clock_s->value, late_s, 0.05);
    EXPECT_FALSE(fault.turn_factor);
  }
  EXPECT_FALSE(Drive({1.0, 1.0, 0.1}).fault.scan_clock_s) << "a driver's delay is borne";
}

TEST(WheelCheck, FindsUselessWheels) {
  EXPECT_TRUE(Drive({1.0, 0.0}).fault.turns_useless);
  Wheels wheels;
  wheels.turn_at_random = true;
  EXPECT_TRUE(Drive(wheels).fault.turns_useless);
  wheels = {};
  wheels.stand = true;
  EXPECT_TRUE(Drive(wheels).fault.travel_useless);
}

TEST(WheelCheck, ShortOrLeftOutLogsSayNothing) {
  EXPECT_TRUE(WheelCheck{MotionOptions{}}.Find({}).fault.IsNone());
  EXPECT_TRUE(Drive({0.5, 0.0}, 4.0).fault.IsNone());
  WheelCheck check{MotionOptions{}};
  const BoxScene room = FurnishedRoom();
  for (int i = 0; i < 200; ++i) {
    LaserScan scan = room.Scan({2.0 + 0.01 * i, 1.2, 0.0}, 181, 180.0);
    scan.stamp = 0.2 * i;
    scan.T_odom_robot = Pose2{};
    check.Observe(scan);
  }
  EXPECT_TRUE(check.Find({{-1.0, 100.0}}).stretches.empty());
}

}  // namespace
}  // namespace masked_mapper
