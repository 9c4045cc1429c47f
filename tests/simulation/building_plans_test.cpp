// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/building_plans.hpp"

#include <gtest/gtest.h>

#include "simulation/robot_drive.hpp"

namespace masked_mapper {
namespace {

TEST(BuildingPlans, EveryNamedBuildingCanBeDriven) {
  for (const std::string& name : BuildingNames()) {
    const auto building = NamedBuilding(name, 1);
    ASSERT_TRUE(building) << name;
    EXPECT_EQ(building->name, name);
    EXPECT_NO_THROW(CheckBuilding(*building, DriveOptions().robot_radius + 0.1)) << name;
  }
  EXPECT_FALSE(NamedBuilding("castle", 1));
}

TEST(BuildingPlans, CampusHasThePapersSize) {
  const Building campus = CampusBuilding();
  ASSERT_EQ(campus.floors.size(), 4U);
  double area = 0.0;
  double corridors = 0.0;
  for (const FloorPlan& floor : campus.floors) {
    area += BoundsOf(floor).Area();
    corridors += CorridorLength(floor);
  }
  EXPECT_NEAR(area, 34'000.0, 1'000.0) << "m^2";
  EXPECT_NEAR(corridors, 1'700.0, 200.0) << "m";
  const Bounds third = BoundsOf(campus.floors[2]);
  EXPECT_NEAR(third.high.x() - third.low.x(), 264.0, 1.0) << "m";
  EXPECT_NEAR(third.high.y() - third.low.y(), 82.0, 1.0) << "m";
}

TEST(BuildingPlans, TowersFloorsAreTheSame) {
  const Building tower = TowerBuilding();
  ASSERT_EQ(tower.floors.size(), 10U);
  for (const FloorPlan& floor : tower.floors) {
    ASSERT_EQ(floor.segments.size(), tower.floors[0].segments.size());
    for (std::size_t i = 0; i < floor.segments.size(); ++i) {
      EXPECT_EQ(floor.segments[i].a, tower.floors[0].segments[i].a);
      EXPECT_EQ(floor.segments[i].b, tower.floors[0].segments[i].b);
    }
  }
}

TEST(BuildingPlans, CorridorsAreBlank) {
  for (const FloorPlan& floor : CorridorsBuilding().floors) {
    for (const Segment& segment : floor.segments) EXPECT_EQ(segment.surface, Surface::kWall);
  }
}

}  // namespace
}  // namespace masked_mapper
