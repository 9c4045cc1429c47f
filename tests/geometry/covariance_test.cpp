// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/uncertain_pose2.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace masked_mapper {
namespace {

TEST(Covariance, WhatIsComposedIsOne) {
  UncertainPose2 step{{1.0, 0.1, 0.05}, Eigen::Matrix3d::Zero()};
  step.covariance.diagonal() << 1e-4, 1e-6, 1e-5;
  UncertainPose2 way;
  EXPECT_TRUE(IsCovariance(way.covariance)) << "known exactly";
  for (int i = 0; i < 1000; ++i) {
    way = way * step;
    EXPECT_TRUE(IsCovariance(way.covariance)) << i;
    EXPECT_TRUE(IsCovariance(Inverse(way).covariance)) << i;
  }
}

TEST(Covariance, RoundingIsForgiven) {
  Eigen::Matrix3d matrix = Eigen::Vector3d(4.0, 1.0, 0.0).asDiagonal();
  matrix(2, 2) = -1e-12;
  matrix(0, 1) = 1e-12;
  EXPECT_TRUE(IsCovariance(matrix));
}

TEST(Covariance, WhatIsNone) {
  const Eigen::Matrix3d good = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d matrix = good;
  matrix(1, 1) = -0.01;
  EXPECT_FALSE(IsCovariance(matrix)) << "a variance below zero";
  matrix = good;
  matrix(0, 1) = matrix(1, 0) = 2.0;
  EXPECT_FALSE(IsCovariance(matrix)) << "more than wholly correlated";
  matrix = good;
  matrix(0, 1) = 0.1;
  EXPECT_FALSE(IsCovariance(matrix)) << "not symmetric";
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    matrix = good;
    matrix(2, 2) = value;
    EXPECT_FALSE(IsCovariance(matrix)) << value;
  }
}

}  // namespace
}  // namespace masked_mapper
