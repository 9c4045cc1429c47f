// SPDX-License-Identifier: BSD-3-Clause
#include "routing/free_space.hpp"

#include <gtest/gtest.h>

#include <random>

#include "routing/distance_field.hpp"
#include "routing/drawn_grid.hpp"

namespace masked_mapper {
namespace {

TEST(DistanceField, IsThatOfTryingAll) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {23, 17}}) {
    for (const int one_in : {2, 20, 400}) {
      std::vector<std::uint8_t> marked(static_cast<std::size_t>(width * height));
      for (auto& mark : marked) mark = random() % static_cast<unsigned>(one_in) == 0 ? 1 : 0;
      const std::vector<float> field = DistanceField(marked, width);
      for (int i = 0; i < width * height; ++i) {
        double nearest = kNoneMarked;
        for (int j = 0; j < width * height; ++j) {
          if (marked[static_cast<std::size_t>(j)] == 0) continue;
          nearest = std::min(nearest, std::hypot(i % width - j % width, i / width - j / width));
        }
        EXPECT_NEAR(field[static_cast<std::size_t>(i)], nearest, 1e-4 * nearest);
      }
    }
  }
}

TEST(FreeSpace, KeepsTheRadiusFromWalls) {
  const FreeSpace space(DrawnGrid({"#########",  //
                                   "#.......#",  //
                                   "#.......#",  //
                                   "#.......#",  //
                                   "#########"}),
                        {}, {}, {0.2, 0.0});
  EXPECT_TRUE(space.IsPassable({4, 2}));
  EXPECT_FALSE(space.IsPassable({4, 1}));
  EXPECT_FALSE(space.IsPassable({1, 2}));
  EXPECT_TRUE(space.IsPassable({2, 2}));
  EXPECT_FALSE(space.IsPassable({-1, 2}));
}

TEST(FreeSpace, UnknownIsNotFreeButForSpecks) {
  const FreeSpace space(DrawnGrid({".........",  //
                                   "...?.....",  //
                                   ".......??",  //
                                   "?????????"}),
                        {}, {}, {0.1, 0.0});
  EXPECT_TRUE(space.IsPassable({3, 2}));   // a speck
  EXPECT_FALSE(space.IsPassable({7, 1}));  // goes on beyond
  EXPECT_FALSE(space.IsPassable({4, 0}));
}

TEST(FreeSpace, WhereARobotDroveOneNoLargerPasses) {
  const std::vector<std::string> shut_door = {"####",  //
                                              "....",  //
                                              "##.#",  //
                                              "....",  //
                                              "####"};
  const std::vector<FreeSpace::Points> driven = {{{0.25, 0.15}, {0.25, 0.35}}};
  EXPECT_FALSE(FreeSpace(DrawnGrid(shut_door), {}, {}, {0.15, 0.3}).IsPassable({2, 2}));
  EXPECT_TRUE(FreeSpace(DrawnGrid(shut_door), driven, {}, {0.3, 0.3}).IsPassable({2, 2}));
  EXPECT_FALSE(FreeSpace(DrawnGrid(shut_door), driven, {}, {0.31, 0.3}).IsPassable({2, 2}));
  const std::vector<FreeSpace::Points> area = {{{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.5}, {0.0, 0.5}}};
  EXPECT_FALSE(FreeSpace(DrawnGrid(shut_door), driven, area, {0.3, 0.3}).IsPassable({2, 2}));
  // A pose that no grid reaches is of no consequence.
  EXPECT_FALSE(FreeSpace(DrawnGrid(shut_door), {{{1e300, -1e300}, {0.0, 1e300}}}, {}, {0.3, 0.3})
                   .IsPassable({2, 2}));
}

TEST(FreeSpace, SeesWhatNothingHides) {
  std::mt19937 random(3);
  const int side = 40;
  std::vector<std::string> lines(side, std::string(side, '.'));
  for (int i = 0; i < 60; ++i) lines[random() % side][random() % side] = '#';
  const FreeSpace space(DrawnGrid(lines), {}, {}, {0.05, 0.0});
  int seen = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&] { return static_cast<int>(random() % side); };
    const GridCell a{any(), any()};
    const GridCell b{any(), any()};
    // By many points of the line; what only touches a corner may be either.
    bool is_clear = true;
    bool is_hidden = false;
    for (int step = 0; step <= 2000; ++step) {
      const double x = a.column + 0.5 + (b.column - a.column) * step / 2000.0;
      const double y = a.row + 0.5 + (b.row - a.row) * step / 2000.0;
      const double slack = 0.02;
      const auto is_free = [&](double right, double up) {
        return space.IsPassable(
            {static_cast<int>(std::floor(x + right)), static_cast<int>(std::floor(y + up))});
      };
      const int open = static_cast<int>(is_free(slack, slack)) + is_free(-slack, slack) +
                       is_free(slack, -slack) + is_free(-slack, -slack);
      if (open < 4) is_clear = false;
      if (open == 0) is_hidden = true;
    }
    if (is_clear) {
      EXPECT_TRUE(space.Sees(a, b));
    }
    if (is_hidden) {
      EXPECT_FALSE(space.Sees(a, b));
    }
    seen += is_clear ? 1 : 0;
  }
  EXPECT_GT(seen, 500);
}

TEST(FreeSpace, FindsTheNearestPlaceThatTheRobotTouchesFrom) {
  const FreeSpace space(DrawnGrid({"#######",  //
                                   "#.....#",  //
                                   "#.....#",  //
                                   "#.....#",  //
                                   "#######"}),
                        {}, {}, {0.2, 0.0});
  const auto cell = space.NearestPassable({0.15, 0.25}, 0.2);
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->column, 2);
  EXPECT_EQ(cell->row, 2);
  EXPECT_FALSE(space.NearestPassable({-0.5, 0.25}, 0.2));
  EXPECT_FALSE(space.NearestPassable({1e7, -1e7}, 0.2));
  EXPECT_FALSE(FreeSpace(OccupancyGrid{}, {}, {}, {}).NearestPassable({0.0, 0.0}, 1.0));
}

}  // namespace
}  // namespace masked_mapper
