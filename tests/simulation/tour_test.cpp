// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/tour.hpp"

#include <gtest/gtest.h>

#include <set>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

using Ways = std::set<std::pair<std::size_t, std::size_t>>;

/// Every step of a tour follows a passage, every transit a landing; returns what was driven.
std::vector<Ways> CheckedWays(const Building& building, const Tour& tour) {
  std::vector<Ways> driven(building.floors.size());
  EXPECT_EQ(tour.transits.size() + 1, tour.legs.size());
  for (const TourLeg& leg : tour.legs) {
    Ways passages;
    for (const Passage& passage : building.floors[leg.floor].passages) {
      passages.insert({passage.from, passage.to});
      passages.insert({passage.to, passage.from});
    }
    for (std::size_t i = 1; i < leg.way_points.size(); ++i) {
      const std::pair<std::size_t, std::size_t> step{leg.way_points[i - 1], leg.way_points[i]};
      EXPECT_TRUE(passages.count(step) > 0) << step.first << " to " << step.second;
      driven[leg.floor].insert(step);
      driven[leg.floor].insert({step.second, step.first});
    }
  }
  for (std::size_t t = 0; t < tour.transits.size(); ++t) {
    const auto is_end = [](const Landing& landing, const TourLeg& leg, std::size_t way_point) {
      return landing.floor == leg.floor && landing.way_point == way_point;
    };
    std::vector<Landing> landings;
    if (tour.transits[t].kind == Transit::Kind::kElevator) {
      landings = building.elevators[tour.transits[t].index].landings;
    } else {
      const Stairs& stairs = building.stairs[tour.transits[t].index];
      landings = {stairs.lower, stairs.upper};
    }
    int ends = 0;
    for (const Landing& landing : landings) {
      if (is_end(landing, tour.legs[t], tour.legs[t].way_points.back())) ++ends;
      if (is_end(landing, tour.legs[t + 1], tour.legs[t + 1].way_points.front())) ++ends;
    }
    EXPECT_EQ(ends, 2) << "transit " << t;
  }
  return driven;
}

TEST(Tour, VisitsEveryCorridorOfEveryFloorAndComesBack) {
  for (const std::string& name : BuildingNames()) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const Building building = *NamedBuilding(name, seed);
      const Tour tour = PlanTour(building, {seed, 0.0, {}});
      const std::vector<Ways> driven = CheckedWays(building, tour);
      for (std::size_t f = 0; f < building.floors.size(); ++f) {
        for (const Passage& passage : building.floors[f].passages) {
          EXPECT_TRUE(!passage.must_visit || driven[f].count({passage.from, passage.to}) > 0)
              << name << " floor " << f << ": " << passage.from << " to " << passage.to;
        }
      }
      EXPECT_EQ(tour.legs.back().floor, building.usual_tour.start_floor);
      EXPECT_EQ(tour.legs.back().way_points.back(), building.usual_tour.start_way_point);
    }
  }
}

TEST(Tour, CampusIsAsLongAsThePapers) {
  const Building campus = CampusBuilding();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const double length = TourLength(campus, PlanTour(campus, {seed, 0.0, {}}));
    EXPECT_GT(length, 2'200.0) << "m, seed " << seed;
    EXPECT_LT(length, 2'800.0) << "m, seed " << seed;
  }
}

TEST(Tour, GoesOnForAsLongAsAsked) {
  for (const char* name : {"office", "corridors", "tower"}) {
    const Building building = *NamedBuilding(name, 1);
    for (const double length : {1'000.0, 5'000.0}) {
      const Tour tour = PlanTour(building, {4, length, {}});
      const double usual = TourLength(building, PlanTour(building, {4, 0.0, {}}));
      EXPECT_GE(TourLength(building, tour), length) << "m";
      EXPECT_LE(TourLength(building, tour), std::max(usual, length) + 250.0) << "m";
      CheckedWays(building, tour);
      EXPECT_EQ(tour.legs.back().way_points.back(), building.usual_tour.start_way_point);
    }
  }
}

TEST(Tour, TowerIsVisitedInAnyOrder) {
  const Building tower = TowerBuilding();
  const std::vector<std::size_t> visits{0, 9, 4, 9, 0};
  const Tour tour = PlanTour(tower, {1, 0.0, visits});
  std::vector<std::size_t> floors;
  for (const TourLeg& leg : tour.legs) floors.push_back(leg.floor);
  ASSERT_GE(floors.size(), visits.size());
  EXPECT_TRUE(std::equal(visits.begin(), visits.end(), floors.begin()));
  EXPECT_THROW(PlanTour(tower, {1, 0.0, {0, 10}}), InputError);
}

TEST(Tour, UsesEveryElevatorAndStairs) {
  const Building campus = CampusBuilding();
  const Tour tour = PlanTour(campus, {1, 0.0, {}});
  std::set<std::size_t> elevators;
  std::set<std::size_t> stairs;
  for (const Transit& transit : tour.transits) {
    (transit.kind == Transit::Kind::kElevator ? elevators : stairs).insert(transit.index);
  }
  EXPECT_EQ(elevators.size(), campus.elevators.size());
  EXPECT_EQ(stairs.size(), campus.stairs.size());
}

TEST(Tour, SeedsDiffer) {
  const Building campus = CampusBuilding();
  const Tour a = PlanTour(campus, {1, 0.0, {}});
  const Tour b = PlanTour(campus, {2, 0.0, {}});
  const Tour c = PlanTour(campus, {1, 0.0, {}});
  EXPECT_NE(a.legs[0].way_points, b.legs[0].way_points);
  EXPECT_EQ(a.legs[0].way_points, c.legs[0].way_points);
}

TEST(Tour, ADeadEndIsDrivenThereAndBack) {
  Building building;
  building.name = "stub";
  FloorPlan floor;
  floor.label = "0";
  floor.way_points = {{"a", {0.0, 0.0}}, {"b", {10.0, 0.0}}};
  floor.passages = {{0, 1, true}};
  building.floors.push_back(floor);
  const Tour tour = PlanTour(building, {1, 0.0, {}});
  EXPECT_EQ(tour.legs[0].way_points, (std::vector<std::size_t>{0, 1, 0}));
}

TEST(Tour, AnotherOneStartsElsewhereOnAnotherFloor) {
  for (const std::string& name : BuildingNames()) {
    Building building = *NamedBuilding(name, 1);
    const UsualTour usual = OtherTour(building, 1, 1, {});
    EXPECT_EQ(usual.start_floor, building.usual_tour.start_floor);
    EXPECT_EQ(usual.visits, building.usual_tour.visits);
    for (const std::uint64_t number : {2U, 3U, 4U}) {
      const UsualTour other = OtherTour(building, 1, number, {});
      EXPECT_TRUE(building.floors.size() == 1 || other.start_floor != usual.start_floor) << name;
      const auto last = static_cast<std::size_t>(building.floors.size() - 1);
      EXPECT_EQ(OtherTour(building, 1, number, {last}).start_floor, last);
      building.usual_tour = other;
      CheckBuilding(building, 0.4);
      CheckedWays(building, PlanTour(building, {number, 0.0, {}}));
      building.usual_tour = usual;
    }
    EXPECT_EQ(OtherTour(building, 1, 2, {99}).start_floor, usual.start_floor)
        << "no such floor, which PlanTour says";
  }
}

}  // namespace
}  // namespace masked_mapper
