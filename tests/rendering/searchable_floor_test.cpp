// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/searchable_floor.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

/// A robot at the origin that faces a wall 5 m ahead.
LaserScan Wall() {
  LaserScan scan;
  scan.first_angle = -0.5;
  scan.angle_step = 0.01;
  scan.max_range = 30.0F;
  for (std::size_t beam = 0; beam <= 100; ++beam) {
    scan.ranges.push_back(static_cast<float>(5.0 / std::cos(scan.Angle(beam))));
  }
  return scan;
}

TEST(SearchableFloor, KnowsItsWallsAndWhatItNeverSaw) {
  const LaserScan scan = Wall();
  SearchableFloorOptions options;
  options.seen.resolution_m = 0.2;
  options.seen.min_hits = 1;
  const SearchableFloor floor({{{}, 3, &scan}}, 3, options);
  ASSERT_TRUE(floor.HasFloor());
  EXPECT_EQ(floor.floor(), 3);
  EXPECT_GT(floor.fine().ValueAt({5.0, 0.5}), 0.7);
  EXPECT_EQ(floor.fine().ValueAt({3.0, 0.0}), 0.0);
  EXPECT_TRUE(floor.IsSeen({3.0, 0.0}));
  EXPECT_FALSE(floor.IsSeen({-3.0, 0.0}));
  EXPECT_FALSE(floor.IsSeen({1e6, 0.0}));
}

TEST(SearchableFloor, WithoutScansNothingIsFound) {
  const LaserScan scan = Wall();
  const SearchableFloor of_another({{{}, 3, &scan}}, 4, {});
  EXPECT_FALSE(of_another.HasFloor());
  EXPECT_FALSE(of_another.IsSeen({3.0, 0.0}));
}

}  // namespace
}  // namespace masked_mapper
