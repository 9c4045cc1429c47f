// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/odometry_simulation.hpp"

#include <gtest/gtest.h>

#include "simulation/building_plans.hpp"
#include "simulation/robot_drive.hpp"

namespace masked_mapper {
namespace {

TEST(OdometrySimulation, WithoutNoiseItIsTheTruth) {
  const Building office = OfficeBuilding();
  const RobotDrive drive(office, PlanTour(office, {1, 0.0, {}}), {});
  OdometrySimulation odometry(OdometryNoise::None(), 1);
  const Pose2 start = drive.At(0.0).T_building_robot;
  Pose2 last = start;
  for (double time = 0.1; time < drive.Duration(); time += 0.1) {
    const Pose2 now = drive.At(time).T_building_robot;
    odometry.Advance(Between(last, now), 0.1);
    const Pose2 truth = Between(start, now);
    ASSERT_NEAR(Distance(odometry.T_odom_robot(), truth), 0.0, 1e-6) << "m";
    ASSERT_NEAR(WrapAngle(odometry.T_odom_robot().theta - truth.theta), 0.0, 1e-9) << "rad";
    last = now;
  }
}

TEST(OdometrySimulation, GyroDriftsByThirtyDegreesInTwoAndAHalfHours) {
  double sum = 0.0;
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    OdometrySimulation odometry({}, static_cast<std::uint64_t>(seed));
    for (int second = 0; second < 9'000; ++second) odometry.Advance({}, 1.0);
    const double drift_deg = std::abs(RadToDeg(odometry.T_odom_robot().theta));
    EXPECT_GT(drift_deg, 15.0) << "seed " << seed;
    EXPECT_LT(drift_deg, 40.0) << "seed " << seed;
    EXPECT_EQ(odometry.T_odom_robot().x, 0.0);
    sum += drift_deg;
  }
  EXPECT_NEAR(sum / kSeeds, 27.0, 3.0) << "deg";
}

TEST(OdometrySimulation, DistanceIsOffByTwoPercent) {
  OdometryNoise noise = OdometryNoise::None();
  noise.scale_error = 0.02;
  OdometrySimulation odometry(noise, 4);
  for (int i = 0; i < 1000; ++i) odometry.Advance({0.1, 0.0, 0.0}, 0.2);
  EXPECT_NEAR(std::abs(odometry.T_odom_robot().x - 100.0), 2.0, 1e-9) << "m";
}

TEST(OdometrySimulation, NoiseDoesNotDependOnHowOftenItIsRead) {
  // The spread after ten metres is the same whether read every centimetre or every metre.
  const auto spread = [](double step) {
    OdometryNoise noise = OdometryNoise::None();
    noise.distance_sigma = 0.01;
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
      OdometrySimulation odometry(noise, seed);
      for (int i = 0; i < static_cast<int>(10.0 / step + 0.5); ++i) {
        odometry.Advance({step, 0.0, 0.0}, step);
      }
      squares += std::pow(odometry.T_odom_robot().x - 10.0, 2.0);
    }
    return std::sqrt(squares / 400.0);
  };
  EXPECT_NEAR(spread(0.01), 0.01 * std::sqrt(10.0), 0.004) << "m";
  EXPECT_NEAR(spread(1.0), 0.01 * std::sqrt(10.0), 0.004) << "m";
}

}  // namespace
}  // namespace masked_mapper
