// SPDX-License-Identifier: BSD-3-Clause
#include "localization/map_changes.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

/// Of a robot that looks along x at a wall, beam by beam.
LaserScan Facing(double wall_x, const Pose2& T_world_robot) {
  LaserScan scan;
  scan.first_angle = -0.4;
  scan.angle_step = 0.01;
  scan.max_range = 30.0F;
  for (std::size_t beam = 0; beam <= 80; ++beam) {
    scan.ranges.push_back(
        static_cast<float>((wall_x - T_world_robot.x) / std::cos(scan.Angle(beam))));
  }
  return scan;
}

Pose2 PoseAt(int i) { return {0.5 * i, 0.0, 0.0}; }

/// A map of a wall, as a robot saw it that drove towards it.
class ChangeFinderTest : public testing::Test {
 protected:
  void MapWalls(const std::vector<double>& walls_x) {
    for (std::size_t i = 0; i < walls_x.size(); ++i) {
      scans_.push_back(Facing(walls_x[i], PoseAt(static_cast<int>(i))));
    }
    for (std::size_t i = 0; i < walls_x.size(); ++i) {
      posed_.push_back({PoseAt(static_cast<int>(i)), 0, &scans_[i]});
    }
  }
  SearchableFloor MappedFloor() const {
    SearchableFloorOptions options;
    options.seen.resolution_m = 0.2;
    options.seen.min_hits = 1;
    return {posed_, 0, options};
  }
  std::vector<MapChange> Found(const ChangeFinder& finder) const {
    return finder.Find([&](FloorId) -> const std::vector<PosedScan>& { return posed_; });
  }

  std::vector<LaserScan> scans_;
  std::vector<PosedScan> posed_;
};

TEST_F(ChangeFinderTest, TellsAWallThatIsNewAndOneThatIsGone) {
  MapWalls(std::vector<double>(6, 8.0));
  const SearchableFloor floor = MappedFloor();
  ChangeFinder same;
  for (int i = 0; i < 6; ++i) same.Observe(scans_[static_cast<std::size_t>(i)], floor, PoseAt(i));
  EXPECT_TRUE(Found(same).empty());

  ChangeFinder nearer;
  for (int i = 0; i < 6; ++i) nearer.Observe(Facing(5.0, PoseAt(i)), floor, PoseAt(i));
  const std::vector<MapChange> changes = Found(nearer);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, ChangeKind::kNew);
  EXPECT_NEAR(changes[0].x, 5.0, 0.3);

  ChangeFinder farther;
  for (int i = 4; i < 12; ++i) farther.Observe(Facing(12.0, PoseAt(i)), floor, PoseAt(i));
  ASSERT_FALSE(Found(farther).empty());
  EXPECT_EQ(Found(farther)[0].kind, ChangeKind::kGone);
  EXPECT_NEAR(Found(farther)[0].x, 8.0, 0.3);
}

// Glass: beams of the map went through it as well.
TEST_F(ChangeFinderTest, WhatTheMapSawThroughItselfIsNotGone) {
  std::vector<double> walls_x;
  for (int i = 0; i < 10; ++i) walls_x.push_back(i % 2 == 0 ? 8.0 : 12.0);
  MapWalls(walls_x);
  const SearchableFloor floor = MappedFloor();
  ChangeFinder through;
  for (int i = 0; i < 10; ++i) through.Observe(Facing(12.0, PoseAt(i)), floor, PoseAt(i));
  EXPECT_TRUE(Found(through).empty());
}

}  // namespace
}  // namespace masked_mapper
