// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/acceleration.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(Acceleration, FeelsGravityAndTheElevator) {
  AccelerationSimulation acceleration(AccelerationNoise::None(), 1);
  RobotState state;
  EXPECT_NEAR(acceleration.Measure(state).z(), 9.80665, 1e-12) << "m/s^2";
  state.vertical_acceleration = 0.8;
  EXPECT_NEAR(acceleration.Measure(state).z(), 10.60665, 1e-12) << "m/s^2";
  EXPECT_EQ(acceleration.Measure(state).x(), 0.0);
}

TEST(Acceleration, FeelsCurvesAndBrakes) {
  AccelerationSimulation acceleration(AccelerationNoise::None(), 1);
  RobotState state;
  state.speed = 0.6;
  state.turn_rate = 0.5;
  state.speed_change = -0.4;
  EXPECT_NEAR(acceleration.Measure(state).x(), -0.4, 1e-12) << "m/s^2";
  EXPECT_NEAR(acceleration.Measure(state).y(), 0.3, 1e-12) << "m/s^2";
}

TEST(Acceleration, IsPitchedWithTheRobot) {
  AccelerationSimulation acceleration(AccelerationNoise::None(), 1);
  RobotState state;
  state.slope = 0.6;
  EXPECT_NEAR(acceleration.Measure(state).x(), 0.6 * 9.80665, 1e-12) << "m/s^2";
  EXPECT_NEAR(acceleration.Measure(state).z(), 0.8 * 9.80665, 1e-12) << "m/s^2";
}

}  // namespace
}  // namespace masked_mapper
