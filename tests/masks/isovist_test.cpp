// SPDX-License-Identifier: BSD-3-Clause
#include "masks/isovist.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "masked_mapper/geometry/polygon.hpp"
#include "masks/hand_drawn.hpp"

namespace masked_mapper {
namespace {

const Scene kRoom{{{-3.0, -2.0}, {3.0, -2.0}, {3.0, 2.0}, {-3.0, 2.0}, {-3.0, -2.0}}};

double Area(const std::vector<Eigen::Vector2d>& corners) {
  const auto moments = ComputePolygonMoments(corners);
  return moments ? moments->area : 0.0;
}

TEST(Isovist, FullCircleIsTheRoom) {
  const auto corners = Isovist(Look(kRoom, {1.0, 0.5, 0.7}, FullCircle()), {});
  EXPECT_EQ(corners.size(), 720U);
  EXPECT_NEAR(Area(corners), 24.0, 0.1);
}

TEST(Isovist, HalfCircleClosesAtTheLaser) {
  const Pose2 T_robot_laser{0.4, 0.1, 0.0};
  const auto corners = Isovist(Look(kRoom, {}, HalfCircle(), T_robot_laser), {});
  EXPECT_EQ(corners.size(), 362U);
  EXPECT_NEAR((corners.back() - T_robot_laser.Translation()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(Area(corners), 2.6 * 4.0, 0.05);
}

TEST(Isovist, CornersAreInTheRobotFrame) {
  const Pose2 T_robot_laser{0.4, 0.1, 0.6};
  const Pose2 T_world_robot{-0.5, 0.3, 1.0};
  for (const Eigen::Vector2d& corner :
       Isovist(Look(kRoom, T_world_robot, FullCircle(), T_robot_laser), {})) {
    const Eigen::Vector2d in_world = T_world_robot * corner;
    const double to_wall = std::min(3.0 - std::abs(in_world.x()), 2.0 - std::abs(in_world.y()));
    EXPECT_NEAR(to_wall, 0.0, 1e-4);
  }
}

TEST(Isovist, FarBeamsAndNoReturnsEndAtTheLimit) {
  LaserScan scan = Look({}, {}, FullCircle());
  scan.ranges[5] = 25.0F;
  IsovistOptions options;
  options.max_range_m = 7.0;
  for (const Eigen::Vector2d& corner : Isovist(scan, options))
    EXPECT_NEAR(corner.norm(), 7.0, 1e-9);
  scan.max_range = 4.0F;
  scan.ranges[5] = kNoReturn;
  for (const Eigen::Vector2d& corner : Isovist(scan, options))
    EXPECT_NEAR(corner.norm(), 4.0, 1e-6);
}

TEST(Isovist, InvalidBeamsAreNotThere) {
  LaserScan scan = Look(kRoom, {}, FullCircle());
  for (std::size_t beam = 0; beam < scan.size(); beam += 2) scan.ranges[beam] = kInvalidRange;
  const auto corners = Isovist(scan, {});
  EXPECT_EQ(corners.size(), 360U);
  EXPECT_NEAR(Area(corners), 24.0, 0.2);
  std::fill(scan.ranges.begin(), scan.ranges.end(), kInvalidRange);
  EXPECT_TRUE(Isovist(scan, {}).empty());
  EXPECT_TRUE(Isovist(LaserScan{}, {}).empty());
}

}  // namespace
}  // namespace masked_mapper
