// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/space_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "simulation/building_file.hpp"
#include "simulation/space_lidar.hpp"

namespace masked_mapper {
namespace {

TEST(SpaceSurfacesTest, FurnitureEndsBelowTheCeilingAndLintelsHangFromIt) {
  const Building office = LoadBuilding("office", 1);
  std::size_t low = 0;
  std::size_t lintels = 0;
  for (std::size_t floor = 0; floor < office.floors.size(); ++floor) {
    const SpaceSurfaces surfaces = SurfacesOf(office, floor);
    for (const Upright& upright : surfaces.standing) {
      low += upright.high < surfaces.ceiling ? 1 : 0;
      lintels += upright.low > 1.0 && upright.high == surfaces.ceiling ? 1 : 0;
      EXPECT_LT(upright.low, upright.high);
    }
    EXPECT_FALSE(surfaces.overhead.empty());
  }
  EXPECT_GT(low, 0U);
  EXPECT_GT(lintels, 0U);
}

TEST(SpaceSurfacesTest, WhatIsOverheadIsReadAndWritten) {
  std::istringstream text(
      "floor 0 0\nwall -5 -5 5 -5\noverhead 1 2 30 1.5 0.8 0.7 0.74\npoint a 0 0\npoint b 1 0\n"
      "corridor a b\n");
  const Building building = ReadBuilding(text, "room");
  ASSERT_EQ(building.floors[0].overhead.size(), 1U);
  EXPECT_DOUBLE_EQ(building.floors[0].overhead[0].low, 0.7);
  std::istringstream again(WriteBuilding(building));
  EXPECT_EQ(WriteBuilding(ReadBuilding(again, "again")), WriteBuilding(building));
}

TEST(SpaceSurfacesTest, DistancesAreThoseOfTheNearestSurface) {
  Building building;
  FloorPlan floor;
  floor.segments = {{{0.0, 0.0}, {4.0, 0.0}, Surface::kWall},
                    {{4.0, 0.0}, {4.0, 4.0}, Surface::kWall}};
  floor.overhead = {{{2.0, 2.0, 0.5 * 3.14159265358979}, 1.0, 0.6, 0.7, 0.74}};
  building.floors = {floor};
  const TrueSurfaces surfaces(building, 0, 0.5);
  EXPECT_NEAR(surfaces.Distance({2.0, 0.1, 1.0}), 0.1, 1e-9);
  EXPECT_NEAR(surfaces.Distance({-0.3, -0.4, 1.0}), 0.5, 1e-9);
  EXPECT_NEAR(surfaces.Distance({1.0, 1.0, -0.2}), 0.2, 1e-9);
  EXPECT_NEAR(surfaces.Distance({1.0, 1.0, 2.65}), 0.05, 1e-9);
  EXPECT_NEAR(surfaces.Distance({2.0, 2.4, 0.6}), 0.1, 1e-9);   // below the top
  EXPECT_NEAR(surfaces.Distance({2.4, 2.0, 0.72}), 0.1, 1e-6);  // beside it
  EXPECT_NEAR(surfaces.Distance({1.0, 1.0, 1.3}), 0.5, 1e-9);   // the limit
}

/// What a lidar without noise measures lies on them.
TEST(SpaceSurfacesTest, AreWhatALidarSees) {
  const Building office = LoadBuilding("office", 1);
  SpaceLidar lidar(office, OptionsOf(SpaceLidarModel::kVlp16), LidarNoise::None(), 1);
  const TrueSurfaces surfaces(office, 0, 0.5);
  RobotState state;
  const WayPoint& at = office.floors[0].way_points.front();
  state.T_building_robot = {at.position.x(), at.position.y(), 0.3};
  const CloudReading cloud = lidar.Sweep(1.0, [&](double /*time*/) { return state; });
  EXPECT_GT(cloud.points.size(), 10000U);
  for (const CloudPoint& point : cloud.points) {
    const Eigen::Vector3d in_robot = cloud.T_robot_lidar * point.position.cast<double>();
    const Eigen::Vector2d below = state.T_building_robot * Eigen::Vector2d(in_robot.head<2>());
    ASSERT_LT(surfaces.Distance({below.x(), below.y(), in_robot.z()}), 1e-3);
  }
}

}  // namespace
}  // namespace masked_mapper
