// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/random_building.hpp"

#include <gtest/gtest.h>

#include <set>

#include "simulation/building_file.hpp"
#include "simulation/robot_drive.hpp"
#include "simulation/segment_index.hpp"
#include "simulation/tour.hpp"

namespace masked_mapper {
namespace {

TEST(RandomBuilding, EverySeedCanBeDriven) {
  std::set<std::size_t> floors;
  double shortest = 1e9;
  double longest = 0.0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const Building building = RandomBuilding(seed);
    ASSERT_NO_THROW(CheckBuilding(building, 0.4)) << "seed " << seed;
    EXPECT_EQ(building.floors[building.usual_tour.start_floor].label, "0");
    floors.insert(building.floors.size());
    const double length = TourLength(building, PlanTour(building, {seed, 0.0, {}}));
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  EXPECT_EQ(floors, (std::set<std::size_t>{1, 2, 3, 4, 5}));
  EXPECT_GT(shortest, 80.0) << "m";
  EXPECT_LT(longest, 4'000.0) << "m";
}

TEST(RandomBuilding, NoDriveTouchesAnything) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const Building building = RandomBuilding(seed);
    DriveOptions options;
    options.seed = seed;
    const RobotDrive drive(building, PlanTour(building, {seed, 0.0, {}}), options);
    std::vector<SegmentIndex> standing;
    for (std::size_t f = 0; f < building.floors.size(); ++f) {
      standing.emplace_back(StandingSegments(building, f));
    }
    double nearest = 10.0;
    for (double time = 0.0; time < drive.Duration(); time += 0.1) {
      const RobotState state = drive.At(time);
      nearest = std::min(
          nearest, standing[state.floor].Clearance(state.T_building_robot.Translation(), 1.0));
    }
    EXPECT_GE(nearest, options.robot_radius) << "m, seed " << seed;
  }
}

TEST(RandomBuilding, SameSeedSameBuilding) {
  EXPECT_EQ(WriteBuilding(RandomBuilding(7)), WriteBuilding(RandomBuilding(7)));
  EXPECT_NE(WriteBuilding(RandomBuilding(7)), WriteBuilding(RandomBuilding(8)));
}

}  // namespace
}  // namespace masked_mapper
