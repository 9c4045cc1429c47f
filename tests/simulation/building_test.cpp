// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/building.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/building_plans.hpp"
#include "simulation/segment_index.hpp"

namespace masked_mapper {
namespace {

/// One corridor between two walls 2 m apart.
Building OneCorridor() {
  Building building;
  building.name = "small";
  FloorPlan floor;
  floor.label = "0";
  floor.segments = {{{-1.0, -1.0}, {11.0, -1.0}, Surface::kWall},
                    {{-1.0, 1.0}, {11.0, 1.0}, Surface::kWall}};
  floor.way_points = {{"a", {0.0, 0.0}}, {"b", {10.0, 0.0}}};
  floor.passages = {{0, 1, true}};
  building.floors.push_back(floor);
  return building;
}

std::string Complaint(const Building& building) {
  try {
    CheckBuilding(building, 0.4);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Building, OneCorridorIsEnough) { EXPECT_EQ(Complaint(OneCorridor()), ""); }

TEST(Building, SaysWhatIsWrong) {
  Building building = OneCorridor();
  building.floors[0].segments.push_back({{5.0, 0.3}, {5.0, 1.0}, Surface::kFurniture});
  EXPECT_EQ(
      Complaint(building),
      "building 'small': floor 0: the way from a to b passes 0.30 m from a wall or furniture; "
      "the robot needs 0.40 m");

  building = OneCorridor();
  building.floors[0].way_points.push_back({"c", {20.0, 0.0}});
  building.floors[0].way_points.push_back({"d", {30.0, 0.0}});
  building.floors[0].passages.push_back({2, 3, true});
  EXPECT_EQ(Complaint(building),
            "building 'small': floor 0: way-point c cannot be reached from the start");

  building = OneCorridor();
  building.floors.push_back(building.floors[0]);
  EXPECT_NE(Complaint(building).find("'0' is taken"), std::string::npos);
  building.floors[1].label = "1";
  EXPECT_NE(Complaint(building).find("not above"), std::string::npos);

  building = OneCorridor();
  building.floors[0].passages[0].to = 7;
  EXPECT_NE(Complaint(building), "");
  building = OneCorridor();
  building.floors[0].way_points[0].position.x() = std::nan("");
  EXPECT_NE(Complaint(building), "");
  building = OneCorridor();
  building.usual_tour.start_way_point = 9;
  EXPECT_NE(Complaint(building), "");
  EXPECT_NE(Complaint(Building()), "");
}

TEST(Building, ACabIsClosedExactlyWhenItsDoorIs) {
  Elevator elevator;
  elevator.T_building_cab = {3.0, -2.0, 0.7};
  for (const double open : {0.0, 0.5, 1.0}) {
    std::vector<Segment> segments = CabWalls(elevator);
    const std::vector<Segment> door = CabDoor(elevator, open);
    segments.insert(segments.end(), door.begin(), door.end());
    const SegmentIndex index(segments);
    int out = 0;
    for (int beam = 0; beam < 3600; ++beam) {
      const double angle = DegToRad(0.1 * beam + 0.05);
      const auto hit = index.Cast(elevator.T_building_cab.Translation(),
                                  {std::cos(angle), std::sin(angle)}, 0.0, 30.0);
      if (!hit) ++out;
    }
    // The door's share of the view from the cab's centre.
    const double expected =
        2.0 * std::atan(0.5 * open * elevator.door_width / (0.5 * elevator.depth));
    EXPECT_NEAR(DegToRad(0.1 * out), expected, DegToRad(0.3)) << "rad, open " << open;
  }
}

TEST(Building, StairsAreCutHalfWay) {
  Building building = OneCorridor();
  building.floors.push_back(building.floors[0]);
  building.floors[1].way_points[1].position = {10.0, 4.0};
  Stairs stairs;
  stairs.lower = {0, 1};
  stairs.upper = {1, 1};
  stairs.way = {{16.0, 0.0}, {16.0, 4.0}};
  const auto [lower, upper] = StairsHalves(building, stairs);
  EXPECT_TRUE(lower.back().isApprox(Eigen::Vector2d(16.0, 2.0)));
  EXPECT_TRUE(upper.front().isApprox(Eigen::Vector2d(16.0, 2.0)));
  EXPECT_EQ(lower.size(), 3U);
  EXPECT_EQ(upper.size(), 3U);
}

}  // namespace
}  // namespace masked_mapper
