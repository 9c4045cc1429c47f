// SPDX-License-Identifier: BSD-3-Clause
#include "routing/floor_paths.hpp"

#include <gtest/gtest.h>

#include <random>

#include "routing/drawn_grid.hpp"

namespace masked_mapper {
namespace {

double LengthOfCells(const std::vector<GridCell>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    length += std::hypot(way[i].column - way[i - 1].column, way[i].row - way[i - 1].row);
  }
  return length;
}

/// Every cell against every other: the shortest way there is from cell to cell, in cells.
std::vector<double> ByAllThatSeeEachOther(const FreeSpace& space, const GridCell& start) {
  const auto cells = static_cast<std::size_t>(space.width() * space.height());
  std::vector<double> length(cells, 1e18);
  std::vector<bool> is_done(cells);
  length[space.IndexOf(start)] = 0.0;
  for (;;) {
    std::size_t at = cells;
    for (std::size_t i = 0; i < cells; ++i) {
      if (!is_done[i] && length[i] < 1e17 && (at == cells || length[i] < length[at])) at = i;
    }
    if (at == cells) return length;
    is_done[at] = true;
    const GridCell here = space.CellOf(at);
    for (std::size_t next = 0; next < cells; ++next) {
      const GridCell there = space.CellOf(next);
      const double longer =
          length[at] + std::hypot(here.column - there.column, here.row - there.row);
      if (!is_done[next] && longer < length[next] && space.Sees(here, there)) length[next] = longer;
    }
  }
}

TEST(FloorPaths, AreShortestAmongRandomWalls) {
  std::mt19937 random(5);
  double worst = 1.0;
  double sum = 0.0;
  int count = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const unsigned side = 26;
    std::vector<std::string> lines(side, std::string(side, '.'));
    for (int i = 0; i < 9; ++i) {  // walls, upright and level
      const auto column = static_cast<unsigned>(random() % side);
      const auto row = static_cast<unsigned>(random() % side);
      const bool upright = random() % 2 == 0;
      for (unsigned j = 0; j < 9; ++j) {
        lines[std::min(side - 1, upright ? row + j : row)]
             [std::min(side - 1, upright ? column : column + j)] = '#';
      }
    }
    const FreeSpace space(DrawnGrid(lines), {}, {}, {0.05, 0.0});
    const auto start = space.NearestPassable({1.3, 1.3}, 2.0);
    ASSERT_TRUE(start);
    std::vector<GridCell> targets;
    for (std::size_t i = 0; i < side * side; ++i) {
      if (space.IsPassable(space.CellOf(i))) targets.push_back(space.CellOf(i));
    }
    const FloorPaths paths(space, *start, targets);
    const std::vector<double> shortest = ByAllThatSeeEachOther(space, *start);
    for (const GridCell& target : targets) {
      const auto way = paths.WayTo(target);
      ASSERT_EQ(way.has_value(), shortest[space.IndexOf(target)] < 1e17);
      if (!way || way->size() < 2) continue;
      for (std::size_t i = 1; i < way->size(); ++i)
        EXPECT_TRUE(space.Sees((*way)[i - 1], (*way)[i]));
      const double ratio = LengthOfCells(*way) / shortest[space.IndexOf(target)];
      EXPECT_GT(ratio, 1.0 - 1e-5);
      worst = std::max(worst, ratio);
      sum += ratio;
      ++count;
    }
  }
  EXPECT_GT(count, 3000);
  EXPECT_LT(worst, 1.02);
  EXPECT_LT(sum / count, 1.001);
}

TEST(FloorPaths, SayWhenThereIsNoWayAndWhatIsNearest) {
  const FreeSpace space(DrawnGrid({".....#.....",  //
                                   ".....#.....",  //
                                   ".....#....."}),
                        {}, {}, {0.05, 0.0});
  const FloorPaths paths(space, {0, 1}, {{10, 1}});
  EXPECT_FALSE(paths.WayTo({10, 1}));
  EXPECT_TRUE(paths.Reaches({4, 0}));
  EXPECT_EQ(paths.NearestReached({1.05, 0.15}).column, 4);
  const FloorPaths everywhere(space, {0, 1}, {});
  EXPECT_TRUE(everywhere.Reaches({4, 2}));
}

TEST(FloorPaths, FromAPlaceToItselfIsNoWay) {
  const FreeSpace space(DrawnGrid({"..."}), {}, {}, {0.05, 0.0});
  const FloorPaths paths(space, {1, 0}, {{1, 0}});
  ASSERT_TRUE(paths.WayTo({1, 0}));
  EXPECT_EQ(paths.WayTo({1, 0})->size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
