// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

TEST(LidarSimulation, EveryBeamEqualsBruteForce) {
  for (const char* name : {"office", "campus"}) {
    const Building building = *NamedBuilding(name, 1);
    const RobotDrive drive(building, PlanTour(building, {1, 0.0, {}}), {});
    const LidarOptions options;
    LidarSimulation lidar(building, options, LidarNoise::None(), 1);
    for (int sample = 0; sample < 40; ++sample) {
      const double time = drive.Duration() * sample / 40.0;
      const RobotState state = drive.At(time);
      const LaserScan scan = lidar.Scan(time, state);
      ASSERT_EQ(scan.size(), 361U);
      std::vector<Segment> all = StandingSegments(building, state.floor);
      const std::vector<Segment> doors = lidar.Doors(state);
      all.insert(all.end(), doors.begin(), doors.end());
      const Pose2 T_building_laser = state.T_building_robot * options.T_robot_laser;
      for (std::size_t beam = 0; beam < scan.size(); beam += 3) {
        const double angle = T_building_laser.theta + scan.Angle(beam);
        double nearest = options.max_range;
        for (const Segment& segment : all) {
          const auto range =
              RayRange(T_building_laser.Translation(), {std::cos(angle), std::sin(angle)}, segment,
                       options.min_range);
          if (range) nearest = std::min(nearest, *range);
        }
        const float expected =
            nearest < options.max_range ? static_cast<float>(nearest) : kNoReturn;
        ASSERT_EQ(scan.ranges[beam], expected) << name << " at " << time << " s, beam " << beam;
      }
    }
  }
}

TEST(LidarSimulation, InsideAClosedCabThereIsABox) {
  const Building office = OfficeBuilding();
  LidarSimulation lidar(office, {}, LidarNoise::None(), 1);
  RobotState state;
  state.T_building_robot = office.elevators[0].T_building_cab;
  const LaserScan scan = lidar.Scan(0.0, state);
  const double corner = std::hypot(office.elevators[0].depth, office.elevators[0].width);
  for (const float range : scan.ranges) EXPECT_LT(range, corner) << "m";
  state.door_open = 1.0;
  const LaserScan open = lidar.Scan(1.0, state);
  EXPECT_GT(*std::max_element(open.ranges.begin(), open.ranges.end()), corner) << "m";
}

TEST(LidarSimulation, NoiseHasItsDeviation) {
  Building building;
  building.floors.resize(1);
  building.floors[0].segments = {{{5.0, -40.0}, {5.0, 40.0}, Surface::kWall}};
  LidarNoise noise = LidarNoise::None();
  noise.sigma = 0.02;
  LidarOptions options;
  options.beams = 2;
  options.field_of_view_deg = 1e-6;
  options.T_robot_laser = {};
  LidarSimulation lidar(building, options, noise, 7);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) {
    const double error = lidar.Scan(0.0, {}).ranges[0] - 5.0;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 1e-3) << "m";
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.02, 1e-3) << "m";
}

TEST(LidarSimulation, GlassReturnsByChance) {
  Building building;
  building.floors.resize(1);
  building.floors[0].segments = {{{5.0, -40.0}, {5.0, 40.0}, Surface::kGlass},
                                 {{9.0, -40.0}, {9.0, 40.0}, Surface::kWall}};
  LidarNoise noise = LidarNoise::None();
  noise.glass_return = 0.75;
  LidarOptions options;
  options.beams = 2;
  options.field_of_view_deg = 1e-6;
  options.T_robot_laser = {};
  LidarSimulation lidar(building, options, noise, 7);
  int glass = 0;
  constexpr int kCount = 4'000;
  for (int i = 0; i < kCount; ++i) {
    const float range = lidar.Scan(0.0, {}).ranges[0];
    EXPECT_TRUE(std::abs(range - 5.0F) < 1e-3F || std::abs(range - 9.0F) < 1e-3F) << range;
    if (range < 7.0F) ++glass;
  }
  EXPECT_NEAR(static_cast<double>(glass) / kCount, 0.75, 0.03);
}

TEST(LidarSimulation, PeopleAreSeenInFrontOfWalls) {
  const Building building = CorridorsBuilding();
  LidarNoise noise = LidarNoise::None();
  LidarSimulation empty(building, {}, noise, 1);
  noise.people.per_kilometre = 100.0;
  LidarSimulation busy(building, {}, noise, 1);
  RobotState state;
  state.T_building_robot = {0.0, 0.0, 0.3};
  int seen = 0;
  for (int i = 0; i < 100; ++i) {
    const LaserScan with = busy.Scan(0.2 * i, state);
    const LaserScan without = empty.Scan(0.2 * i, state);
    for (std::size_t beam = 0; beam < with.size(); ++beam) {
      EXPECT_LE(with.ranges[beam], without.ranges[beam]) << "m";
      if (with.ranges[beam] < without.ranges[beam]) ++seen;
    }
  }
  EXPECT_GT(seen, 0);
}

TEST(LidarSimulation, AllRoundScannersDoNotRepeatABeam) {
  LidarOptions options;
  options.field_of_view_deg = 360.0;
  options.beams = 720;
  const Building building = CorridorsBuilding();
  LidarSimulation lidar(building, options, LidarNoise::None(), 1);
  EXPECT_TRUE(lidar.Scan(0.0, {}).IsFullCircle());
}

TEST(LidarSimulation, RefusesNonsense) {
  const Building building = CorridorsBuilding();
  LidarOptions options;
  options.beams = 1;
  EXPECT_THROW(LidarSimulation(building, options, {}, 1), InputError);
  options = {};
  options.max_range = std::nan("");
  EXPECT_THROW(LidarSimulation(building, options, {}, 1), InputError);
  options = {};
  options.field_of_view_deg = 400.0;
  EXPECT_THROW(LidarSimulation(building, options, {}, 1), InputError);
}

}  // namespace
}  // namespace masked_mapper
