// SPDX-License-Identifier: BSD-3-Clause
#include "scan_matching/cell_slots.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

namespace masked_mapper {
namespace {

TEST(CellSlots, AreThoseOfAMap) {
  constexpr int kWidth = 37;  // no whole number of tiles
  CellSlots slots(kWidth);
  std::map<std::pair<int, int>, std::size_t> expected;
  std::mt19937 random(7);
  std::uniform_int_distribution<int> any(0, kWidth - 1);
  for (int i = 0; i < 500; ++i) {
    const CellSlots::Cell cell{any(random), any(random)};
    const auto slot = expected.emplace(std::pair(cell.column, cell.row), expected.size()).first;
    EXPECT_EQ(slots.Use(cell), slot->second);
  }
  ASSERT_EQ(slots.size(), expected.size());
  CellSlots taken(kWidth);
  ASSERT_TRUE(taken.Take(slots.cells()));
  for (int row = 0; row < kWidth; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const auto found = expected.find({column, row});
      const std::int32_t slot = slots.SlotOf({column, row});
      EXPECT_EQ(taken.SlotOf({column, row}), slot);
      if (found == expected.end()) {
        EXPECT_EQ(slot, -1);
        continue;
      }
      ASSERT_EQ(slot, static_cast<std::int32_t>(found->second));
      EXPECT_EQ(slots.CellOf(found->second).column, column);
      EXPECT_EQ(slots.CellOf(found->second).row, row);
    }
  }
}

TEST(CellSlots, TakeNoCellsOfAnotherGrid) {
  CellSlots slots(5);
  EXPECT_TRUE(slots.Take({}));
  EXPECT_TRUE(slots.Take({24, 0}));
  EXPECT_FALSE(slots.Take({25}));
  EXPECT_FALSE(slots.Take({-1}));
  EXPECT_FALSE(slots.Take({3, 4, 3}));
}

}  // namespace
}  // namespace masked_mapper
