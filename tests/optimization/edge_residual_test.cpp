// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/edge_residual.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Matrix3d RandomCovariance(std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 0.3);
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = normal(random);
  return root * root.transpose() + 0.01 * Eigen::Matrix3d::Identity();
}

Pose2 RandomPose(std::mt19937& random) {
  std::uniform_real_distribution<double> metres(-10.0, 10.0);
  std::uniform_real_distribution<double> radians(-kPi, kPi);
  return {metres(random), metres(random), radians(random)};
}

TEST(EdgeResidual, Chi2IsTheQuadraticFormOfTheErrorInFrameFrom) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Pose2 from = RandomPose(random);
    const Pose2 to = RandomPose(random);
    const UncertainPose2 measured{RandomPose(random), RandomCovariance(random)};
    const Pose2 actual = Between(from, to);
    Eigen::Vector3d error = actual.AsVector() - measured.mean.AsVector();
    error.z() = WrapAngle(error.z());
    const double expected = error.dot(measured.covariance.inverse() * error);
    EXPECT_NEAR(EdgeResidual(measured).Chi2(from, to), expected, 1e-8 * (1.0 + expected));
  }
}

TEST(EdgeResidual, JacobiansAgreeWithFiniteDifferences) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const EdgeResidual edge({RandomPose(random), RandomCovariance(random)});
    double ends[2][3];
    for (auto& end : ends) {
      const Pose2 pose = RandomPose(random);
      end[0] = pose.x;
      end[1] = pose.y;
      end[2] = pose.theta;
    }
    Eigen::Vector3d residual;
    RowMajor jacobians[2];
    edge.Evaluate(ends[0], ends[1], residual.data(), jacobians[0].data(), jacobians[1].data());
    constexpr double kStep = 1e-6;
    for (int end = 0; end < 2; ++end) {
      for (int column = 0; column < 3; ++column) {
        Eigen::Vector3d ahead;
        Eigen::Vector3d behind;
        const double at = ends[end][column];
        ends[end][column] = at + kStep;
        edge.Evaluate(ends[0], ends[1], ahead.data(), nullptr, nullptr);
        ends[end][column] = at - kStep;
        edge.Evaluate(ends[0], ends[1], behind.data(), nullptr, nullptr);
        ends[end][column] = at;
        const Eigen::Vector3d numeric = (ahead - behind) / (2.0 * kStep);
        EXPECT_LT((numeric - jacobians[end].col(column)).norm(), 1e-5 * (1.0 + numeric.norm()));
      }
    }
  }
}

TEST(EdgeResidual, TheAngleIsTakenTheShorterWay) {
  const EdgeResidual edge({{0.0, 0.0, 3.1}, Eigen::Matrix3d::Identity()});
  EXPECT_NEAR(std::sqrt(edge.Chi2({}, {0.0, 0.0, -3.1})), 2.0 * (kPi - 3.1), 1e-12) << "rad";
}

TEST(EdgeResidual, SingularAndTinyCovariancesActAsRigid) {
  for (const double sigma : {0.0, 1e-12, 1e-6}) {
    const EdgeResidual edge({{1.0, 0.0, 0.0}, sigma * sigma * Eigen::Matrix3d::Identity()});
    EXPECT_NEAR(edge.Chi2({}, {1.0, 0.0, 0.0}), 0.0, 1e-12);
    EXPECT_NEAR(edge.Chi2({}, {1.001, 0.0, 0.0}), 1e4, 1.0);  // 1 mm at a floor of 0.01 mm
  }
  // Singular in one direction alone: the others keep their own uncertainty.
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.0, 0.01).asDiagonal();
  const EdgeResidual ridge({{}, covariance});
  EXPECT_NEAR(ridge.Chi2({}, {0.2, 0.0, 0.0}), 1.0, 1e-6);
  EXPECT_GT(ridge.Chi2({}, {0.0, 0.2, 0.0}), 1e6);
}

// Where the largest variance drowns the smallest, every covariance that is one can be divided by.
TEST(EdgeResidual, VariancesMayBeFarApart) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (const double largest : {1e2, 1e6, 1e9, 1e11}) {
    const Eigen::Vector3d variances(largest, 0.5 * largest, 0.0);
    const EdgeResidual edge({{}, turn * variances.asDiagonal() * turn.transpose()});
    const Eigen::Vector3d along = 1e-3 * std::sqrt(largest) * turn.col(0);
    EXPECT_LT(edge.Chi2({}, {along.x(), along.y(), 0.0}), 1e30) << largest;
  }
}

TEST(EdgeResidualDeathTest, WhatIsNoCovarianceStops) {
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity();
  bad(1, 1) = -1.0;
  EXPECT_DEATH(EdgeResidual({{}, bad}), "");
  bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DEATH(EdgeResidual({{}, bad}), "");
}

}  // namespace
}  // namespace masked_mapper
