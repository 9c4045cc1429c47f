// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/local_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>

#include "masked_mapper/geometry/pose2.hpp"
#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

/// The line through the neighbours of one point, one neighbour after the other.
Eigen::Vector2f NormalOf(const ScanPoints& points, std::size_t i) {
  const auto at = [&](std::size_t j) { return Eigen::Vector2f(points[j].x, points[j].y); };
  const float reach = 0.15F + 0.04F * at(i).norm();
  const auto is_near = [&](std::size_t j) {
    return (at(j) - at(i)).squaredNorm() <= reach * reach;
  };
  std::size_t first = i;
  std::size_t last = i;
  while (first > 0 && i - first < 8 && is_near(first - 1)) --first;
  while (last + 1 < points.size() && last - i < 8 && is_near(last + 1)) ++last;
  const Eigen::Vector2f along = at(last) - at(first);
  if (along.norm() <= 0.04F) return -at(i);
  const Eigen::Vector2f normal(-along.y(), along.x());
  return normal.dot(at(i)) > 0.0F ? Eigen::Vector2f(-normal) : normal;
}

pcl::PointXY Point(float x, float y) {
  pcl::PointXY point;
  point.x = x;
  point.y = y;
  return point;
}

TEST(FacedPoints, FaceAsTheLineThroughTheirNeighboursDoes) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(3);
  for (int i = 0; i < 5; ++i) {
    const ScanPoints::ConstPtr points =
        PointsInRobot(room.Scan({2.0 + 0.4 * i, 2.5, 0.7 * i}, 361, 270.0, &random));
    const FacedPoints faced(*points);
    ASSERT_EQ(faced.size(), points->size());
    for (std::size_t j = 0; j < faced.size(); ++j) {
      const Eigen::Vector2f normal = NormalOf(*points, j);
      EXPECT_EQ(faced.x[j], (*points)[j].x);
      EXPECT_EQ(faced.y[j], (*points)[j].y);
      EXPECT_EQ(faced.normal_x[j], normal.x()) << "point " << j;
      EXPECT_EQ(faced.normal_y[j], normal.y()) << "point " << j;
    }
  }
}

TEST(FacedPoints, NoneAndOneAndTwo) {
  EXPECT_TRUE(FacedPoints(ScanPoints()).empty());
  ScanPoints points;
  points.push_back(Point(2.0F, 1.0F));
  const FacedPoints one(points);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one.normal_x[0], -2.0F);
  EXPECT_EQ(one.normal_y[0], -1.0F);
  points.push_back(Point(2.0F, 1.1F));
  const FacedPoints two(points);
  ASSERT_EQ(two.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(two.normal_x[i], -0.1F, 1e-6F);
    EXPECT_EQ(two.normal_y[i], 0.0F);
  }
}

TEST(FacedPoints, TheFrontLiesBetweenTheWalls) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(3);
  for (const double theta : {0.0, 0.3, -1.2, 2.5}) {
    const FacedPoints points(*PointsInRobot(room.Scan({3.0, 2.5, theta}, 361, 270.0, &random)));
    const double from_wall = std::remainder(FrontOf(points, theta), 0.5 * kPi);
    EXPECT_NEAR(std::abs(from_wall), 0.25 * kPi, DegToRad(5.0)) << "rad, heading " << theta;
  }
}

}  // namespace
}  // namespace masked_mapper
