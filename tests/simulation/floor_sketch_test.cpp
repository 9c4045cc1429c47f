// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/floor_sketch.hpp"

#include <gtest/gtest.h>

#include "simulation/random_generator.hpp"
#include "simulation/segment_index.hpp"

namespace masked_mapper {
namespace {

double Length(const std::vector<Segment>& segments) {
  double length = 0.0;
  for (const Segment& segment : segments) length += (segment.b - segment.a).norm();
  return length;
}

TEST(FloorSketch, OneRoomIsItsFourWalls) {
  const auto walls = Walls({ConvexSpace::Rectangle({}, 0.0, 0.0, 4.0, 3.0)});
  EXPECT_EQ(walls.size(), 4U);
  EXPECT_NEAR(Length(walls), 14.0, 1e-9);
}

TEST(FloorSketch, ADoorJoinsTwoRooms) {
  const auto walls = Walls({ConvexSpace::Rectangle({}, 0.0, 0.0, 4.0, 3.0),
                            ConvexSpace::Rectangle({}, 4.2, 0.0, 8.0, 3.0),
                            ConvexSpace::Rectangle({}, 3.9, 1.0, 4.3, 2.0)});
  // Both perimeters, less a metre of each for the door, and its two jambs of 0.2 m.
  EXPECT_NEAR(Length(walls), 14.0 + 13.6 - 2.0 + 0.4, 1e-4);
  const SegmentIndex index(walls);
  EXPECT_NEAR(index.Cast({2.0, 1.5}, {1.0, 0.0}, 0.0, 30.0)->range, 6.0, 1e-9);
  EXPECT_NEAR(index.Cast({2.0, 0.5}, {1.0, 0.0}, 0.0, 30.0)->range, 2.0, 1e-9);
}

TEST(FloorSketch, TouchingRoomsStayDivided) {
  const SegmentIndex index(Walls({ConvexSpace::Rectangle({}, 0.0, 0.0, 4.0, 3.0),
                                  ConvexSpace::Rectangle({}, 4.0, 0.0, 8.0, 3.0)}));
  EXPECT_NEAR(index.Cast({2.0, 1.5}, {1.0, 0.0}, 0.0, 30.0)->range, 2.0, 1e-9);
}

TEST(FloorSketch, NoWallInsideAndNoGapAround) {
  // A way from a free point to any other point crosses a wall exactly when it leaves the union.
  RandomGenerator random(8);
  const auto inside = [](const std::vector<ConvexSpace>& spaces, const Eigen::Vector2d& point) {
    for (const ConvexSpace& space : spaces) {
      bool in = true;
      for (std::size_t e = 0; e < space.corners.size() && in; ++e) {
        const Eigen::Vector2d edge =
            space.corners[(e + 1) % space.corners.size()] - space.corners[e];
        const Eigen::Vector2d to = point - space.corners[e];
        in = edge.x() * to.y() - edge.y() * to.x() > 0.0;
      }
      if (in) return true;
    }
    return false;
  };
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<ConvexSpace> spaces;
    for (int i = 0; i < 8; ++i) {
      Pose2 pose;
      pose.x = random.Uniform(-5.0, 5.0);
      pose.y = random.Uniform(-5.0, 5.0);
      pose.theta = random.Uniform(-kPi, kPi);
      const double length = random.Uniform(1.0, 4.0);
      const double width = random.Uniform(0.5, 2.0);
      spaces.push_back(ConvexSpace::Rectangle(pose, -length, -width, length, width));
    }
    const SegmentIndex index(Walls(spaces));
    for (int ray = 0; ray < 50; ++ray) {
      const double x = random.Uniform(-6.0, 6.0);
      const double y = random.Uniform(-6.0, 6.0);
      const Eigen::Vector2d origin(x, y);
      if (!inside(spaces, origin)) continue;
      const double angle = random.Uniform(-kPi, kPi);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      double leaves = 0.0;
      while (inside(spaces, origin + leaves * direction)) leaves += 1e-3;
      const auto hit = index.Cast(origin, direction, 0.0, 40.0);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->range, leaves, 2e-3) << "m";
    }
  }
}

TEST(FloorSketch, OverlapMindsTheGap) {
  const ConvexSpace a = ConvexSpace::Rectangle({}, 0.0, 0.0, 2.0, 2.0);
  const ConvexSpace b = ConvexSpace::Rectangle({}, 2.1, 0.0, 4.0, 2.0);
  EXPECT_FALSE(Overlap(a, b, 0.0));
  EXPECT_FALSE(Overlap(a, b, 0.09));
  EXPECT_TRUE(Overlap(a, b, 0.11));
  EXPECT_TRUE(Overlap(a, ConvexSpace::Rectangle({1.0, 1.0, 0.3}, -9.0, -0.1, 9.0, 0.1), 0.0));
}

}  // namespace
}  // namespace masked_mapper
