// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/laser_scan.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(BeamSweep, AgreesWithSineAndCosineForThousandsOfBeams) {
  LaserScan scan;
  scan.T_robot_laser = {0.3, -0.2, 2.5};
  scan.first_angle = -1.3;
  for (const double step : {DegToRad(0.1), -DegToRad(0.7)}) {
    scan.angle_step = step;
    auto in_laser = BeamSweep::InLaser(scan);
    auto in_robot = BeamSweep::InRobot(scan);
    double worst = 0.0;
    for (std::size_t beam = 0; beam < 5000; ++beam) {
      const auto off = [&](const BeamSweep& sweep, double offset) {
        const double angle = offset + scan.Angle(beam);
        return (sweep.Current() - Eigen::Vector2d(std::cos(angle), std::sin(angle))).norm();
      };
      worst = std::max({worst, off(in_laser, 0.0), off(in_robot, scan.T_robot_laser.theta)});
      in_laser.Advance();
      in_robot.Advance();
    }
    EXPECT_LT(worst, 1e-11);
  }
}

}  // namespace
}  // namespace masked_mapper
