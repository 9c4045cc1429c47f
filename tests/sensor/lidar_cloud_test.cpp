// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/lidar_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

CloudPoint PointAt(float x, float y, float z, float time = 0.0F) {
  CloudPoint point;
  point.position = {x, y, z};
  point.time = time;
  return point;
}

TEST(LidarCloudTest, ATurningRobotSeesAStraightWallStraight) {
  // At 1 rad/s and 1 m/s a sweep of 0.1 s; the wall is x = 5.
  const auto motion = [](double t) { return Pose2{1.0 * t, 0.0, 1.0 * t}; };
  CloudPoints points;
  for (int i = 0; i <= 1000; ++i) {
    const double t = -0.1 + 1e-4 * i;
    const Pose2 T_now_then = motion(t);
    const Eigen::Vector2d then = Inverse(T_now_then) * Eigen::Vector2d(5.0, -3.0 + 0.006 * i);
    points.push_back(PointAt(static_cast<float>(then.x()), static_cast<float>(then.y()), 0.5F,
                             static_cast<float>(t)));
  }
  Straighten(motion, &points);
  for (const CloudPoint& point : points) ASSERT_NEAR(point.position.x(), 5.0, 0.01);
}

TEST(LidarCloudTest, WithoutTimesNothingMoves) {
  CloudPoints points = {PointAt(1.0F, 2.0F, 3.0F), PointAt(4.0F, 5.0F, 6.0F)};
  Straighten([](double) { return Pose2{9.0, 9.0, 1.0}; }, &points);
  EXPECT_EQ(points[1].position, Eigen::Vector3f(4.0F, 5.0F, 6.0F));
  CloudPoints none;
  Straighten([](double) { return Pose2{}; }, &none);
}

}  // namespace
}  // namespace masked_mapper
