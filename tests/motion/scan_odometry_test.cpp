// SPDX-License-Identifier: BSD-3-Clause
#include "motion/scan_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

UncertainPose2 Wheels(const Pose2& motion, double sigma_m, double sigma_deg) {
  UncertainPose2 step;
  step.mean = motion;
  step.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m,
      DegToRad(sigma_deg) * DegToRad(sigma_deg);
  return step;
}

TEST(ScanOdometry, RecoversMotionThatTheWheelsGetWrong) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  ScanOdometry odometry({});
  Pose2 truth{2.0, 2.0, 0.3};
  const Pose2 start = truth;
  Pose2 path;
  for (int i = 0; i < 100; ++i) {
    const Pose2 step{0.07, 0.0, DegToRad(3.0)};
    if (i > 0) truth = truth * step;
    // Wheels that lose a tenth of the way, turn a degree too far, and shake.
    const Pose2 wheels = i == 0 ? Pose2{}
                                : Pose2{0.063 + 0.01 * normal(random), 0.01 * normal(random),
                                        DegToRad(4.0 + 0.5 * normal(random))};
    path = path *
           odometry.Observe(room.Scan(truth, 361, 270.0, &random), Wheels(wheels, 0.02, 1.5)).mean;
  }
  const Pose2 expected = Between(start, truth);
  EXPECT_LT(Distance(path, expected), 0.03) << "m";
  EXPECT_LT(RadToDeg(std::abs(WrapAngle(path.theta - expected.theta))), 0.5) << "deg";
}

TEST(ScanOdometry, HoldsStillWhenTheRobotDoes) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(4);
  ScanOdometry odometry({});
  Pose2 path;
  for (int i = 0; i < 500; ++i) {
    const UncertainPose2 step =
        odometry.Observe(room.Scan({3.0, 3.0, 1.0}, 361, 270.0, &random), UncertainPose2{});
    path = path * step.mean;
    EXPECT_EQ(step.covariance.norm(), 0.0);
  }
  EXPECT_EQ(path.x, 0.0);
  EXPECT_EQ(path.theta, 0.0);
}

TEST(ScanOdometry, BlankCorridorIsNeitherShortenedNorCalledKnown) {
  const BoxScene corridor = BlankCorridor();
  std::mt19937 random(9);
  ScanOdometry odometry({});
  UncertainPose2 path;
  Pose2 truth{0.0, 0.2, 0.0};
  for (int i = 0; i < 150; ++i) {
    if (i > 0) truth.x += 0.1;
    // Wheels that are right about the way and drift in heading by half a degree a step.
    const Pose2 wheels = i == 0 ? Pose2{} : Pose2{0.1, 0.0, DegToRad(0.5)};
    path = path *
           odometry.Observe(corridor.Scan(truth, 361, 270.0, &random), Wheels(wheels, 0.02, 1.0));
  }
  EXPECT_NEAR(path.mean.x, 14.9, 0.15) << "m along";
  EXPECT_NEAR(path.mean.y, 0.0, 0.1) << "m across";
  EXPECT_NEAR(RadToDeg(path.mean.theta), 0.0, 0.5) << "deg";
  // Along: the wheels' own random walk, 0.02 m a step.
  EXPECT_GT(std::sqrt(path.covariance(0, 0)), 0.5 * 0.02 * std::sqrt(149.0));
  EXPECT_LT(std::sqrt(path.covariance(0, 0)), 2.0 * 0.02 * std::sqrt(149.0));
}

TEST(ScanOdometry, APersonWalkingAheadDoesNotHoldTheRobotBack) {
  const auto travelled = [](double blank_ratio) {
    std::mt19937 random(9);
    ScanOdometryOptions options;
    options.blank_ratio = blank_ratio;
    ScanOdometry odometry(options);
    Pose2 path;
    Pose2 truth{0.0, 0.2, 0.0};
    for (int i = 0; i < 120; ++i) {
      if (i > 0) truth.x += 0.12;
      BoxScene corridor = BlankCorridor();
      if (i > 30) corridor.AddBox(truth.x + 2.5, 0.1, truth.x + 2.7, 0.4);
      const Pose2 wheels = i == 0 ? Pose2{} : Pose2{0.12, 0.0, 0.0};
      path = path *
             odometry.Observe(corridor.Scan(truth, 361, 270.0, &random), Wheels(wheels, 0.02, 1.0))
                 .mean;
    }
    return path.x;
  };
  const double truth_m = 119 * 0.12;
  EXPECT_NEAR(travelled(ScanOdometryOptions{}.blank_ratio), truth_m, 0.4) << "m along";
  EXPECT_LT(travelled(1e9), 0.5 * truth_m) << "the scene is meant to be one that deceives";
}

TEST(ScanOdometry, AtRestAFewScansSettleTheHeadingOfAPoorView) {
  // A cab: the first scans on a robot that turns in it err by tenths of a degree each.
  BoxScene cab;
  cab.AddBox(-0.8, -0.9, 0.8, 0.9);
  double settled = 0.0;
  double unsettled = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const int rest_scans : {0, 15}) {
      std::mt19937 random(seed);
      ScanOdometryOptions options;
      options.rest_scans = rest_scans;
      ScanOdometry odometry(options);
      Pose2 path;
      Pose2 truth;
      for (int i = 0; i < 80; ++i) {
        // A first small turn, a rest while the door closes, half a turn, and the ride.
        const bool turns = i == 1 || (i > 25 && i <= 45);
        const double turn = turns ? DegToRad(i == 1 ? 1.0 : 9.0) : 0.0;
        truth.theta = WrapAngle(truth.theta + turn);
        std::normal_distribution<double> slip(0.0, DegToRad(0.12));
        const Pose2 wheels{0.0, 0.0, turns ? turn + slip(random) : 0.0};
        path = path * odometry
                          .Observe(cab.Scan(truth, 361, 270.0, &random),
                                   turns ? Wheels(wheels, 0.002, 0.12) : UncertainPose2{})
                          .mean;
      }
      const double error = RadToDeg(std::abs(WrapAngle(path.theta - truth.theta)));
      (rest_scans > 0 ? settled : unsettled) += error / 20.0;
    }
  }
  EXPECT_LT(settled, 0.18) << "deg";
  EXPECT_LT(settled, 0.9 * unsettled) << "deg";
}

TEST(ScanOdometry, AForcedMatchOfAnotherSceneDoesNotMoveARobotAtRest) {
  const BoxScene room = FurnishedRoom();
  BoxScene cab;
  cab.AddBox(-1.0, -1.0, 1.0, 1.0);
  std::mt19937 random(12);
  ScanOdometry odometry({});
  for (int i = 0; i < 5; ++i) {
    odometry.Observe(room.Scan({3.0, 3.0, 1.0}, 361, 270.0, &random), UncertainPose2{});
  }
  const UncertainPose2 step =
      odometry.Observe(cab.Scan({0.2, 0.1, 0.4}, 361, 270.0, &random), UncertainPose2{}, true);
  EXPECT_LT(std::hypot(step.mean.x, step.mean.y), 0.01) << "m";
  EXPECT_LT(RadToDeg(std::abs(step.mean.theta)), 0.2) << "deg";
}

TEST(ScanOdometry, AnotherSceneAltogetherIsNotBelievedAndThenBegunAnew) {
  const BoxScene room = FurnishedRoom();
  BoxScene other;
  other.AddBox(-3.0, -20.0, 1.3, 15.0);
  std::mt19937 random(6);
  ScanOdometry odometry({});
  for (int i = 0; i < 30; ++i) {
    odometry.Observe(room.Scan({2.0 + 0.1 * i, 3.0, 0.0}, 361, 270.0, &random),
                     Wheels({i > 0 ? 0.1 : 0.0, 0.0, 0.0}, 0.02, 1.0));
  }
  odometry.Restart();
  Pose2 path;
  for (int i = 0; i < 30; ++i) {
    path = path * odometry
                      .Observe(other.Scan({0.0, 0.1 * i, 1.57}, 361, 270.0, &random),
                               Wheels({i > 0 ? 0.1 : 0.0, 0.0, 0.0}, 0.02, 1.0))
                      .mean;
  }
  EXPECT_NEAR(path.x, 2.9, 0.05) << "m";
  EXPECT_NEAR(path.y, 0.0, 0.05) << "m";
}

TEST(ScanOdometry, ASceneThatChangesInTransitTurnsNoRobot) {
  // A cab, and then at once a hall on whose walls the cab's fit nowhere near; the robot goes on.
  BoxScene cab;
  cab.AddBox(-1.0, -1.0, 1.0, 1.0);
  BoxScene hall;
  hall.AddBox(-1.6, -2.3, 7.0, 2.1);
  hall.AddBox(3.0, 0.6, 3.8, 1.4);
  for (const int late : {0, 4, 12}) {  // scans from the change to when it is said to be one
    std::mt19937 random(5);
    ScanOdometry odometry({});
    for (int i = 0; i < 20; ++i) {
      if (i == 3) odometry.EnterTransit();
      odometry.Observe(cab.Scan({}, 181, 180.0, &random, 0.01), UncertainPose2{});
    }
    Pose2 truth;
    Pose2 path;
    for (int i = 0; i < 30; ++i) {
      if (i == late) odometry.LeaveTransit();
      const Pose2 step = i < 8 ? Pose2{} : Pose2{0.1, 0.0, DegToRad(2.0)};
      truth = truth * step;
      path = path * odometry
                        .Observe(hall.Scan(truth, 181, 180.0, &random, 0.01),
                                 i < 8 ? UncertainPose2{} : Wheels(step, 0.02, 1.0), i == late)
                        .mean;
    }
    EXPECT_LT(Distance(path, truth), 0.05) << late << " scans late";
    EXPECT_LT(RadToDeg(std::abs(WrapAngle(path.theta - truth.theta))), 0.5) << late;
  }
}

/// A robot at rest in a room, matched once more; then it sees `later` until the map is lost.
ScanOdometry LostAtRest(const LaserScan& later) {
  ScanOdometryOptions options;
  options.settled_deg = 0.0;
  ScanOdometry odometry(options);
  const LaserScan room = FurnishedRoom().Scan({3.0, 3.0, 1.0}, 361, 270.0);
  odometry.Observe(room, UncertainPose2{});
  odometry.Observe(room, UncertainPose2{});
  for (int i = 0; i < 5; ++i) odometry.Observe(later, UncertainPose2{});
  return odometry;
}

TEST(ScanOdometry, AMapThatIsLostWithNothingToSeeBeginsAtTheNextScan) {
  LaserScan nothing = FurnishedRoom().Scan({3.0, 3.0, 1.0}, 361, 270.0);
  nothing.ranges.assign(nothing.ranges.size(), kNoReturn);
  ScanOdometry odometry = LostAtRest(nothing);
  EXPECT_EQ(odometry.map_scans(), 0U);
  odometry.Observe(nothing, UncertainPose2{});
  EXPECT_EQ(odometry.map_scans(), 0U);
  odometry.Observe(FurnishedRoom().Scan({3.0, 3.0, 1.0}, 361, 270.0), UncertainPose2{});
  EXPECT_EQ(odometry.map_scans(), 1U);
}

TEST(ScanOdometry, TheScanThatBeginsAMapAnewIsInItOnce) {
  BoxScene hall;
  hall.AddBox(-21.3, -17.6, 22.4, 19.7);
  EXPECT_EQ(LostAtRest(hall.Scan({}, 361, 270.0)).map_scans(), 1U);
}

TEST(ScanOdometry, ATurnInACabIsTheBetterTheLongerTheRobotStoodBefore) {
  // Half a turn between near walls hangs on what is known of them before it: one scan, or several.
  BoxScene cab;
  cab.AddBox(-0.9, -1.0, 1.1, 0.9);
  const auto error_deg = [&](int scans_at_rest) {
    double squares = 0.0;
    constexpr int kRuns = 30;
    for (unsigned run = 0; run < kRuns; ++run) {
      std::mt19937 random(run);
      ScanOdometry odometry({});
      Pose2 truth;
      Pose2 path;
      const auto observe = [&](const Pose2& motion) {
        truth = truth * motion;
        const UncertainPose2 wheels =
            motion.theta == 0.0 ? UncertainPose2{} : Wheels(motion, 0.002, 0.5);
        path = path * odometry.Observe(cab.Scan(truth, 361, 270.0, &random, 0.01), wheels).mean;
      };
      for (int i = 0; i < scans_at_rest; ++i) observe({});
      for (int i = 0; i < 20; ++i) observe({0.0, 0.0, DegToRad(9.0)});
      for (int i = 0; i < 10; ++i) observe({});
      const double left = RadToDeg(WrapAngle(path.theta - truth.theta));
      squares += left * left / kRuns;
    }
    return std::sqrt(squares);
  };
  const double after_one = error_deg(1);
  const double after_many = error_deg(15);
  EXPECT_LT(after_many, 0.75 * after_one);
  EXPECT_LT(after_many, 0.08) << "deg";
}

}  // namespace
}  // namespace masked_mapper
