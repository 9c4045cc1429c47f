// SPDX-License-Identifier: BSD-3-Clause
#include "building_plans.hpp"

#include <cmath>

#include "building_assembly.hpp"
#include "floor_planner.hpp"
#include "random_building.hpp"

namespace masked_mapper {
namespace {

constexpr double kQuarterTurn = 0.5 * kPi;

SideStyle NoRooms() {
  SideStyle side;
  side.rooms = false;
  return side;
}

CorridorStyle Plain(double width) {
  CorridorStyle style;
  style.width = width;
  style.left = style.right = NoRooms();
  style.clutter = 0.0;
  return style;
}

CorridorStyle Offices(double width, double left_depth, double right_depth) {
  CorridorStyle style;
  style.width = width;
  style.left.depth_max = left_depth;
  style.left.depth_min = 0.72 * left_depth;
  style.right.depth_max = right_depth;
  style.right.depth_min = 0.72 * right_depth;
  return style;
}

CorridorStyle Glazed(double width) {
  CorridorStyle style;
  style.width = width;
  style.left.glazed = style.right.glazed = true;
  style.clutter = 0.02;
  return style;
}

ConvexSpace Hall(double x0, double y0, double x1, double y1) {
  return ConvexSpace::Rectangle({}, x0, y0, x1, y1);
}

ConvexSpace RoundHall(double x, double y, double radius, int sides) {
  ConvexSpace hall;
  for (int side = 0; side < sides; ++side) {
    const double angle = (2 * side + 1) * kPi / sides;
    hall.corners.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
    hall.surfaces.emplace_back(Surface::kWall);
  }
  return hall;
}

Elevator Cab(const std::string& name, double x, double y, double theta, double depth,
             double width) {
  Elevator elevator;
  elevator.name = name;
  elevator.T_building_cab = {x, y, theta};
  elevator.depth = depth;
  elevator.width = width;
  return elevator;
}

FloorPlanner OfficeFloor(const Building& building, std::uint64_t seed, bool ground) {
  FloorPlanner planner(seed);
  planner.SetLimits({0.0, 0.0}, {33.0, 18.0});
  planner.SetVisitedRooms(2);
  CorridorStyle ring = Offices(2.0, 4.2, 3.9);
  ring.clutter = 0.08;
  planner.AddCorridor({5.5, 5.0}, {26.5, 5.0}, ring);
  planner.AddCorridor({26.5, 5.0}, {26.5, 13.0}, ring);
  planner.AddCorridor({26.5, 13.0}, {5.5, 13.0}, ring);
  planner.AddCorridor({5.5, 13.0}, {5.5, 5.0}, ring);
  planner.AddCorridor({17.5, 5.0}, {17.5, 13.0}, Offices(1.8, 3.4, 3.4));
  planner.AddCorridor({26.5, 9.5}, {32.6, 9.5}, Plain(1.9));
  if (ground) {
    planner.AddCorridor({1.6, 8.6}, {5.5, 8.6}, Plain(1.9));
    planner.AddHall(Hall(0.4, 6.2, 5.0, 11.4), 0.0);
  }
  planner.AddElevatorStop(0, building.elevators[0]);
  return planner;
}

FloorPlanner TowerFloor(const Building& building) {
  FloorPlanner planner(77);
  planner.SetLimits({0.0, 0.0}, {38.0, 27.0});
  planner.SetVisitedRooms(2);
  CorridorStyle ring = Offices(2.2, 4.4, 5.6);
  ring.left.open_share = ring.right.open_share = 0.25;
  planner.AddCorridor({7.5, 7.5}, {29.0, 7.5}, ring);
  planner.AddCorridor({29.0, 7.5}, {29.0, 19.5}, ring);
  planner.AddCorridor({29.0, 19.5}, {7.5, 19.5}, ring);
  planner.AddCorridor({7.5, 19.5}, {7.5, 7.5}, ring);
  planner.AddCorridor({29.0, 13.0}, {37.5, 13.0}, Offices(1.9, 4.6, 4.2));
  planner.AddElevatorStop(0, building.elevators[0]);
  planner.AddElevatorStop(1, building.elevators[1]);
  return planner;
}

// The three buildings of the campus, on a grid of its own each.

void AddBuildingA(FloorPlanner& planner, const Building& building, int floor) {
  CorridorStyle wing = Offices(2.4, 5.4, 5.8);
  wing.fire_doors = 24.0;
  CorridorStyle old_wing = Offices(2.1, 4.6, 6.2);
  old_wing.left.wall = old_wing.right.wall = 0.34;
  old_wing.left.recess = old_wing.right.recess = 0.24;
  old_wing.left.width_max = old_wing.right.width_max = 4.6;
  CorridorStyle laboratories = Offices(2.8, 7.0, 7.0);
  laboratories.left.width_min = laboratories.right.width_min = 4.5;
  laboratories.left.width_max = laboratories.right.width_max = 9.5;
  laboratories.clutter = 0.12;
  planner.AddElevatorStop(0, building.elevators[0]);
  planner.AddElevatorStop(1, building.elevators[1]);
  if (floor == 0) {
    planner.AddCorridor({8.0, 10.0}, {58.0, 10.0}, wing);
    planner.AddCorridor({58.0, 10.0}, {58.0, 40.0}, wing);
    planner.AddCorridor({58.0, 40.0}, {8.0, 40.0}, wing);
    planner.AddCorridor({8.0, 40.0}, {8.0, 10.0}, old_wing);
    planner.AddCorridor({24.0, 40.0}, {24.0, 66.0}, laboratories);
    planner.AddHall(Hall(30.0, 15.0, 50.0, 34.0), 6.3);
    planner.AddCorridor({40.0, 10.0}, {40.0, 34.5}, Plain(3.2));
  } else if (floor == 1) {
    planner.AddCorridor({8.0, 10.0}, {66.0, 10.0}, wing);
    planner.AddCorridor({66.0, 10.0}, {66.0, 40.0}, laboratories);
    planner.AddCorridor({66.0, 40.0}, {8.0, 40.0}, wing);
    planner.AddCorridor({8.0, 40.0}, {8.0, 10.0}, old_wing);
    planner.AddCorridor({33.0, 10.0}, {33.0, 40.0}, wing);
    planner.AddCorridor({50.0, 40.0}, {50.0, 58.0}, old_wing);
  } else {
    planner.AddCorridor({8.0, 8.0}, {66.0, 8.0}, wing);
    planner.AddCorridor({66.0, 8.0}, {66.0, 72.0}, laboratories);
    planner.AddCorridor({66.0, 72.0}, {8.0, 72.0}, wing);
    planner.AddCorridor({8.0, 72.0}, {8.0, 8.0}, old_wing);
    planner.AddCorridor({66.0, 40.0}, {8.0, 40.0}, wing);
    planner.AddCorridor({30.0, 72.0}, {30.0, 82.0}, old_wing);
    planner.AddCorridor({46.0, 0.0}, {46.0, 8.0}, old_wing);
    planner.AddCorridor({0.0, 57.0}, {8.0, 57.0}, old_wing);
  }
}

StairwellPlan CampusStairwell() {
  StairwellPlan stairwell;
  stairwell.T_building_mouth = {128.0, 70.0 - 1.3, -kQuarterTurn};
  return stairwell;
}

void AddBuildingB(FloorPlanner& planner, const Building& building, int floor) {
  CorridorStyle wing = Offices(2.6, 6.2, 6.2);
  wing.fire_doors = 30.0;
  planner.AddElevatorStop(2, building.elevators[2]);
  planner.AddStairwell(0, CampusStairwell(), floor == 2);
  planner.AddCorridor({114.0, 22.0}, {166.0, 22.0}, wing);
  planner.AddCorridor({166.0, 22.0}, {166.0, 70.0}, wing);
  planner.AddCorridor({166.0, 70.0}, {114.0, 70.0}, wing);
  planner.AddCorridor({114.0, 70.0}, {114.0, 22.0}, wing);
  if (floor == 2) {
    planner.AddHall(RoundHall(140.0, 45.0, 12.0, 10), 7.0);
    planner.AddCorridor({114.0, 45.0}, {166.0, 45.0}, wing);
    planner.AddCorridor({140.0, 22.0}, {140.0, 70.0}, Offices(2.2, 5.0, 5.0));
  } else {
    planner.AddCorridor({148.0, 22.0}, {148.0, 70.0}, Offices(2.2, 5.0, 5.0));
  }
}

void AddBuildingC(FloorPlanner& planner) {
  CorridorStyle wing = Offices(2.3, 5.2, 5.6);
  CorridorStyle studios = Offices(2.6, 6.6, 4.6);
  studios.left.width_min = 4.0;
  studios.left.width_max = 8.0;
  planner.AddCorridor({192.0, 40.0}, {250.0, 12.0}, wing);
  planner.AddCorridor({250.0, 12.0}, {256.0, 66.0}, studios);
  planner.AddCorridor({256.0, 66.0}, {192.0, 40.0}, wing);
  planner.AddCorridor({250.0 + 6.0 * 28.0 / 54.0, 40.0}, {264.0, 40.0}, Offices(2.0, 4.0, 4.0));
}

}  // namespace

Building OfficeBuilding() {
  Building building;
  building.name = "office";
  building.elevators = {Cab("lift", 11.0, 7.15, -kQuarterTurn, 1.9, 1.9)};
  AddFloor(building, OfficeFloor(building, 11, true).Plan("0", 0.0));
  AddFloor(building, OfficeFloor(building, 12, false).Plan("1", 3.4));
  building.usual_tour.start_way_point = NearestWayPoint(building.floors[0], {2.0, 8.6});
  building.usual_tour.visits = {0, 1, 0};
  building.usual_tour.rest_per_metre = 0.15;
  return building;
}

Building CorridorsBuilding() {
  constexpr int kCorridors = 6;
  constexpr double kSpacing = 8.0;  // m
  constexpr double kLength = 45.0;  // m
  Building building;
  building.name = "corridors";
  FloorPlanner planner(1);
  const CorridorStyle blank = Plain(2.0);
  for (int i = 0; i < kCorridors; ++i) {
    planner.AddCorridor({0.0, kSpacing * i}, {kLength, kSpacing * i}, blank);
  }
  for (const double x : {0.0, kLength}) {
    planner.AddCorridor({x, 0.0}, {x, kSpacing * (kCorridors - 1)}, blank);
  }
  AddFloor(building, planner.Plan("0", 0.0));
  building.usual_tour.start_way_point = NearestWayPoint(building.floors[0], {0.0, 0.0});
  building.usual_tour.visits = {0, 0};
  return building;
}

Building TowerBuilding() {
  constexpr int kFloors = 10;
  constexpr double kStorey = 3.6;  // m
  Building building;
  building.name = "tower";
  building.elevators = {Cab("south", 14.0, 7.5 + 1.1 + 0.2 + 1.0, -kQuarterTurn, 2.0, 2.0),
                        Cab("north", 20.5, 19.5 - 1.1 - 0.2 - 1.0, kQuarterTurn, 2.0, 2.0)};
  const FloorPlanner::Planned planned = TowerFloor(building).Plan("0", 0.0);
  for (int i = 0; i < kFloors; ++i) {
    FloorPlanner::Planned copy = planned;
    copy.floor.label = std::to_string(i);
    copy.floor.elevation = kStorey * i;
    AddFloor(building, copy);
  }
  building.usual_tour.start_way_point = NearestWayPoint(building.floors[0], {7.5, 13.0});
  building.usual_tour.visits = {0, 7, 3, 7, 0, 1, 9, 2, 5, 8, 4, 6, 0};
  return building;
}

Building CampusBuilding() {
  Building building;
  building.name = "campus";
  building.elevators = {Cab("a-west", 8.0 + 1.05 + 0.2 + 1.0, 25.0, kPi, 2.0, 2.0),
                        Cab("a-middle", 40.0, 40.0 + 1.2 + 0.2 + 1.1, -kQuarterTurn, 2.2, 1.8),
                        Cab("b-east", 166.0 - 1.3 - 0.2 - 1.0, 34.0, 0.0, 2.0, 2.2)};
  building.stairs.resize(1);
  {
    FloorPlanner planner(101);
    planner.SetLimits({0.0, 2.0}, {66.0, 66.0});
    planner.SetVisitedRooms(4);
    AddBuildingA(planner, building, 0);
    AddFloor(building, planner.Plan("0", 0.0));
  }
  {
    FloorPlanner planner(102);
    planner.SetLimits({0.0, 2.0}, {74.0, 58.0});
    planner.SetVisitedRooms(4);
    AddBuildingA(planner, building, 1);
    AddFloor(building, planner.Plan("1", 4.6));
  }
  {
    FloorPlanner planner(103);
    planner.SetLimits({0.0, 0.0}, {264.0, 82.0});
    planner.SetVisitedRooms(12);
    AddBuildingA(planner, building, 2);
    planner.AddCorridor({66.0, 48.0}, {76.0, 48.0}, Offices(2.6, 4.0, 4.0));
    planner.AddCorridor({76.0, 48.0}, {104.0, 48.0}, Glazed(2.6));
    planner.AddCorridor({104.0, 48.0}, {114.0, 48.0}, Plain(2.6));
    AddBuildingB(planner, building, 2);
    planner.AddCorridor({166.0, 45.0}, {174.0, 43.5}, Plain(2.4));
    planner.AddCorridor({174.0, 43.5}, {192.0, 40.0}, Glazed(2.4));
    AddBuildingC(planner);
    AddFloor(building, planner.Plan("2", 8.6));
  }
  {
    FloorPlanner planner(104);
    planner.SetLimits({107.0, 15.0}, {173.5, 77.5});
    planner.SetVisitedRooms(4);
    AddBuildingB(planner, building, 3);
    AddFloor(building, planner.Plan("3", 12.5));
  }
  building.stairs[0].name = "b-north";
  building.stairs[0].way = StairwellWay(CampusStairwell());
  building.usual_tour.start_way_point = NearestWayPoint(building.floors[0], {40.0, 30.0});
  building.usual_tour.visits = {0, 1, 2, 3, 2, 0};
  building.usual_tour.rest_per_metre = 1.75;
  return building;
}

std::vector<std::string> BuildingNames() {
  return {"campus", "corridors", "office", "random", "tower"};
}

std::optional<Building> NamedBuilding(const std::string& name, std::uint64_t seed) {
  if (name == "campus") return CampusBuilding();
  if (name == "corridors") return CorridorsBuilding();
  if (name == "office") return OfficeBuilding();
  if (name == "random") return RandomBuilding(seed);
  if (name == "tower") return TowerBuilding();
  return std::nullopt;
}

}  // namespace masked_mapper
