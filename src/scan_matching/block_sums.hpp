// SPDX-License-Identifier: BSD-3-Clause
// Sums of a look-up table over a query's points, for whole blocks of offsets at once: the inner
// loop of the search. Points are rotated once per angle; for a coarse level, points that share a
// cell are counted and read once (M3RSM, Olson 2015).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "lookup_table.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

/// What the searches look over: a pose's angle and translation in steps from a guess.
struct SearchGrid {
  Pose2 T_reference_query_guess;  ///< its centre
  double resolution_m = 0.05;
  double angle_step = 0.0;  ///< rad
  std::int32_t half_angle = 0;
  std::int32_t half_x = 0;
  std::int32_t half_y = 0;
};

class BlockSums {
 public:
  static constexpr int kSize = 8;  ///< offsets per direction that one call sums up at most
  using Sums = std::array<std::array<std::uint32_t, kSize>, kSize>;  // [y][x]

  /// Both are kept by reference. The points are finite.
  BlockSums(const LookupTable& table, const std::vector<Eigen::Vector2d>& points_in_query,
            const SearchGrid& grid);

  /// Sums at level `level` for the offsets (x + column, y + row) of the level's cells, row and
  /// column < size <= kSize: at level 0 the sums of grid poses, else bounds of the sums below.
  /// `angle` lies in the grid.
  Sums At(std::int32_t angle, int level, std::int32_t x, std::int32_t y, int size);

 private:
  // Points that fall into one cell of a coarse level.
  struct BinnedPoint {
    std::int32_t x;
    std::int32_t y;
    std::uint32_t count;
  };
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;  // 0: not binned yet
  };

  void Bin(std::int32_t angle, int level, Range* range);

  const LookupTable& table_;
  SearchGrid grid_;
  std::size_t count_;
  // Cells at level 0 of all points at all angles, relative to the table's first cell.
  std::vector<std::int32_t> cells_x_;
  std::vector<std::int32_t> cells_y_;
  std::vector<BinnedPoint> binned_;
  std::vector<Range> ranges_;  // [angle][level]
};

/// The cells of points at a pose, relative to the table's first cell: one rounding for all
/// searches.
void CellsAtPose(const LookupTable& table, const std::vector<Eigen::Vector2d>& points_in_query,
                 const Pose2& T_reference_query, std::int32_t* cells_x, std::int32_t* cells_y);

}  // namespace masked_mapper
