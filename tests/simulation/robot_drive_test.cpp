// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/robot_drive.hpp"

#include <gtest/gtest.h>

#include "simulation/building_plans.hpp"
#include "simulation/segment_index.hpp"

namespace masked_mapper {
namespace {

class Drives : public testing::TestWithParam<const char*> {};

TEST_P(Drives, NothingIsTouchedAndNoLimitIsBroken) {
  const Building building = *NamedBuilding(GetParam(), 2);
  DriveOptions options;
  options.seed = 2;
  const RobotDrive drive(building, PlanTour(building, {2, 0.0, {}}), options);
  std::vector<SegmentIndex> standing;
  for (std::size_t f = 0; f < building.floors.size(); ++f) {
    standing.emplace_back(StandingSegments(building, f));
  }
  constexpr double kStep = 0.05;  // s
  RobotState last = drive.At(0.0);
  double driven = 0.0;
  double nearest = 10.0;
  for (double time = kStep; time <= drive.Duration(); time += kStep) {
    const RobotState state = drive.At(time);
    const Pose2 moved = Between(last.T_building_robot, state.T_building_robot);
    const double distance = std::hypot(moved.x, moved.y);
    driven += distance;
    nearest = std::min(nearest,
                       standing[state.floor].Clearance(state.T_building_robot.Translation(), 1.0));
    // The door that the robot passes is open.
    for (std::size_t e = 0; e < building.elevators.size(); ++e) {
      const double open = state.elevator == e ? state.door_open : 0.0;
      for (const Segment& leaf : CabDoor(building.elevators[e], open)) {
        bool stops = false;
        for (const Landing& landing : building.elevators[e].landings) {
          stops = stops || landing.floor == state.floor;
        }
        if (!stops) continue;
        nearest = std::min(nearest,
                           DistanceToSegment(state.T_building_robot.Translation(), leaf.a, leaf.b));
      }
    }
    ASSERT_LE(distance, (options.speed_max + 1e-6) * kStep) << "m at " << time << " s";
    ASSERT_LE(std::abs(moved.theta), (options.turn_rate + 1e-6) * kStep) << "rad at " << time;
    // A unicycle: sideways only as far as an arc bends.
    ASSERT_LE(std::abs(moved.y), 0.5 * distance * options.turn_rate * kStep + 1e-6)
        << "m at " << time;
    ASSERT_LE(std::abs(state.speed - last.speed), options.acceleration * kStep + 1e-6)
        << "m/s at " << time;
    ASSERT_LE(std::abs(state.elevation - last.elevation), 2.0 * kStep) << "m at " << time;
    ASSERT_TRUE(state.floor == last.floor || state.in_transit);
    if (!state.in_transit) {
      ASSERT_NEAR(state.elevation, building.floors[state.floor].elevation, 1e-9) << "m at " << time;
    }
    last = state;
  }
  EXPECT_GE(nearest, options.robot_radius) << "m";
  EXPECT_NEAR(driven, drive.Length(), 0.01 * drive.Length()) << "m";
  const RobotState first = drive.At(0.0);
  EXPECT_NEAR(Distance(first.T_building_robot, last.T_building_robot), 0.0, 0.01) << "m";
}

INSTANTIATE_TEST_SUITE_P(Named, Drives,
                         testing::ValuesIn({"office", "corridors", "tower", "campus"}),
                         [](const auto& info) { return std::string(info.param); });

TEST(RobotDrive, RidesAreSmoothAndEndOnTheFloor) {
  const Building office = OfficeBuilding();
  const RobotDrive drive(office, PlanTour(office, {1, 0.0, {}}), {});
  constexpr double kStep = 0.01;  // s
  double speed = 0.0;             // m/s upwards, from the acceleration
  double height = 0.0;
  double fastest = 0.0;
  for (double time = 0.0; time < drive.Duration(); time += kStep) {
    const RobotState state = drive.At(time);
    speed += state.vertical_acceleration * kStep;
    height += speed * kStep;
    fastest = std::max(fastest, speed);
    EXPECT_LE(std::abs(state.vertical_acceleration), 1.5) << "m/s^2";
    ASSERT_NEAR(height, state.elevation, 0.1) << "m at " << time << " s";
  }
  EXPECT_GT(fastest, 1.0) << "m/s";
  EXPECT_NEAR(speed, 0.0, 0.01) << "m/s";
}

TEST(RobotDrive, CampusTakesThePapersTime) {
  const Building campus = CampusBuilding();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    DriveOptions options;
    options.seed = seed;
    options.rest_per_metre = campus.usual_tour.rest_per_metre;
    const RobotDrive drive(campus, PlanTour(campus, {seed, 0.0, {}}), options);
    EXPECT_NEAR(drive.Duration() / 3600.0, 2.5, 0.4) << "h";
    EXPECT_NEAR(drive.Length(), 2'500.0, 300.0) << "m";
  }
}

}  // namespace
}  // namespace masked_mapper
