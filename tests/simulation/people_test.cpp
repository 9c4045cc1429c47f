// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people.hpp"

#include <gtest/gtest.h>

#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

TEST(People, WalkAlongTheWaysAndKeepFromTheRobot) {
  const Building building = CorridorsBuilding();
  const FloorPlan& floor = building.floors[0];
  PeopleOptions options;
  options.per_kilometre = 100.0;
  People people(building, options, 1);
  const Eigen::Vector2d robot(20.0, 8.0);
  std::vector<Leg> last;
  double moved = 0.0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<Leg> legs = people.LegsAt(0.2 * i, 0, robot);
    for (const Leg& leg : legs) {
      EXPECT_GT((leg.centre - robot).norm(), 0.3) << "m";
      double nearest = 10.0;
      for (const Passage& passage : floor.passages) {
        nearest =
            std::min(nearest, DistanceToSegment(leg.centre, floor.way_points[passage.from].position,
                                                floor.way_points[passage.to].position));
      }
      EXPECT_LT(nearest, 1.0) << "m";
    }
    if (legs.size() == last.size() && !legs.empty()) {
      moved += (legs[0].centre - last[0].centre).norm();
    }
    last = legs;
  }
  EXPECT_GT(moved, 10.0) << "m";
}

TEST(People, AnEmptyBuildingHasNone) {
  const Building building = CorridorsBuilding();
  PeopleOptions options;
  options.per_kilometre = 0.0;
  People people(building, options, 1);
  EXPECT_TRUE(people.LegsAt(0.0, 0, {0.0, 0.0}).empty());
}

}  // namespace
}  // namespace masked_mapper
