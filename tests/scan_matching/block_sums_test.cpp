// SPDX-License-Identifier: BSD-3-Clause
#include "scan_matching/block_sums.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scan_matching/drawn_room.hpp"

namespace masked_mapper {
namespace {

struct Scene {
  explicit Scene(int seed) : random(static_cast<unsigned>(seed)) {
    LookupTableOptions options;
    options.levels = 6;
    std::vector<std::pair<double, double>> reference;
    for (int i = 0; i < 40; ++i) reference.push_back({Draw(), Draw()});
    table = std::make_unique<LookupTable>(Points(reference), options);
    // Many points in few cells, so that they are merged and their sums outgrow 16 bits.
    for (int i = 0; i < 700; ++i) points.push_back({Draw(), 0.1 * Draw()});
    grid.T_reference_query_guess = {0.3, -0.2, 0.4};
    grid.angle_step = 0.05;
    grid.half_angle = 3;
    grid.half_x = 60;
    grid.half_y = 50;
  }

  double Draw() { return Uniform(-1.5, 1.5, &random); }

  // The sum of a grid pose, point by point.
  std::uint32_t PlainSum(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    Pose2 pose = grid.T_reference_query_guess;
    pose.theta += angle * grid.angle_step;
    std::uint32_t sum = 0;
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d in_reference = pose * point;
      const TableCell cell = table->CellAt(in_reference.x(), in_reference.y());
      sum += table->Value(0, {cell.x + x, cell.y + y});
    }
    return sum;
  }

  std::mt19937 random;
  std::unique_ptr<LookupTable> table;
  std::vector<Eigen::Vector2d> points;
  SearchGrid grid;
};

TEST(BlockSums, AreThePlainSumsAtTheFinestLevel) {
  Scene scene(1);
  BlockSums sums(*scene.table, scene.points, scene.grid);
  for (int i = 0; i < 100; ++i) {
    const std::int32_t angle = i % 7 - 3;
    const auto x = static_cast<std::int32_t>(40.0 * scene.Draw());
    const auto y = static_cast<std::int32_t>(40.0 * scene.Draw());
    for (const int size : {1, 2, 4, 8}) {
      const BlockSums::Sums block = sums.At(angle, 0, x, y, size);
      for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
          ASSERT_EQ(block[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                    scene.PlainSum(angle, x + column, y + row))
              << "angle " << angle << " x " << x + column << " y " << y + row;
        }
      }
    }
  }
}

TEST(BlockSums, CoarseSumsBoundAllPosesOfTheirBlock) {
  Scene scene(2);
  BlockSums sums(*scene.table, scene.points, scene.grid);
  std::uniform_int_distribution<std::int32_t> angles(-3, 3);
  std::uniform_int_distribution<std::int32_t> steps_x(-60, 60);
  std::uniform_int_distribution<std::int32_t> steps_y(-50, 50);
  for (int i = 0; i < 500; ++i) {
    const std::int32_t angle = angles(scene.random);
    const std::int32_t x = steps_x(scene.random);
    const std::int32_t y = steps_y(scene.random);
    const std::uint32_t fine = scene.PlainSum(angle, x, y);
    for (int level = 1; level < 6; ++level) {
      ASSERT_GE(sums.At(angle, level, x >> level, y >> level, 1)[0][0], fine) << "level " << level;
    }
  }
}

TEST(BlockSums, PointsFarAwayCountNothing) {
  Scene scene(3);
  const std::vector<Eigen::Vector2d> far = {{1e5, 0.0}, {0.0, -1e7}, {-1e300, 1e300}};
  BlockSums sums(*scene.table, far, scene.grid);
  for (int level = 0; level < 6; ++level) EXPECT_EQ(sums.At(0, level, 0, 0, 8)[0][0], 0U);
}

}  // namespace
}  // namespace masked_mapper
