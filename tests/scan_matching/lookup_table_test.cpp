// SPDX-License-Identifier: BSD-3-Clause
#include "scan_matching/lookup_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scan_matching/drawn_room.hpp"

namespace masked_mapper {
namespace {

// The header's words, cell by cell: maxima over the span of a coarse cell.
std::uint8_t PlainMaximum(const LookupTable& table, int level, TableCell cell) {
  const std::int32_t first_x = cell.x * (1 << level);
  const std::int32_t first_y = cell.y * (1 << level);
  const std::int32_t span = 2 * (1 << level) - 1;
  std::uint8_t maximum = 0;
  for (std::int32_t y = first_y; y < first_y + span; ++y) {
    for (std::int32_t x = first_x; x < first_x + span; ++x) {
      maximum = std::max(maximum, table.Value(0, {x, y}));
    }
  }
  return maximum;
}

void ExpectPyramidIsPlainMaxima(const LookupTable& table) {
  for (int l = 0; l < table.levels(); ++l) {
    const LookupTable::Level& level = table.level(l);
    for (std::int32_t y = level.y0 - 3; y < level.y0 + level.height + 3; ++y) {
      for (std::int32_t x = level.x0 - 3; x < level.x0 + level.width + 3; ++x) {
        ASSERT_EQ(table.Value(l, {x, y}), PlainMaximum(table, l, {x, y}))
            << "level " << l << " cell " << x << ", " << y;
      }
    }
  }
}

ScanPoints RandomPoints(int count, double reach, std::mt19937* random) {
  std::vector<std::pair<double, double>> coordinates;
  for (int i = 0; i < count; ++i) {
    coordinates.push_back({Uniform(-reach, reach, random), Uniform(-reach, reach, random)});
  }
  return Points(coordinates);
}

TEST(LookupTable, HoldsTheBlurOfTheNearestPoint) {
  std::mt19937 random(1);
  LookupTableOptions options;
  options.join_gap_m = 0.0;
  for (const double sigma : {0.03, 0.1, 0.17}) {
    options.sigma_m = sigma;
    const ScanPoints points = RandomPoints(25, 1.5, &random);
    const LookupTable table(points, options);
    // Points are rounded to 1/8 of a cell, at most 1/16 off in both directions.
    const double rounding = options.resolution_m / 16.0 * std::sqrt(2.0);
    for (int y = -45; y < 45; ++y) {
      for (int x = -45; x < 45; ++x) {
        double nearest = 1e9;
        for (const pcl::PointXY& point : points) {
          nearest = std::min(nearest, std::hypot((x + 0.5) * options.resolution_m - point.x,
                                                 (y + 0.5) * options.resolution_m - point.y));
        }
        const auto fit = [&](double d) { return 255.0 * std::exp(-d * d / (2 * sigma * sigma)); };
        const double value = table.Value(0, {x, y});
        EXPECT_LE(value, fit(std::max(0.0, nearest - rounding)) + 0.51);
        if (nearest < 3.0 * sigma - rounding) {
          EXPECT_GE(value, fit(nearest + rounding) - 0.51) << x << ", " << y << ", " << nearest;
        }
      }
    }
  }
}

TEST(LookupTable, PyramidIsPlainMaxima) {
  std::mt19937 random(2);
  LookupTableOptions options;
  for (const double reach : {0.01, 0.2, 0.8, 3.0}) {
    for (const double sigma : {0.0, 0.02, 0.1}) {
      for (const int levels : {1, 2, 4, 7}) {
        options.sigma_m = sigma;
        options.levels = levels;
        const ScanPoints points = RandomPoints(12, reach, &random);
        ExpectPyramidIsPlainMaxima(LookupTable(points, options));
      }
    }
  }
}

TEST(LookupTable, CoarseLevelsBoundEverySumOfPointAndOffset) {
  std::mt19937 random(3);
  LookupTableOptions options;
  const LookupTable table(RandomPoints(30, 1.0, &random), options);
  std::uniform_int_distribution<std::int32_t> cell(-60, 60);
  for (int i = 0; i < 100000; ++i) {
    const TableCell point{cell(random), cell(random)};
    const TableCell offset{cell(random), cell(random)};
    const int fine = table.Value(0, {point.x + offset.x, point.y + offset.y});
    for (int level = 1; level < table.levels(); ++level) {
      const TableCell coarse{(point.x >> level) + (offset.x >> level),
                             (point.y >> level) + (offset.y >> level)};
      ASSERT_LE(fine, table.Value(level, coarse));
    }
  }
}

TEST(LookupTable, HasNoLevelsThatDwarfIt) {
  LookupTableOptions options;
  options.levels = 60;
  const LookupTable table(Points({{0.0, 0.0}, {2.0, 1.0}}), options);
  EXPECT_GE(table.levels(), 5);
  EXPECT_LE(table.levels(), 8);
  EXPECT_LT(table.MemoryBytes(), 200000U);
  ExpectPyramidIsPlainMaxima(table);
}

TEST(LookupTable, IsTheSameAtAnyNumberOfThreads) {
  std::mt19937 random(8);
  LookupTableOptions options;
  options.join_gap_m = 0.5;
  const ScanPoints points = RandomPoints(9000, 4.0, &random);
  const BlurKernels kernels(options);
  const LookupTable alone(points, options, kernels);
  for (const int threads : {2, 3, 16}) {
    const LookupTable shared(points, options, kernels, threads);
    const LookupTable::Level& level = shared.level(0);
    for (std::int32_t y = level.y0; y < level.y0 + level.height; ++y) {
      for (std::int32_t x = level.x0; x < level.x0 + level.width; ++x) {
        ASSERT_EQ(shared.Value(0, {x, y}), alone.Value(0, {x, y})) << threads << " threads";
      }
    }
  }
}

TEST(LookupTable, WithoutPointsEverythingIsZero) {
  const LookupTable table(ScanPoints{}, LookupTableOptions{});
  ExpectPyramidIsPlainMaxima(table);
  EXPECT_EQ(table.Value(0, {0, 0}), 0);
}

TEST(LookupTable, LeavesOutWhatIsNotFiniteOrTooFar) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  LookupTableOptions options;
  const LookupTable table(Points({{nan, 0}, {0, inf}, {1e30, 0}, {31, 0}, {1.01, 1.01}}), options);
  EXPECT_GT(table.Value(0, table.CellAt(1.01, 1.01)), 200);
  EXPECT_EQ(table.Value(0, table.CellAt(31, 0)), 0);
  EXPECT_LT(table.MemoryBytes(), 100000U);
}

TEST(LookupTable, WithinBoundsEqualsTheWholeTable) {
  std::mt19937 random(4);
  LookupTableOptions options;
  const BlurKernels kernels(options);
  ScanPoints points = RandomPoints(60, 2.0, &random);
  points.push_back(Points({{1e9, 5.0}})[0]);
  const LookupTable whole(points, options, kernels);
  const TableBounds bounds{-1.0, -0.5, 0.6, 0.7};
  const LookupTable part(points, bounds, options, kernels);
  const TableCell low = part.CellAt(bounds.min_x, bounds.min_y);
  const TableCell high = part.CellAt(bounds.max_x, bounds.max_y);
  for (std::int32_t y = low.y; y <= high.y; ++y) {
    for (std::int32_t x = low.x; x <= high.x; ++x) {
      EXPECT_EQ(part.Value(0, {x, y}), whole.Value(0, {x, y}));
    }
  }
  ExpectPyramidIsPlainMaxima(part);
  const LookupTable none(points, TableBounds{1.0, 1.0, 1.0, 1.0}, options, kernels);
  EXPECT_EQ(none.Value(0, {0, 0}), 0);
}

TEST(LookupTable, JoinsNeighboursAcrossSmallGapsOnly) {
  LookupTableOptions options;
  options.join_gap_m = 0.3;
  const LookupTable joined(Points({{0.0, 0.025}, {0.28, 0.025}}), options);
  for (double x = 0.0; x <= 0.28; x += 0.05) {
    EXPECT_GE(joined.Value(0, joined.CellAt(x, 0.025)), 235) << x;
  }
  const LookupTable apart(Points({{0.0, 0.025}, {0.4, 0.025}}), options);
  EXPECT_LT(apart.Value(0, apart.CellAt(0.21, 0.025)), 60);
}

}  // namespace
}  // namespace masked_mapper
