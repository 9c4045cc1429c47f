// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

LaserScan ScanOf(std::vector<float> ranges, double first_angle, double step) {
  LaserScan scan;
  scan.first_angle = first_angle;
  scan.angle_step = step;
  scan.max_range = 20.0F;
  scan.ranges = std::move(ranges);
  return scan;
}

// A 181-beam scan taken in a rectangular room [0, width] x [0, height].
LaserScan ScanInRoom(const Pose2& pose, double width, double height) {
  std::vector<float> ranges;
  for (int beam = 0; beam <= 180; ++beam) {
    const double angle = pose.theta + DegToRad(beam - 90.0);
    const double to_x = (std::cos(angle) > 0 ? width - pose.x : -pose.x) / std::cos(angle);
    const double to_y = (std::sin(angle) > 0 ? height - pose.y : -pose.y) / std::sin(angle);
    ranges.push_back(static_cast<float>(std::min(std::abs(to_x), std::abs(to_y))));
  }
  return ScanOf(ranges, -kPi / 2, DegToRad(1.0));
}

struct Counts {
  int visits = 0;
  int hits = 0;
};
using CountsByCell = std::map<std::pair<long, long>, Counts>;

// The obvious way: each beam is sampled in floating point at the middle of every column (row)
// between its ends. Cells are counted from the world's origin.
CountsByCell CountNaively(const std::vector<PosedScan>& scans, const GridOptions& options) {
  CountsByCell counts;
  const auto cell = [](double coordinate) { return static_cast<long>(std::floor(coordinate)); };
  for (const PosedScan& posed : scans) {
    const Pose2 laser = posed.T_world_robot * posed.scan->T_robot_laser;
    for (std::size_t beam = 0; beam < posed.scan->size(); ++beam) {
      double range = posed.scan->ranges[beam];
      if (std::isnan(range)) continue;
      const bool hit = range < posed.scan->max_range && range <= options.max_usable_range_m;
      if (!(range < posed.scan->max_range)) range = options.free_range_without_return_m;
      range = std::min(range, options.max_usable_range_m);
      if (range <= 0.0) continue;
      const double angle = laser.theta + posed.scan->Angle(beam);
      const double x0 = laser.x / options.resolution_m;
      const double y0 = laser.y / options.resolution_m;
      const double x1 = x0 + range * std::cos(angle) / options.resolution_m;
      const double y1 = y0 + range * std::sin(angle) / options.resolution_m;
      std::vector<std::pair<long, long>> crossed;
      const bool flat = std::abs(x1 - x0) >= std::abs(y1 - y0);
      const long first = flat ? cell(std::min(x0, x1)) : cell(std::min(y0, y1));
      const long last = flat ? cell(std::max(x0, x1)) : cell(std::max(y0, y1));
      for (long step = first + 1; step < last; ++step) {
        const double middle = static_cast<double>(step) + 0.5;
        if (flat) {
          crossed.emplace_back(step, cell(y0 + (middle - x0) * (y1 - y0) / (x1 - x0)));
        } else {
          crossed.emplace_back(cell(x0 + (middle - y0) * (x1 - x0) / (y1 - y0)), step);
        }
      }
      const std::pair<long, long> from{cell(x0), cell(y0)};
      const std::pair<long, long> to{cell(x1), cell(y1)};
      if (from != to) crossed.push_back(from);
      crossed.push_back(to);
      for (const auto& place : crossed) ++counts[place].visits;
      if (hit) ++counts[to].hits;
    }
  }
  return counts;
}

Cell Classify(const Counts& counts, const GridOptions& options) {
  if (counts.visits == 0) return Cell::kUnknown;
  if (counts.hits == 0 || counts.hits < options.occupied_ratio * counts.visits) return Cell::kFree;
  return counts.hits >= options.min_hits ? Cell::kOccupied : Cell::kUnknown;
}

TEST(RenderGrid, EqualsPerBeamSampling) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 6; ++trial) {
    GridOptions options;
    options.resolution_m = trial % 2 == 0 ? 0.05 : 0.13;
    options.max_usable_range_m = 12.0;
    options.free_range_without_return_m = 8.0;
    options.min_hits = 1 + trial % 2;
    options.threads = 1 + trial % 3;
    std::vector<LaserScan> scans;
    std::vector<PosedScan> posed;
    for (int i = 0; i < 12; ++i) {
      std::vector<float> ranges;
      for (int beam = 0; beam < 90; ++beam) {
        const double kind = uniform(random);
        ranges.push_back(kind < 0.1   ? kNoReturn
                         : kind < 0.2 ? kInvalidRange
                                      : static_cast<float>(0.02 + 15.0 * uniform(random)));
      }
      scans.push_back(ScanOf(ranges, -kPi, DegToRad(4.0)));
      scans.back().T_robot_laser = {0.2, -0.1, 0.3};
    }
    for (const LaserScan& scan : scans) {
      posed.push_back(
          {{30.0 * uniform(random) - 15.0, 30.0 * uniform(random) - 15.0, 6.0 * uniform(random)},
           0,
           &scan});
    }
    const OccupancyGrid grid = RenderGrid(posed, 0, options);
    const CountsByCell counts = CountNaively(posed, options);
    const long column0 = std::lround(grid.origin_x / grid.resolution_m);
    const long row0 = std::lround(grid.origin_y / grid.resolution_m);
    int different = 0;
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        const auto found = counts.find({column0 + column, row0 + row});
        const Counts expected = found == counts.end() ? Counts{} : found->second;
        if (grid.at(column, row) != Classify(expected, options)) ++different;
      }
    }
    // Only samples within rounding of a cell's edge may fall on the other side.
    EXPECT_LE(different, static_cast<int>(counts.size() / 1000)) << "trial " << trial;
    for (const auto& [place, count] : counts) {
      EXPECT_GE(place.first, column0);
      EXPECT_GE(place.second, row0);
      EXPECT_LT(place.first, column0 + grid.width);
      EXPECT_LT(place.second, row0 + grid.height);
    }
  }
}

TEST(RenderGrid, RoomHasWallsWhereTheyStand) {
  // The room stands inside cells, not on their edges.
  const Pose2 T_world_room{0.02, -0.03, 0.0};
  std::vector<LaserScan> scans;
  std::vector<PosedScan> posed;
  std::vector<Pose2> poses;
  for (int i = 0; i < 40; ++i) poses.push_back({1.0 + 0.1 * i, 2.013, DegToRad(13.0 * i)});
  for (const Pose2& pose : poses) scans.push_back(ScanInRoom(pose, 6.0, 4.0));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    posed.push_back({T_world_room * poses[i], 3, &scans[i]});
  }
  const OccupancyGrid grid = RenderGrid(posed, 3, {});
  for (const WallPoint& wall : grid.walls) {
    const double x = wall.x - T_world_room.x;
    const double y = wall.y - T_world_room.y;
    const double off = std::min({std::abs(x), std::abs(x - 6.0), std::abs(y), std::abs(y - 4.0)});
    const bool in_corner = std::abs(std::abs(x - 3.0) - std::abs(y - 2.0) - 1.0) < 0.05;
    EXPECT_LT(off, in_corner ? 0.03 : 0.001) << "m off the wall at " << x << ", " << y;
  }
  EXPECT_NEAR(KnownArea(grid), 6.0 * 4.0, 0.6);
  // Walls are one cell thin: as many occupied cells as the perimeter has.
  EXPECT_NEAR(static_cast<double>(grid.walls.size()), 2 * (6.0 + 4.0) / 0.05, 10.0);
}

TEST(RenderGrid, SameAtAnyNumberOfThreads) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-40.0, 40.0);
  std::vector<LaserScan> scans(60, ScanInRoom({3.0, 2.0, 0.5}, 6.0, 4.0));
  std::vector<PosedScan> posed;
  for (const LaserScan& scan : scans) {
    posed.push_back({{uniform(random), uniform(random), uniform(random)}, 0, &scan});
  }
  GridOptions options;
  const OccupancyGrid one = RenderGrid(posed, 0, options);
  ASSERT_GT(one.height, 1000);  // several bands
  for (int threads : {2, 5}) {
    options.threads = threads;
    const OccupancyGrid many = RenderGrid(posed, 0, options);
    EXPECT_EQ(one.cells, many.cells);
    ASSERT_EQ(one.walls.size(), many.walls.size());
    for (std::size_t i = 0; i < one.walls.size(); ++i) {
      EXPECT_EQ(one.walls[i].x, many.walls[i].x);
      EXPECT_EQ(one.walls[i].y, many.walls[i].y);
    }
  }
}

TEST(RenderGrid, WallsFollowTheOrderOfCells) {
  const LaserScan scan = ScanInRoom({3.0, 2.0, 0.5}, 6.0, 4.0);
  GridOptions options;
  options.min_hits = 1;
  const OccupancyGrid grid = RenderGrid({{{3.0, 2.0, 0.5}, 0, &scan}}, 0, options);
  std::size_t wall = 0;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kOccupied) continue;
      ASSERT_LT(wall, grid.walls.size());
      EXPECT_NEAR(grid.walls[wall].x, grid.origin_x + (column + 0.5) * 0.05, 0.0251);
      EXPECT_NEAR(grid.walls[wall].y, grid.origin_y + (row + 0.5) * 0.05, 0.0251);
      ++wall;
    }
  }
  EXPECT_EQ(wall, grid.walls.size());
}

TEST(RenderGrid, PersonWhoPassesIsCleared) {
  const LaserScan empty_room = ScanInRoom({3.0, 2.0, 0.0}, 6.0, 4.0);
  LaserScan with_person = empty_room;
  for (std::size_t beam = 85; beam < 96; ++beam) with_person.ranges[beam] = 1.5F;
  std::vector<PosedScan> posed(20, PosedScan{{3.0, 2.0, 0.0}, 0, &empty_room});
  posed.push_back({{3.0, 2.0, 0.0}, 0, &with_person});
  posed.push_back({{3.0, 2.0, 0.0}, 0, &with_person});
  const OccupancyGrid grid = RenderGrid(posed, 0, {});
  const int column = static_cast<int>(std::floor((4.5 - grid.origin_x) / 0.05 + 1e-6));
  const int row = static_cast<int>(std::floor((2.0 - grid.origin_y) / 0.05 + 1e-6));
  EXPECT_EQ(grid.at(column, row), Cell::kFree);
}

TEST(RenderGrid, NothingToTellIsEmpty) {
  const LaserScan none = ScanOf({}, 0.0, 0.1);
  const LaserScan invalid = ScanOf(std::vector<float>(10, kInvalidRange), 0.0, 0.1);
  const LaserScan open = ScanOf(std::vector<float>(10, kNoReturn), 0.0, 0.1);
  EXPECT_TRUE(RenderGrid({}, 0, {}).cells.empty());
  EXPECT_TRUE(RenderGrid({{{}, 0, &none}, {{}, 0, &invalid}}, 0, {}).cells.empty());
  EXPECT_TRUE(RenderGrid({{{}, 0, &open}}, 0, {}).cells.empty());
  GridOptions options;
  options.free_range_without_return_m = 4.0;
  EXPECT_GT(KnownArea(RenderGrid({{{}, 0, &open}}, 0, options)), 0.0);
  EXPECT_TRUE(RenderGrid({{{}, 1, &open}}, 0, options).cells.empty());
  EXPECT_EQ(KnownArea(RenderGrid({}, 0, {})), 0.0);
}

TEST(RenderGrid, BeamWithinOneCell) {
  const LaserScan scan = ScanOf({0.01F}, 0.0, 0.1);
  GridOptions options;
  options.min_hits = 1;
  const OccupancyGrid grid = RenderGrid({{{0.02, 0.02, 0.0}, 0, &scan}}, 0, options);
  ASSERT_EQ(grid.cells.size(), 1U);
  EXPECT_EQ(grid.at(0, 0), Cell::kOccupied);
  EXPECT_NEAR(grid.walls[0].x, 0.03, 0.0002);
}

TEST(RenderGrid, TooLargeAFloorIsRefused) {
  const LaserScan scan = ScanOf({1.0F}, 0.0, 0.1);
  const PosedScan here{{}, 0, &scan};
  EXPECT_THROW(RenderGrid({here, {{5000.0, 5000.0, 0.0}, 0, &scan}}, 0, {}), InputError);
  EXPECT_THROW(RenderGrid({here, {{1e12, 0.0, 0.0}, 0, &scan}}, 0, {}), InputError);
  EXPECT_THROW(RenderGrid({here, {{std::nan(""), 0.0, 0.0}, 0, &scan}}, 0, {}), InputError);
}

TEST(RenderGrid, BeamsLongerThanSlopesAllowAreCut) {
  LaserScan scan = ScanOf({4000.0F, 4000.0F}, 0.0, 0.0001);
  scan.max_range = 5000.0F;
  GridOptions options;
  options.max_usable_range_m = 1e9;
  const OccupancyGrid grid = RenderGrid({{{}, 0, &scan}}, 0, options);
  EXPECT_EQ(grid.width, 16001);
  EXPECT_TRUE(grid.walls.empty());
}

// The wall at x = 4 m of a room is taken away, or one at 3 m is built before it.
TEST(OccupancyGrid, OfDrivesTheNewestIsBelievedWhereItSaw) {
  const auto pose = [](int i) { return Pose2{1.02 + 0.013 * i, 2.03 - 0.011 * i, 0.3}; };
  // Scans of the room as each drive found it; 0: the drive saw nothing.
  const auto drawn = [&](double second_width, int passes, bool forget) {
    std::vector<LaserScan> seen;
    for (int i = 0; i < 30; ++i) seen.push_back(ScanInRoom(pose(i), 4.0, 4.0));
    for (int i = 0; i < passes; ++i) {
      seen.push_back(ScanInRoom(pose(i), second_width, 4.0));
      if (second_width == 0.0) seen.back().ranges.assign(181, kInvalidRange);
    }
    std::vector<PosedScan> scans;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const bool is_first = i < 30;
      scans.push_back({pose(static_cast<int>(is_first ? i : i - 30)), 0, &seen[i],
                       is_first ? std::size_t{0} : std::size_t{1}});
    }
    GridOptions options;
    options.forget = forget;
    return RenderGrid(scans, 0, options);
  };
  const auto walls_at = [](const OccupancyGrid& grid, double x) {
    return std::count_if(grid.walls.begin(), grid.walls.end(), [&](const WallPoint& wall) {
      return std::abs(wall.x - x) < 0.051 && wall.y > 0.5 && wall.y < 3.5;
    });
  };
  const auto old_walls = walls_at(drawn(4.0, 1, false), 4.0);
  ASSERT_GT(old_walls, 50);
  EXPECT_GT(walls_at(drawn(6.0, 25, false), 4.0), old_walls / 2) << "not asked to forget";
  const OccupancyGrid seen_through = drawn(6.0, 25, true);
  EXPECT_EQ(walls_at(seen_through, 4.0), 0);
  EXPECT_GT(walls_at(seen_through, 6.0), 30);
  const OccupancyGrid built = drawn(3.0, 25, true);
  EXPECT_GT(walls_at(built, 3.0), 50);
  EXPECT_EQ(walls_at(built, 4.0), old_walls) << "what stands behind is not known to be gone";
  // Seen once, or not at all, is not enough.
  EXPECT_GE(walls_at(drawn(6.0, 1, true), 4.0), old_walls - 2);
  EXPECT_EQ(walls_at(drawn(0.0, 30, true), 4.0), old_walls);
  // One drive alone is drawn as ever.
  EXPECT_EQ(drawn(4.0, 0, true).cells, drawn(4.0, 0, false).cells);
}

}  // namespace
}  // namespace masked_mapper
