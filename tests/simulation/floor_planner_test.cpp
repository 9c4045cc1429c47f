// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/floor_planner.hpp"

#include <gtest/gtest.h>

#include "simulation/segment_index.hpp"

namespace masked_mapper {
namespace {

FloorPlanner Ring(std::uint64_t seed) {
  FloorPlanner planner(seed);
  planner.SetVisitedRooms(3);
  planner.AddCorridor({0.0, 0.0}, {30.0, 0.0}, {});
  planner.AddCorridor({30.0, 0.0}, {30.0, 20.0}, {});
  planner.AddCorridor({30.0, 20.0}, {0.0, 20.0}, {});
  planner.AddCorridor({0.0, 20.0}, {0.0, 0.0}, {});
  planner.AddCorridor({30.0, 10.0}, {42.0, 14.0}, {});
  return planner;
}

TEST(FloorPlanner, JoinsCorridorsWhereTheyMeet) {
  FloorPlanner planner(1);
  CorridorStyle blank;
  blank.left.rooms = blank.right.rooms = false;
  blank.clutter = 0.0;
  planner.AddCorridor({0.0, 0.0}, {20.0, 0.0}, blank);
  planner.AddCorridor({10.0, -5.0}, {10.0, 5.0}, blank);
  const FloorPlan floor = planner.Plan("0", 0.0).floor;
  EXPECT_EQ(floor.way_points.size(), 5U);  // a crossing and four dead ends
  EXPECT_EQ(floor.passages.size(), 4U);
  const SegmentIndex index(floor.segments);
  EXPECT_NEAR(index.Cast({1.0, 0.0}, {1.0, 0.0}, 0.0, 60.0)->range, 19.0, 1e-9) << "m";
  EXPECT_NEAR(index.Cast({10.0, 0.0}, {0.0, 1.0}, 0.0, 60.0)->range, 5.0, 1e-9) << "m";
}

TEST(FloorPlanner, EveryWayIsFree) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const FloorPlan floor = Ring(seed).Plan("0", 0.0).floor;
    const SegmentIndex index(floor.segments);
    for (const Passage& passage : floor.passages) {
      EXPECT_GE(index.Clearance(floor.way_points[passage.from].position,
                                floor.way_points[passage.to].position, 1.0),
                0.4)
          << "m, seed " << seed;
    }
  }
}

TEST(FloorPlanner, WallsCloseAroundTheWays) {
  // From the corridors nothing is seen that is farther than the plan is wide: no leak.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    FloorPlanner planner = Ring(seed);
    const FloorPlan floor = planner.Plan("0", 0.0).floor;
    const SegmentIndex index(floor.segments);
    for (const WayPoint& way_point : floor.way_points) {
      for (int beam = 0; beam < 720; ++beam) {
        const double angle = DegToRad(0.5 * beam + 0.013);
        EXPECT_TRUE(index.Cast(way_point.position, {std::cos(angle), std::sin(angle)}, 0.0, 80.0))
            << "seed " << seed << " " << way_point.name << " " << RadToDeg(angle) << " deg";
      }
    }
  }
}

TEST(FloorPlanner, SameSeedSameFloor) {
  const FloorPlan a = Ring(4).Plan("0", 0.0).floor;
  const FloorPlan b = Ring(4).Plan("0", 0.0).floor;
  const FloorPlan c = Ring(5).Plan("0", 0.0).floor;
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) EXPECT_EQ(a.segments[i].a, b.segments[i].a);
  EXPECT_NE(a.segments.size(), c.segments.size());
}

}  // namespace
}  // namespace masked_mapper
