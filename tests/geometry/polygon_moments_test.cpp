// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// A star-shaped polygon about `centre`, as an isovist is.
std::vector<Eigen::Vector2d> Star(std::mt19937& random, const Eigen::Vector2d& centre,
                                  int corners) {
  std::uniform_real_distribution<double> radius(0.5, 5.0);
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * i / corners;
    polygon.push_back(centre + radius(random) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

bool IsInside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[j];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

TEST(PolygonMoments, OfARectangle) {
  const auto moments = ComputePolygonMoments({{1.0, 2.0}, {5.0, 2.0}, {5.0, 4.0}, {1.0, 4.0}});
  ASSERT_TRUE(moments);
  EXPECT_NEAR(moments->area, 8.0, 1e-12);
  EXPECT_LT((moments->centroid - Eigen::Vector2d(3.0, 3.0)).norm(), 1e-12);
  // A uniform density of width w has variance w^2 / 12.
  EXPECT_NEAR(moments->covariance(0, 0), 16.0 / 12.0, 1e-12);
  EXPECT_NEAR(moments->covariance(1, 1), 4.0 / 12.0, 1e-12);
  EXPECT_NEAR(moments->covariance(0, 1), 0.0, 1e-12);
}

TEST(PolygonMoments, MatchSampling) {
  std::mt19937 random(7);
  for (int i = 0; i < 3; ++i) {
    const auto polygon = Star(random, {1.0, -2.0}, 24);
    std::uniform_real_distribution<double> x(-5.0, 7.0);
    std::uniform_real_distribution<double> y(-8.0, 4.0);
    constexpr int kSamples = 200000;
    int inside = 0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    for (int sample = 0; sample < kSamples; ++sample) {
      const double at_x = x(random);
      const Eigen::Vector2d point(at_x, y(random));
      if (!IsInside(polygon, point)) continue;
      ++inside;
      sum += point;
      squares += point * point.transpose();
    }
    const Eigen::Vector2d mean = sum / inside;
    const auto moments = ComputePolygonMoments(polygon);
    ASSERT_TRUE(moments);
    EXPECT_NEAR(moments->area, 144.0 * inside / kSamples, 0.5);
    EXPECT_LT((moments->centroid - mean).norm(), 0.05);
    const Eigen::Matrix2d covariance = squares / inside - mean * mean.transpose();
    EXPECT_LT((moments->covariance - covariance).norm(), 0.03 * covariance.norm());
  }
}

TEST(PolygonMoments, NeitherOrientationNorFirstCornerNorPlaceMatter) {
  std::mt19937 random(8);
  auto polygon = Star(random, {0.0, 0.0}, 12);
  const auto moments = ComputePolygonMoments(polygon);
  std::reverse(polygon.begin(), polygon.end());
  std::rotate(polygon.begin(), polygon.begin() + 5, polygon.end());
  const Eigen::Vector2d far(1e5, -1e5);
  for (auto& corner : polygon) corner += far;
  const auto moved = ComputePolygonMoments(polygon);
  ASSERT_TRUE(moments && moved);
  EXPECT_NEAR(moved->area, moments->area, 1e-6);
  EXPECT_LT((moved->centroid - far - moments->centroid).norm(), 1e-6);
  EXPECT_LT((moved->covariance - moments->covariance).norm(), 1e-6);
}

TEST(PolygonMoments, NothingWithoutArea) {
  EXPECT_FALSE(ComputePolygonMoments({}));
  EXPECT_FALSE(ComputePolygonMoments({{0.0, 0.0}, {1.0, 0.0}}));
  EXPECT_FALSE(ComputePolygonMoments({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}));
  EXPECT_FALSE(ComputePolygonMoments({{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}));
}

}  // namespace
}  // namespace masked_mapper
