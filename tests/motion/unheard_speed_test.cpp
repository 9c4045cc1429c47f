// SPDX-License-Identifier: BSD-3-Clause
#include "motion/unheard_speed.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

namespace masked_mapper {
namespace {

constexpr double kStep = 0.2;  // s
const UnheardSpeed::Guess kGuess{0.04 * 0.04, 0.08};

Eigen::Matrix2d Along(double information_along, double information_across) {
  return Eigen::Vector2d(information_along, information_across).asDiagonal();
}

struct Seen {
  UncertainPose2 T_last_now;
  Eigen::Matrix2d information;
};

// A corridor, a bend in it, and a room behind.
std::vector<Seen> CorridorAndRoom() {
  std::vector<Seen> steps;
  for (int i = 0; i < 40; ++i) {
    const double along = i < 25 ? 0.0 : 4000.0;
    steps.push_back(
        {{{0.12, 0.0, i >= 10 && i < 20 ? 0.1 : 0.0}, Eigen::Matrix3d::Zero()}, Along(along, 1e5)});
  }
  return steps;
}

Eigen::Matrix2d CovarianceOfWay(const std::vector<Seen>& steps) {
  UnheardSpeed speed;
  speed.Hear({{0.12, 0.0, 0.0}, Eigen::Matrix3d::Zero()}, kStep);
  UncertainPose2 T_start_robot;
  for (const Seen& step : steps) {
    UncertainPose2 T_last_now = step.T_last_now;
    T_last_now.covariance = speed.Observe(T_last_now, kGuess, step.information, kStep);
    T_start_robot = T_start_robot * T_last_now;
  }
  return T_start_robot.covariance.topLeftCorner<2, 2>();
}

// Errors are drawn one step after the other, and a scan takes of each what it sees of it.
Eigen::Matrix2d SampledCovarianceOfWay(const std::vector<Seen>& steps, int samples) {
  std::mt19937 random(3);
  std::normal_distribution<double> unit;
  const auto draw = [&](const Eigen::Matrix2d& covariance) {
    const Eigen::Matrix2d root = covariance.llt().matrixL();
    return Eigen::Vector2d(root * Eigen::Vector2d(unit(random), unit(random)));
  };
  const double lasts = std::sqrt(1.0 - kGuess.variance / (kGuess.most_sigma * kGuess.most_sigma));
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int sample = 0; sample < samples; ++sample) {
    Eigen::Vector2d way = Eigen::Vector2d::Zero();    // in start
    Eigen::Vector2d error = Eigen::Vector2d::Zero();  // of the step, in last
    Eigen::Matrix2d known = Eigen::Matrix2d::Zero();
    double heading = 0.0;
    double turned = 0.0;
    for (const Seen& step : steps) {
      const Eigen::Matrix2d back = Eigen::Rotation2Dd(-turned).toRotationMatrix() * lasts;
      error =
          back * error + std::sqrt(kGuess.variance) * Eigen::Vector2d(unit(random), unit(random));
      known = back * known * back.transpose() + kGuess.variance * Eigen::Matrix2d::Identity();
      const Eigen::Matrix2d after = (known.inverse() + step.information).inverse();
      // A measurement of the information's noise, weighed as a Kalman filter does.
      const Eigen::Vector2d measured =
          step.information * error + draw(step.information + 1e-9 * Eigen::Matrix2d::Identity());
      error -= after * measured;
      known = after;
      way += Eigen::Rotation2Dd(heading) * error;
      turned = step.T_last_now.mean.theta;
      heading += turned;
    }
    sum += way * way.transpose();
  }
  return sum / samples;
}

TEST(UnheardSpeedTest, StepsAddUpToTheWayThatSamplingFinds) {
  const std::vector<Seen> steps = CorridorAndRoom();
  const Eigen::Matrix2d told = CovarianceOfWay(steps);
  const Eigen::Matrix2d sampled = SampledCovarianceOfWay(steps, 20000);
  EXPECT_LT((told - sampled).norm(), 0.05 * sampled.norm()) << told << "\n\n" << sampled << " m^2";
  EXPECT_GT(std::sqrt(sampled.trace()), 0.3) << "m: the corridor leaves the way open";
}

TEST(UnheardSpeedTest, ErrorsOfABlankStretchLastAndAddUp) {
  const auto sigma_after = [](int count) {
    return std::sqrt(CovarianceOfWay(
        std::vector<Seen>(static_cast<std::size_t>(count),
                          {{{0.12, 0.0, 0.0}, Eigen::Matrix3d::Zero()}, Along(0.0, 1e5)}))(0, 0));
  };
  const double independent = std::sqrt(kGuess.variance);
  EXPECT_NEAR(sigma_after(1), independent, 1e-9) << "m";
  EXPECT_GT(sigma_after(50), 2.0 * independent * std::sqrt(50.0)) << "m";
  // In the long run as a walk whose steps last: sigma * sqrt((1 + l) / (1 - l)) per root of a step.
  const double lasts = std::sqrt(0.75);
  EXPECT_NEAR(sigma_after(4000) / std::sqrt(4000.0),
              kGuess.most_sigma * std::sqrt((1.0 + lasts) / (1.0 - lasts)), 0.01)
      << "m";
}

TEST(UnheardSpeedTest, WhatScansSeeIsAsGoodAsScans) {
  UnheardSpeed speed;
  const UncertainPose2 step{{0.12, 0.0, 0.02}, Eigen::Vector3d(0.1, 0.1, 1e-6).asDiagonal()};
  Eigen::Matrix3d covariance;
  for (int i = 0; i < 10; ++i) covariance = speed.Observe(step, kGuess, Along(1e6, 1e6), kStep);
  EXPECT_NEAR(covariance(0, 0), 1e-6, 2e-8) << "m^2";
  EXPECT_NEAR(covariance(2, 2), 1e-6, 1e-12) << "rad^2, as it was";
}

TEST(UnheardSpeedTest, AWayThatStartsAnewOwesNothingToTheOneBefore) {
  const UncertainPose2 step{{0.12, 0.0, 0.0}, Eigen::Matrix3d::Zero()};
  UnheardSpeed speed;
  for (int i = 0; i < 50; ++i) speed.Observe(step, kGuess, Eigen::Matrix2d::Zero(), kStep);
  UnheardSpeed anew = speed;
  anew.StartWay();
  const double goes_on = speed.Observe(step, kGuess, Eigen::Matrix2d::Zero(), kStep)(0, 0);
  const double starts = anew.Observe(step, kGuess, Eigen::Matrix2d::Zero(), kStep)(0, 0);
  EXPECT_NEAR(starts, kGuess.most_sigma * kGuess.most_sigma, 1e-5) << "m^2: of the step alone";
  EXPECT_GT(goes_on, 3.0 * starts) << "m^2";
}

TEST(UnheardSpeedTest, DegenerateInputsStayFinite) {
  UnheardSpeed speed;
  const UncertainPose2 rest;
  for (const double elapsed : {1e-9, 0.2, 1e6}) {
    const Eigen::Matrix3d covariance =
        speed.Observe(rest, {0.0, 0.0}, -Eigen::Matrix2d::Identity(), elapsed);
    EXPECT_TRUE(covariance.allFinite());
    EXPECT_TRUE(IsCovariance(covariance));
  }
}

}  // namespace
}  // namespace masked_mapper
