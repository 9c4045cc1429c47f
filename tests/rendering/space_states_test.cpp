// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/space_votes.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

SpaceStates States() {
  std::vector<SpaceBlock> blocks(2);
  blocks[0].at = {-1, 0, 0};
  blocks[0].cells[PlaceInBlock({-1, 0, 3})] = Cell::kFree;
  blocks[0].cells[PlaceInBlock({-1, 0, 9})] = Cell::kOccupied;
  blocks[0].cells[PlaceInBlock({-2, 1, 3})] = Cell::kFree;
  blocks[1].at = {0, 0, 1};
  blocks[1].cells[PlaceInBlock({5, 6, 18})] = Cell::kOccupied;
  return {0.1, std::move(blocks)};
}

TEST(SpaceStatesTest, TellsVoxelsOnBothSidesOfTheOrigin) {
  const SpaceStates states = States();
  EXPECT_EQ(states.At({-1, 0, 9}), Cell::kOccupied);
  EXPECT_EQ(states.At({-1, 0, 3}), Cell::kFree);
  EXPECT_EQ(states.At({5, 6, 18}), Cell::kOccupied);
  EXPECT_EQ(states.At({5, 6, 2}), Cell::kUnknown);
  EXPECT_EQ(states.At({100, -100, 7}), Cell::kUnknown);
  EXPECT_NE(KeyOfPlace({-1, 0, 0}), KeyOfPlace({0, -1, 0}));
  EXPECT_NE(KeyOfPlace({-1, 0, 0}), KeyOfPlace({0, 0, -1}));
}

TEST(SpaceStatesTest, AGridIsWhatStandsBetweenTwoHeights) {
  const SpaceStates states = States();
  const OccupancyGrid low = GridBetween(states, 0.1, 0.9);  // voxels 1 to 8
  EXPECT_DOUBLE_EQ(low.origin_x, -1.6);
  ASSERT_EQ(low.width, 32);
  ASSERT_EQ(low.height, 16);
  EXPECT_EQ(low.at(15, 0), Cell::kFree);
  EXPECT_EQ(low.at(14, 1), Cell::kFree);
  EXPECT_EQ(low.at(21, 6), Cell::kUnknown);
  const OccupancyGrid high = GridBetween(states, 0.1, 1.9);
  EXPECT_EQ(high.at(15, 0), Cell::kOccupied);
  EXPECT_EQ(high.at(21, 6), Cell::kOccupied);
  EXPECT_TRUE(GridBetween(SpaceStates(), 0.0, 1.0).cells.empty());
}

}  // namespace
}  // namespace masked_mapper
