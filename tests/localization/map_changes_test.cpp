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

TEST(ChangeFinder, TellsAWallThatIsNewAndOneThatIsGone) {
  const auto pose = [](int i) { return Pose2{0.5 * i, 0.0, 0.0}; };
  std::vector<LaserScan> scans;
  for (int i = 0; i < 6; ++i) scans.push_back(Facing(8.0, pose(i)));
  std::vector<PosedScan> posed;
  for (int i = 0; i < 6; ++i) posed.push_back({pose(i), 0, &scans[static_cast<std::size_t>(i)]});
  SearchableFloorOptions options;
  options.seen.resolution_m = 0.2;
  options.seen.min_hits = 1;
  const SearchableFloor floor(posed, 0, options);

  ChangeFinder same;
  for (int i = 0; i < 6; ++i) same.Observe(scans[static_cast<std::size_t>(i)], floor, pose(i));
  EXPECT_TRUE(same.Find().empty());

  ChangeFinder nearer;
  for (int i = 0; i < 6; ++i) nearer.Observe(Facing(5.0, pose(i)), floor, pose(i));
  const std::vector<MapChange> changes = nearer.Find();
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, ChangeKind::kNew);
  EXPECT_NEAR(changes[0].x, 5.0, 0.3);

  ChangeFinder farther;
  for (int i = 4; i < 12; ++i) farther.Observe(Facing(12.0, pose(i)), floor, pose(i));
  ASSERT_FALSE(farther.Find().empty());
  EXPECT_EQ(farther.Find()[0].kind, ChangeKind::kGone);
  EXPECT_NEAR(farther.Find()[0].x, 8.0, 0.3);
}

}  // namespace
}  // namespace masked_mapper
