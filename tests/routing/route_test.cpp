// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/route.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>

#include "routing/true_ways.hpp"
#include "routing/two_floors.hpp"
#include "simulation/building_plans.hpp"
#include "simulation/simulate.hpp"

namespace masked_mapper {
namespace {

TEST(Route, GoesRoundWallsAndByElevator) {
  const BuildingMap map = TwoFloors();
  const auto grids = GridsOfTwoFloors();
  RouteOptions options;
  options.clearance = {0.2, 0.0};
  const Route one = FindRoute(map, grids, {0, {0.55, 0.55}}, {0, {3.55, 0.55}}, options);
  ASSERT_TRUE(one.is_found);
  ASSERT_EQ(one.legs.size(), 1U);
  EXPECT_TRUE(one.transits.empty());
  EXPECT_GT(one.length_m, 3.6);  // over the wall's end at 2.05, 1.25, with 0.2 m to spare
  EXPECT_LT(one.length_m, 3.9);

  const Route two = FindRoute(map, grids, {0, {0.55, 0.55}}, {1, {0.55, 0.55}}, options);
  ASSERT_TRUE(two.is_found);
  ASSERT_EQ(two.transits.size(), 1U);
  EXPECT_EQ(two.transits[0].from, 0);
  EXPECT_EQ(two.transits[0].to, 1);
  EXPECT_EQ(two.transits[0].kind, CrossingKind::kElevator);
  ASSERT_EQ(two.legs.size(), 2U);
  EXPECT_NEAR(two.legs[0].length_m, one.length_m, 0.1);
  EXPECT_EQ(two.legs[1].points_in_world.front(), Eigen::Vector2d(3.65, 0.55));
  EXPECT_DOUBLE_EQ(two.cost_m, two.length_m + options.ride_cost_m);
  EXPECT_DOUBLE_EQ(two.length_m, two.legs[0].length_m + two.legs[1].length_m);
}

TEST(Route, StairsHaveALengthAndARideItsPrice) {
  BuildingMap map = TwoFloors();
  // From floor -1 back to 0 by a ramp outside, seven metres long.
  Drive(map, 1, 0.55, 1.65, true);
  Drive(map, 1, 0.55, 4.65, true);
  Drive(map, 0, 0.55, 1.65);
  const auto grids = GridsOfTwoFloors();
  RouteOptions options;
  options.clearance = {0.2, 0.3};
  const Place from{0, {0.55, 1.65}};
  const Place to{1, {0.55, 1.65}};
  Route route = FindRoute(map, grids, from, to, options);
  ASSERT_EQ(route.transits.size(), 1U);
  EXPECT_EQ(route.transits[0].kind, CrossingKind::kStairs);
  EXPECT_NEAR(route.length_m, 6.0, 0.01);
  options.ride_cost_m = 0.0;
  options.use_stairs = false;
  route = FindRoute(map, grids, from, to, options);
  ASSERT_EQ(route.transits.size(), 1U);
  EXPECT_EQ(route.transits[0].kind, CrossingKind::kElevator);
}

TEST(Route, NoWayIsAnAnswer) {
  const BuildingMap map = TwoFloors();
  auto grids = GridsOfTwoFloors();
  RouteOptions options;
  options.clearance = {0.2, 0.0};
  // Nobody was on the roof; the nearest place is on the highest floor that is reached.
  grids[2] = grids[0];
  Route route = FindRoute(map, grids, {1, {0.55, 0.55}}, {2, {3.05, 1.05}}, options);
  EXPECT_FALSE(route.is_found);
  EXPECT_NE(route.reason.find("roof"), std::string::npos) << route.reason;
  ASSERT_TRUE(route.nearest);
  EXPECT_EQ(route.nearest->floor, 0);
  EXPECT_LT((route.nearest->at_in_world - Eigen::Vector2d(3.05, 1.05)).norm(), 0.1);
  // A wall across the room.
  for (int row = 0; row < 22; ++row) {
    grids[0].cells[static_cast<std::size_t>(row) * 42 + 30] = Cell::kOccupied;
  }
  route = FindRoute(map, grids, {0, {0.55, 0.55}}, {0, {3.75, 0.55}}, options);
  EXPECT_FALSE(route.is_found);
  EXPECT_TRUE(route.legs.empty());
  ASSERT_TRUE(route.nearest);
  EXPECT_NEAR(route.nearest->at_in_world.x(), 2.85, 0.11);
  // In a wall, and beyond all that was seen.
  route = FindRoute(map, grids, {0, {0.55, 0.55}}, {0, {-5.0, 0.55}}, options);
  EXPECT_FALSE(route.is_found);
  ASSERT_TRUE(route.nearest);
  EXPECT_LT(route.nearest->at_in_world.x(), 0.4);
  route = FindRoute(map, grids, {0, {-5.0, 0.55}}, {0, {0.55, 0.55}}, options);
  EXPECT_FALSE(route.is_found);
  EXPECT_FALSE(route.nearest);
  EXPECT_FALSE(route.reason.empty());
}

TEST(Route, KeepsOutOfWhatIsKeptOut) {
  BuildingMap map = TwoFloors();
  map.areas.push_back({AreaKind::kKeepOut, 0, {{1.5, 1.2}, {2.5, 1.2}, {2.5, 2.2}, {1.5, 2.2}}});
  RouteOptions options;
  EXPECT_FALSE(
      FindRoute(map, GridsOfTwoFloors(), {0, {0.55, 0.55}}, {0, {3.55, 0.55}}, options).is_found);
}

/// A drive at its true poses, without anything that spoils scans.
struct TrueDrive {
  Building building;
  BuildingMap map;
  std::vector<OccupancyGrid> grids;
  Pose2 T_building_world;
  std::map<std::string, FloorId> floor_of;

  explicit TrueDrive(Building driven) : building(std::move(driven)) {
    for (const FloorPlan& plan : building.floors) {
      floor_of[plan.label] = map.graph.AddFloor({plan.label, plan.elevation, 0.0, true, true});
    }
    map.graph.AddNode({});
    map.drives.push_back({});
    SimulationOptions options;
    std::vector<LaserScan> scans;
    std::vector<std::size_t> poses;
    FloorId last_floor = 0;
    SimulationSink sink;
    sink.truth = [&](const TruthPose& truth) {
      TrajectoryPose pose;
      pose.stamp = pose.log_stamp = truth.stamp;
      pose.in_transit = truth.floor == "-";
      if (!pose.in_transit) last_floor = floor_of.at(truth.floor);
      pose.floor = last_floor;
      pose.T_odom_robot = pose.T_world_robot = truth.T_world_robot;
      map.trajectory.push_back(pose);
    };
    sink.observation = [&](const Observation& observation) {
      const auto* scan = std::get_if<LaserScan>(&observation);
      if (scan == nullptr || map.trajectory.size() % 3 != 0) return;
      scans.push_back(*scan);
      poses.push_back(map.trajectory.size() - 1);
    };
    T_building_world = Simulate(building, options, SimulationNoise::None(), sink).T_building_world;
    std::vector<PosedScan> posed;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const TrajectoryPose& pose = map.trajectory[poses[i]];
      if (!pose.in_transit) posed.push_back({pose.T_world_robot, pose.floor, &scans[i]});
    }
    for (std::size_t i = 0; i < building.floors.size(); ++i) {
      grids.push_back(RenderGrid(posed, static_cast<FloorId>(i), GridOptions{}));
    }
  }
};

/// A place on the way, and where in the drive.
struct Passed {
  std::size_t pose = 0;
  Place place;
};

class RouteInBuilding : public testing::TestWithParam<Building (*)()> {
 protected:
  void SetUp() override { drive_.emplace(GetParam()()); }

  Passed AnyPassed(std::mt19937& random) const {
    for (;;) {
      const std::size_t i = random() % drive_->map.trajectory.size();
      const TrajectoryPose& pose = drive_->map.trajectory[i];
      if (!pose.in_transit) return {i, {pose.floor, pose.T_world_robot.Translation()}};
    }
  }

  bool AreInOneCab(const Eigen::Vector2d& a_in_world, const Eigen::Vector2d& b_in_world) const {
    const std::vector<Elevator>& cabs = drive_->building.elevators;
    return std::any_of(cabs.begin(), cabs.end(), [&](const Elevator& cab) {
      const Pose2 T_cab_world = Inverse(cab.T_building_cab) * drive_->T_building_world;
      const auto is_inside = [&](const Eigen::Vector2d& at_in_world) {
        const Eigen::Vector2d at = T_cab_world * at_in_world;
        return std::abs(at.x()) < 0.5 * cab.depth && std::abs(at.y()) < 0.5 * cab.width;
      };
      return is_inside(a_in_world) && is_inside(b_in_world);
    });
  }

  std::optional<TrueDrive> drive_;
};

TEST_P(RouteInBuilding, IsTheShortestThereIs) {
  const TrueDrive& drive = *drive_;
  RouteOptions options;
  options.use_stairs = false;  // by lift any two floors are a ride apart
  std::map<FloorId, TrueWays> truth;
  std::mt19937 random(2);
  int found = 0;
  double worst = 0.0;
  for (int trial = 0; trial < 12; ++trial) {
    const Place from = AnyPassed(random).place;
    const Place to = AnyPassed(random).place;
    const Route route = FindRoute(drive.map, drive.grids, from, to, options);
    ASSERT_TRUE(route.is_found);
    // In the tower some floors were come to and left by one cab alone, others by the other.
    EXPECT_EQ(route.transits.empty(), from.floor == to.floor);
    EXPECT_LE(route.transits.size(), 2U);
    for (std::size_t i = 0; i < route.transits.size(); ++i) {
      EXPECT_TRUE(AreInOneCab(route.legs[i].points_in_world.back(),
                              route.legs[i + 1].points_in_world.front()));
    }
    double shortest = 0.0;
    double on_foot = 0.0;
    for (const RouteLeg& leg : route.legs) {
      const auto ways = truth.try_emplace(
          leg.floor, StandingSegments(drive.building, static_cast<std::size_t>(leg.floor)),
          options.clearance.radius_m);
      shortest += ways.first->second.Length(drive.T_building_world * leg.points_in_world.front(),
                                            drive.T_building_world * leg.points_in_world.back());
      on_foot += leg.length_m;
    }
    if (shortest < 3.0) continue;  // shorter ones are a matter of cells
    worst = std::max(worst, on_foot / shortest);
    EXPECT_LT(on_foot, 1.02 * shortest);
    EXPECT_GT(on_foot, 0.99 * shortest);
    ++found;
  }
  EXPECT_GT(found, 6);
  RecordProperty("worst", std::to_string(worst));
}

// The paper measures a map by the lengths of ways along what was driven: there is a shorter way
// only where the robot did not go the shortest.
TEST_P(RouteInBuilding, IsAsLongAsWhatWasDrivenWhereThatIsTheWay) {
  const std::vector<TrajectoryPose>& driven = drive_->map.trajectory;
  std::mt19937 random(3);
  int straight = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Passed from = AnyPassed(random);
    Passed to = from;
    double driven_m = 0.0;
    while (driven_m < 6.0 && to.pose + 1 < driven.size() &&
           driven[to.pose + 1].floor == from.place.floor && !driven[to.pose + 1].in_transit) {
      ++to.pose;
      driven_m += Distance(driven[to.pose - 1].T_world_robot, driven[to.pose].T_world_robot);
    }
    to.place.at_in_world = driven[to.pose].T_world_robot.Translation();
    if (driven_m < 3.0) continue;
    const Route route = FindRoute(drive_->map, drive_->grids, from.place, to.place, {});
    ASSERT_TRUE(route.is_found);
    EXPECT_LT(route.length_m, 1.02 * driven_m);
    const double as_crow_flies = (to.place.at_in_world - from.place.at_in_world).norm();
    if (driven_m > 1.01 * as_crow_flies) continue;
    EXPECT_GT(route.length_m, 0.98 * driven_m);
    ++straight;
  }
  EXPECT_GT(straight, 5);
}

INSTANTIATE_TEST_SUITE_P(Named, RouteInBuilding, testing::Values(OfficeBuilding, TowerBuilding));

}  // namespace
}  // namespace masked_mapper
