// SPDX-License-Identifier: BSD-3-Clause
#include "export/wall_cloud.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(WallCloud, OnePointPerWallCellAtTheElevation) {
  OccupancyGrid grid;
  grid.walls = {{1.5F, -2.0F}, {3.25F, 4.0F}};
  const auto cloud = WallCloud(grid, -3.5, 7);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud[1].x, 3.25F);
  EXPECT_EQ(cloud[1].y, 4.0F);
  EXPECT_EQ(cloud[1].z, -3.5F);
  EXPECT_EQ(cloud[1].label, 7U);
  EXPECT_TRUE(WallCloud({}, 0.0, 0).empty());
}

}  // namespace
}  // namespace masked_mapper
