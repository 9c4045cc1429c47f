// SPDX-License-Identifier: BSD-3-Clause
// Look-up table of a reference: how well a point at a cell fits the reference's points, and a
// pyramid of maxima over it that bounds whole blocks of cells at once (M3RSM, Olson 2015; Section
// III-D).
//
// Cells lie on a lattice anchored at the origin of the reference frame: cell (i, j) covers
// [i, i + 1) x [j, j + 1) times the resolution. The value of a cell is 255 exp(-d^2 / 2 sigma^2),
// rounded, with d the distance from the cell's centre to the nearest reference point; points count
// as rounded to 1/8 of a cell, and the blur ends at three sigmas. Everything outside the table is
// 0.
//
// Level 0 holds the cells. Cell C of level l holds the maximum over the cells C 2^l to
// C 2^l + 2^(l+1) - 2 in both directions: itself and its right, upper and diagonal neighbours, less
// the last row and column, which no sum of a point's and an offset's position in their blocks
// reaches. So for a point in cell p and any offset o: Value(0, p + o) <= Value(l, (p >> l) + (o >>
// l)).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "masked_mapper/scan_matching/matcher_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// A rectangle of a frame, m. Empty unless max > min in both directions.
struct TableBounds {
  double min_x = 0.0;
  double min_y = 0.0;
  double max_x = 0.0;
  double max_y = 0.0;
};

struct TableCell {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// The blur of one point for each of 8 x 8 positions within its cell. Worth keeping where many
/// tables are made with the same options.
class BlurKernels {
 public:
  static constexpr int kPhases = 8;

  explicit BlurKernels(const LookupTableOptions& options);

  int radius() const { return radius_; }  ///< cells on either side of the point's own
  int row_bytes() const {
    return row_bytes_;
  }  ///< a multiple of 16, zeros after 2 radius + 1 values
  /// The 2 radius + 1 rows, lowest y first, each starting at the lowest x.
  const std::uint8_t* Rows(int phase_x, int phase_y) const;

 private:
  int radius_;
  int row_bytes_;
  std::vector<std::uint8_t> values_;
};

class LookupTable {
 public:
  /// Storage around every level that is always 0, so that whole blocks of up to this many cells can
  /// be read without asking where the table ends.
  static constexpr int kPadding = 16;

  /// One level as the search reads it: value of cell (x, y) at data[(y - y0) * stride + (x - x0)].
  /// Readable are x in [x0 - kPadding, x0 + width + kPadding), the same for y; non-zero values
  /// occur in [x0 - 1, x0 + width) x [y0 - 1, y0 + height) only.
  struct Level {
    const std::uint8_t* data = nullptr;
    std::ptrdiff_t stride = 0;
    std::int32_t x0 = 0;
    std::int32_t y0 = 0;
    std::int32_t width = 0;
    std::int32_t height = 0;
  };

  /// The table of points in any frame, as large as the points need. Points that are not finite or
  /// beyond max_range_m are left out; without points every value is 0. The kernels are those of the
  /// same options. Many points are blurred by several threads; the table is the same.
  LookupTable(const ScanPoints& points_in_frame, const LookupTableOptions& options,
              const BlurKernels& kernels, int threads = 1);
  LookupTable(const ScanPoints& points_in_frame, const LookupTableOptions& options)
      : LookupTable(points_in_frame, options, BlurKernels(options)) {}

  /// The same within given bounds, which are the caller's to keep sane: also what points outside
  /// blur into them, whatever their range.
  LookupTable(const ScanPoints& points_in_frame, const TableBounds& bounds,
              const LookupTableOptions& options, const BlurKernels& kernels);

  double resolution() const { return resolution_; }
  double sigma() const { return sigma_; }
  int levels() const { return static_cast<int>(levels_.size()); }
  const Level& level(int index) const { return levels_[static_cast<std::size_t>(index)]; }

  /// Value of any cell of a level, 0 outside the table.
  std::uint8_t Value(int level, TableCell cell) const;

  /// The cell of level 0 that a finite position in the frame lies in; positions farther than 2^30
  /// cells from the origin count as that far.
  TableCell CellAt(double x, double y) const;

  std::size_t MemoryBytes() const { return bytes_; }

 private:
  void Allocate(TableCell low, TableCell high, int levels);
  /// Of level 0, [first, end).
  struct Rows {
    std::int64_t first = 0;
    std::int64_t end = 0;
  };
  void Blur(const std::vector<pcl::PointXY>& points, double join_gap_m, const BlurKernels& kernels,
            int threads);
  void BlurInto(const Rows& rows, const std::vector<pcl::PointXY>& points, double join_gap_m,
                const BlurKernels& kernels);
  void BlurPoint(double x, double y, const BlurKernels& kernels, const Rows& rows);
  void BuildPyramid();
  std::uint8_t* Writable(const Level& level) const {
    return storage_.get() + (level.data - storage_.get());
  }

  double resolution_;
  double cells_per_m_;
  double sigma_;
  struct Free {
    void operator()(std::uint8_t* bytes) const { std::free(bytes); }
  };

  // From calloc: most of a large table is never written, and so never takes memory.
  std::unique_ptr<std::uint8_t, Free> storage_;
  std::size_t bytes_ = 0;
  std::vector<Level> levels_;
};

}  // namespace masked_mapper
