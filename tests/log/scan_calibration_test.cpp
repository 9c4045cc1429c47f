// SPDX-License-Identifier: BSD-3-Clause
#include "log/scan_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

CarmenScan Flaser(const Pose2& T_odom_robot, const Pose2& T_robot_laser,
                  std::vector<float> ranges = {1.0F, 2.0F, 3.0F}) {
  CarmenScan scan;
  scan.T_odom_robot = T_odom_robot;
  scan.T_odom_laser = T_odom_robot * T_robot_laser;
  scan.beams = ranges.size();
  scan.ranges = std::move(ranges);
  return scan;
}

Pose2 OnAWalk(int i) { return {0.1 * i, std::sin(0.1 * i), 0.05 * i}; }

void ExpectPose(const Pose2& found, const Pose2& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-3) << "m";
  EXPECT_NEAR(found.y, expected.y, 1e-3) << "m";
  EXPECT_NEAR(RadToDeg(WrapAngle(found.theta - expected.theta)), 0.0, 0.1) << "deg";
}

Pose2 FoundLaser(const CalibrationFinder& finder, bool is_flaser = true) {
  CarmenScan scan = Flaser({}, {});
  scan.is_flaser = is_flaser;
  std::uint64_t invalid = 0;
  return finder.Find().Apply(scan, &invalid).T_robot_laser;
}

TEST(CalibrationFinderTest, AScannerThatHangsTurnsItsBeamsRound) {
  LogOptions options;
  CarmenScan scan = Flaser({}, {0.2, 0.1, 0.0});
  std::uint64_t invalid = 0;
  const LaserScan upright = CalibrationFinder(options).Find().Apply(scan, &invalid);
  options.upside_down = true;
  const LaserScan hanging = CalibrationFinder(options).Find().Apply(scan, &invalid);
  for (std::size_t beam = 0; beam < 3; ++beam) {
    EXPECT_EQ(hanging.Angle(beam), -upright.Angle(beam));
    EXPECT_EQ(hanging.ranges[beam], upright.ranges[beam]);
  }
}

TEST(FlaserGeometryTest, FollowsTheNumberOfBeams) {
  for (const auto& [beams, step_deg, last_deg] :
       std::vector<std::tuple<std::size_t, double, double>>{
           {180, 1.0, 89.0}, {181, 1.0, 90.0}, {360, 0.5, 89.5}, {361, 0.5, 90.0}}) {
    const BeamGeometry geometry = FlaserGeometry(beams, kPi);
    EXPECT_NEAR(RadToDeg(geometry.first_angle), -90.0, 1e-9) << beams;
    EXPECT_NEAR(RadToDeg(geometry.angle_step), step_deg, 1e-9) << beams;
    const double last = geometry.first_angle + geometry.angle_step * static_cast<double>(beams - 1);
    EXPECT_NEAR(RadToDeg(last), last_deg, 1e-9) << beams;
  }
  EXPECT_NEAR(RadToDeg(FlaserGeometry(1081, DegToRad(270.0)).angle_step), 0.25, 1e-9);
  EXPECT_NEAR(RadToDeg(FlaserGeometry(360, DegToRad(360.0)).angle_step), 1.0, 1e-9);
}

TEST(RobotLaserGeometryTest, BelievesTheFieldsThatAgree) {
  CarmenScan scan;
  scan.is_flaser = false;
  scan.beams = 626;
  scan.start_angle = -1.91986;
  scan.field_of_view = 3.83972;
  scan.angle_step = 0.00614355;
  EXPECT_EQ(RobotLaserGeometry(scan).angle_step, 0.00614355);
  scan.angle_step = 0.0;  // not given
  EXPECT_NEAR(RobotLaserGeometry(scan).angle_step, 3.83972 / 625.0, 1e-12);
  scan.angle_step = 0.0123;  // of another mode
  EXPECT_NEAR(RobotLaserGeometry(scan).angle_step, 3.83972 / 625.0, 1e-12);
  scan.beams = 181;
  scan.field_of_view = 0.0;
  scan.angle_step = 0.0;
  EXPECT_NEAR(RadToDeg(RobotLaserGeometry(scan).first_angle), -90.0, 1e-9);
}

TEST(CalibrationFinderTest, FindsWhereTheLaserSits) {
  for (const Pose2& T_robot_laser :
       {Pose2{-0.04, 0.0, 0.0}, Pose2{0.78, -0.1, 0.02}, Pose2{-0.3, 0.0, kPi}, Pose2{}}) {
    CalibrationFinder finder{LogOptions{}};
    for (int i = 0; i < 400; ++i) {
      CarmenScan scan = Flaser(OnAWalk(i), T_robot_laser);
      // As a log writes it, and now and then a wrong line.
      scan.T_odom_laser.x = std::round(scan.T_odom_laser.x * 1e3) / 1e3;
      if (i % 20 == 3) scan.T_odom_laser = {};
      finder.Add(scan);
    }
    ExpectPose(FoundLaser(finder), T_robot_laser);
  }
}

TEST(CalibrationFinderTest, APoseThatDriftsAwayFromOdometryIsNoOffset) {
  CalibrationFinder finder{LogOptions{}};
  finder.Add(CarmenParam{"robot_frontlaser_offset", "0.12"});
  for (int i = 0; i < 400; ++i) {
    CarmenScan scan = Flaser(OnAWalk(i), {});
    scan.T_odom_laser = Pose2{0.3, 0.0, 0.001 * i} * scan.T_odom_laser;  // a corrected pose
    finder.Add(scan);
  }
  ExpectPose(FoundLaser(finder), {0.12, 0.0, 0.0});
}

TEST(CalibrationFinderTest, OptionsOverruleTheLog) {
  LogOptions options;
  options.laser_y = 0.2;
  options.laser_theta_deg = 90.0;
  CalibrationFinder finder(options);
  for (int i = 0; i < 10; ++i) finder.Add(Flaser(OnAWalk(i), {-0.04, 0.0, 0.0}));
  ExpectPose(FoundLaser(finder), {0.0, 0.2, kPi / 2});
}

TEST(CalibrationFinderTest, OdometryOnlyInTheLasersPoseIsUsed) {
  CalibrationFinder finder{LogOptions{}};
  CarmenScan scan;
  for (int i = 0; i < 50; ++i) {
    scan = Flaser({}, {});
    scan.T_odom_laser = OnAWalk(i);
    finder.Add(scan);
  }
  std::uint64_t invalid = 0;
  ExpectPose(*finder.Find().Apply(scan, &invalid).T_odom_robot, OnAWalk(49));
}

TEST(CalibrationFinderTest, ParamsSayTheFieldOfView) {
  CalibrationFinder finder{LogOptions{}};
  finder.Add(CarmenParam{"laser_front_laser_fov", "270"});
  std::uint64_t invalid = 0;
  LaserScan scan = finder.Find().Apply(Flaser({}, {}, std::vector<float>(541, 1.0F)), &invalid);
  EXPECT_NEAR(RadToDeg(scan.first_angle), -135.0, 1e-9);
  EXPECT_NEAR(RadToDeg(scan.angle_step), 0.5, 1e-9);

  CalibrationFinder by_resolution{LogOptions{}};
  by_resolution.Add(CarmenParam{"laser_front_laser_resolution", "0.25"});
  scan = by_resolution.Find().Apply(Flaser({}, {}, std::vector<float>(401, 1.0F)), &invalid);
  EXPECT_NEAR(RadToDeg(scan.first_angle), -50.0, 1e-9);
  // 180 beams at 0.25 degrees would be 45 degrees, which no scanner has: a stale parameter.
  scan = by_resolution.Find().Apply(Flaser({}, {}, std::vector<float>(180, 1.0F)), &invalid);
  EXPECT_NEAR(RadToDeg(scan.angle_step), 1.0, 1e-9);
}

TEST(CalibrationFinderTest, JudgesEachRange) {
  LogOptions options;
  options.max_range = 30.0;
  const float inf = std::numeric_limits<float>::infinity();
  const CarmenScan raw =
      Flaser({}, {}, {1.0F, 0.01F, 0.0F, -1.0F, std::nanf(""), inf, -inf, 30.0F, 29.99F, 5000.0F});
  std::uint64_t invalid = 0;
  const LaserScan scan = CalibrationFinder(options).Find().Apply(raw, &invalid);
  EXPECT_EQ(scan.ranges[0], 1.0F);
  for (const std::size_t beam : {1U, 2U, 3U, 4U, 6U, 9U})
    EXPECT_TRUE(std::isnan(scan.ranges[beam])) << beam;
  EXPECT_EQ(scan.ranges[5], kNoReturn);
  EXPECT_EQ(scan.ranges[7], kNoReturn);
  EXPECT_EQ(scan.ranges[8], 29.99F);
  EXPECT_EQ(scan.max_range, 30.0F);
  EXPECT_EQ(invalid, 4U);
}

TEST(CalibrationFinderTest, ScansSayTheirOwnLimitUnlessTheyContradictThemselves) {
  CarmenScan scan = Flaser({}, {}, {1.0F, 25.0F, 24.9F});
  scan.is_flaser = false;
  scan.maximum_range = 25.0;
  std::uint64_t invalid = 0;
  CalibrationFinder finder{LogOptions{}};
  for (int i = 0; i < 10; ++i) finder.Add(scan);
  LaserScan result = finder.Find().Apply(scan, &invalid);
  EXPECT_EQ(result.max_range, 25.0F);
  EXPECT_EQ(result.ranges[1], kNoReturn);
  EXPECT_EQ(result.ranges[2], 24.9F);

  scan.maximum_range = 2.0;
  CalibrationFinder contradicted{LogOptions{}};
  for (int i = 0; i < 10; ++i) contradicted.Add(scan);
  result = contradicted.Find().Apply(scan, &invalid);
  EXPECT_EQ(result.ranges[1], 25.0F);
}

}  // namespace
}  // namespace masked_mapper
