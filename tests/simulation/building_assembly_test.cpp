// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/building_assembly.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(BuildingAssembly, FloorsBringTheirLandings) {
  Building building;
  building.elevators.resize(1);
  building.stairs.resize(1);
  FloorPlanner::Planned planned;
  planned.floor.way_points = {{"a", {0.0, 0.0}}, {"b", {5.0, 1.0}}};
  planned.elevator_way_points = {{0, 1}};
  planned.stairs_way_points = {{0, 0}};
  AddFloor(building, planned);
  AddFloor(building, planned);
  ASSERT_EQ(building.elevators[0].landings.size(), 2U);
  EXPECT_EQ(building.elevators[0].landings[1].floor, 1U);
  EXPECT_EQ(building.elevators[0].landings[1].way_point, 1U);
  EXPECT_EQ(building.stairs[0].lower.floor, 0U);
  EXPECT_EQ(building.stairs[0].upper.floor, 1U);
  EXPECT_EQ(NearestWayPoint(building.floors[0], {4.0, 0.0}), 1U);
}

TEST(BuildingAssembly, AStairwellTurnsOnItsLanding) {
  StairwellPlan plan;
  plan.T_building_mouth = {10.0, 5.0, 0.5 * kPi};
  const std::vector<Eigen::Vector2d> way = StairwellWay(plan);
  ASSERT_EQ(way.size(), 2U);
  EXPECT_NEAR(way[0].y(), 5.0 + plan.flight_length + 0.5 * plan.landing_depth, 1e-9) << "m";
  EXPECT_NEAR(way[0].x() - way[1].x(), plan.flight_width + 0.2, 1e-9) << "m";
}

}  // namespace
}  // namespace masked_mapper
