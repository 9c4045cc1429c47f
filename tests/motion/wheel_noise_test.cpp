// SPDX-License-Identifier: BSD-3-Clause
#include "motion/wheel_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

constexpr double kSure = 1e-4;  // rad
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Drives `metres` straight in steps of 0.1 m, with a heading error of `deg_per_sqrt_m`.
void DriveStraight(double metres, double deg_per_sqrt_m, double scan_sigma_rad,
                   std::mt19937& random, WheelNoise& noise) {
  std::normal_distribution<double> error(0.0, DegToRad(deg_per_sqrt_m) * std::sqrt(0.1));
  for (double way = 0.0; way < metres; way += 0.1) {
    noise.Observe({0.1, 0.0, error(random)}, {0.1, 0.0, 0.0}, scan_sigma_rad);
  }
}

TEST(WheelNoise, ExpectsTheDefaultsBeforeAnythingWasSeen) {
  const WheelNoise noise({}, {});
  EXPECT_DOUBLE_EQ(noise.scales().travel, 1.0);
  EXPECT_DOUBLE_EQ(noise.scales().turn, 1.0);
}

TEST(WheelNoise, RecoversTheNoiseOfARobotBetterThanTheDefaults) {
  DeadReckoningOptions wheels;
  for (const double truth_deg : {0.3, 0.6, 1.0}) {
    std::mt19937 random(7);
    WheelNoise noise({}, wheels);
    DriveStraight(400.0, truth_deg, kSure, random, noise);
    const double learnt_deg = noise.scales().travel * wheels.sigma_heading_deg_per_sqrt_m;
    EXPECT_NEAR(learnt_deg, truth_deg, 0.35 * truth_deg);
    EXPECT_DOUBLE_EQ(noise.scales().turn, 1.0) << "it never turned";
  }
}

TEST(WheelNoise, TellsTurnsFromTravel) {
  DeadReckoningOptions wheels;
  std::mt19937 random(3);
  WheelNoise noise({}, wheels);
  std::normal_distribution<double> error(0.0, DegToRad(0.6) * std::sqrt(0.1));
  for (int i = 0; i < 4000; ++i) {
    noise.Observe({0.0, 0.0, 0.1 + error(random)}, {0.0, 0.0, 0.1}, kSure);
  }
  EXPECT_NEAR(noise.scales().turn * wheels.sigma_heading_deg_per_sqrt_rad, 0.6, 0.2);
  EXPECT_DOUBLE_EQ(noise.scales().travel, 1.0);
}

TEST(WheelNoise, NeverGoesAboveTheDefaultsNorBelowTheLeast) {
  WheelNoiseOptions options;
  std::mt19937 random(1);
  WheelNoise bad(options, {});
  DriveStraight(200.0, 20.0, kSure, random, bad);
  EXPECT_DOUBLE_EQ(bad.scales().travel, 1.0);
  WheelNoise perfect(options, {});
  DriveStraight(2000.0, 0.0, kSure, random, perfect);
  EXPECT_DOUBLE_EQ(perfect.scales().travel, options.least_scale);
}

TEST(WheelNoise, LearnsNothingFromScansThatAreUnsure) {
  std::mt19937 random(1);
  WheelNoise noise({}, {});
  DriveStraight(200.0, 0.0, DegToRad(1.0), random, noise);
  DriveStraight(200.0, 0.0, kNever, random, noise);
  EXPECT_DOUBLE_EQ(noise.scales().travel, 1.0);
}

TEST(WheelNoise, OneSlipIsNotTheNoise) {
  std::mt19937 random(1);
  WheelNoise noise({}, {});
  DriveStraight(300.0, 0.0, kSure, random, noise);
  const double before = noise.scales().travel;
  noise.Observe({1.5, 0.0, DegToRad(60.0)}, {1.5, 0.0, 0.0}, kSure);
  EXPECT_LE(noise.scales().travel, before + 0.45);
}

TEST(WheelNoise, AWindowDoesNotReachOverARestart) {
  WheelNoise noise({}, {});
  noise.Observe({0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, kSure);
  noise.Observe({0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}, kNever);
  noise.Restart();
  noise.Observe({0.6, 0.0, 0.0}, {0.6, 0.0, 0.0}, kSure);
  EXPECT_DOUBLE_EQ(noise.scales().travel, 1.0) << "0.6 m are no window of 1 m";
}

}  // namespace
}  // namespace masked_mapper
