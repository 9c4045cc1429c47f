// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <set>

namespace masked_mapper {
namespace {

const std::vector<Eigen::Vector2d> kL = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};

TEST(Polygon, KnowsInsideFromOutside) {
  EXPECT_TRUE(IsInsidePolygon(kL, {0.5, 2.5}));
  EXPECT_TRUE(IsInsidePolygon(kL, {2.5, 0.5}));
  EXPECT_FALSE(IsInsidePolygon(kL, {2.0, 2.0}));
  EXPECT_FALSE(IsInsidePolygon(kL, {-0.1, 0.5}));
  EXPECT_FALSE(IsInsidePolygon({}, {0.0, 0.0}));
  EXPECT_FALSE(IsInsidePolygon({{0, 0}, {1, 1}}, {0.5, 0.5}));
}

TEST(Polygon, WhatLiesOnASharedSideIsInOneOfTwo) {
  const std::vector<Eigen::Vector2d> left = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Eigen::Vector2d> right = {{1, 0}, {2, 0}, {2, 1}, {1, 1}};
  EXPECT_NE(IsInsidePolygon(left, {1.0, 0.5}), IsInsidePolygon(right, {1.0, 0.5}));
}

TEST(Polygon, VisitsTheCellsWhoseCentresAreInside) {
  std::set<std::size_t> cells;
  const int width = 8;
  ForEachCellInside(kL, {-1.0, -1.0}, 0.5, width, 5, [&](std::size_t cell) { cells.insert(cell); });
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < width; ++column) {
      const bool is_inside = IsInsidePolygon(kL, {-0.75 + 0.5 * column, -0.75 + 0.5 * row});
      EXPECT_EQ(cells.count(static_cast<std::size_t>(row * width + column)), is_inside ? 1U : 0U);
    }
  }
  ForEachCellInside({{-1e9, -1e9}, {1e9, -1e9}, {0, 1e9}}, {0, 0}, 1.0, 3, 2,
                    [&](std::size_t cell) { cells.insert(100 + cell); });
  EXPECT_EQ(cells.count(105), 1U);
}

}  // namespace
}  // namespace masked_mapper
