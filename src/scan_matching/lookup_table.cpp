// SPDX-License-Identifier: BSD-3-Clause
#include "lookup_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>

#include "masked_mapper/scan_matching/for_each.hpp"

namespace masked_mapper {
namespace {

constexpr double kBlurSigmas = 3.0;
constexpr int kLargestRadius = 64;                   // cells; a wider blur is cut there
constexpr double kLargestCoordinate = 1073741824.0;  // cells, 2^30

// Rounds down without a call: truncation, corrected below zero.
std::int32_t CellOf(double coordinate_in_cells) {
  const double clamped = std::clamp(coordinate_in_cells, -kLargestCoordinate, kLargestCoordinate);
  const auto truncated = static_cast<std::int32_t>(clamped);
  return truncated - static_cast<std::int32_t>(truncated > clamped);
}

std::vector<pcl::PointXY> UsablePoints(const ScanPoints& points, double max_range_m) {
  std::vector<pcl::PointXY> usable;
  usable.reserve(points.size());
  for (const pcl::PointXY& point : points) {
    // Not a number compares false.
    if (std::sqrt(double{point.x} * point.x + double{point.y} * point.y) <= max_range_m)
      usable.push_back(point);
  }
  return usable;
}

inline void MaxInto(std::uint8_t* values, const std::uint8_t* others) {
  for (int i = 0; i < 16; ++i) values[i] = std::max(values[i], others[i]);
}

void MaxOfThree(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c,
                std::int32_t count, std::uint8_t* __restrict maxima) {
  for (std::int32_t i = 0; i < count; ++i) maxima[i] = std::max(a[i], std::max(b[i], c[i]));
}

void EverySecond(const std::uint8_t* values, std::int32_t count, std::uint8_t* __restrict second) {
  for (std::int32_t i = 0; i < count; ++i) second[i] = values[2 * i];
}

}  // namespace

BlurKernels::BlurKernels(const LookupTableOptions& options)
    : radius_(static_cast<int>(
          std::clamp(std::ceil(kBlurSigmas * options.sigma_m / options.resolution_m), 0.0,
                     double{kLargestRadius}))),
      row_bytes_((2 * radius_ + 1 + 15) / 16 * 16) {
  const int size = 2 * radius_ + 1;
  const int bytes = kPhases * kPhases * size * row_bytes_;
  values_.assign(static_cast<std::size_t>(bytes), 0);
  const double sigma = std::max(options.sigma_m / options.resolution_m, 1e-6);  // cells
  const double limit2 = kBlurSigmas * kBlurSigmas * sigma * sigma;
  // exp(-d^2 / 2 sigma^2) is a product over the two directions, so few exponentials are needed.
  std::vector<double> offset2(static_cast<std::size_t>(kPhases * size));
  std::vector<double> factor(offset2.size());
  for (std::size_t i = 0; i < offset2.size(); ++i) {
    const int phase = static_cast<int>(i) / size;
    const int cell = static_cast<int>(i) % size - radius_;
    const double offset = cell + 0.5 - (phase + 0.5) / kPhases;
    offset2[i] = offset * offset;
    factor[i] = std::exp(-offset2[i] / (2.0 * sigma * sigma));
  }
  constexpr double kToNearest = 0.5;  // never negative here, and a call of lround costs more
  std::uint8_t* values = values_.data();
  for (int phase_y = 0; phase_y < kPhases; ++phase_y) {
    for (int phase_x = 0; phase_x < kPhases; ++phase_x) {
      for (int row = 0; row < size; ++row, values += row_bytes_) {
        for (int column = 0; column < size; ++column) {
          const int phased_column = phase_x * size + column;
          const int phased_row = phase_y * size + row;
          const auto x = static_cast<std::size_t>(phased_column);
          const auto y = static_cast<std::size_t>(phased_row);
          // A point's own cell counts however sharp the blur is.
          const bool is_own = row == radius_ && column == radius_;
          if (offset2[x] + offset2[y] > limit2 && !is_own) continue;
          const auto value = static_cast<int>(255.0 * factor[x] * factor[y] + kToNearest);
          values[column] = static_cast<std::uint8_t>(is_own ? std::max(value, 1) : value);
        }
      }
    }
  }
}

const std::uint8_t* BlurKernels::Rows(int phase_x, int phase_y) const {
  return values_.data() +
         static_cast<std::ptrdiff_t>(phase_y * kPhases + phase_x) * (2 * radius_ + 1) * row_bytes_;
}

LookupTable::LookupTable(const ScanPoints& points_in_frame, const LookupTableOptions& options,
                         const BlurKernels& kernels, int threads)
    : resolution_(options.resolution_m),
      cells_per_m_(1.0 / options.resolution_m),
      sigma_(options.sigma_m) {
  const std::vector<pcl::PointXY> points = UsablePoints(points_in_frame, options.max_range_m);
  if (points.empty()) {
    Allocate({0, 0}, {0, 0}, options.levels);
    return;
  }
  TableCell low = CellAt(points.front().x, points.front().y);
  TableCell high = low;
  for (const pcl::PointXY& point : points) {
    const TableCell cell = CellAt(point.x, point.y);
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
    high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  }
  const int radius = kernels.radius();
  Allocate({low.x - radius, low.y - radius}, {high.x + radius + 1, high.y + radius + 1},
           options.levels);
  Blur(points, options.join_gap_m, kernels, threads);
  BuildPyramid();
}

LookupTable::LookupTable(const ScanPoints& points_in_frame, const TableBounds& bounds,
                         const LookupTableOptions& options, const BlurKernels& kernels)
    : resolution_(options.resolution_m),
      cells_per_m_(1.0 / options.resolution_m),
      sigma_(options.sigma_m) {
  if (!(bounds.max_x > bounds.min_x && bounds.max_y > bounds.min_y)) {
    Allocate({0, 0}, {0, 0}, options.levels);
    return;
  }
  const TableCell low = CellAt(bounds.min_x, bounds.min_y);
  const TableCell last = CellAt(bounds.max_x, bounds.max_y);
  Allocate(low, {last.x + 1, last.y + 1}, options.levels);
  Blur(UsablePoints(points_in_frame, std::numeric_limits<double>::max()), options.join_gap_m,
       kernels, 1);
  BuildPyramid();
}

std::uint8_t LookupTable::Value(int level_index, TableCell cell) const {
  const Level& from = level(level_index);
  const std::int64_t x = std::int64_t{cell.x} - from.x0;
  const std::int64_t y = std::int64_t{cell.y} - from.y0;
  if (x < -1 || y < -1 || x >= from.width || y >= from.height) return 0;
  return from.data[y * from.stride + x];
}

TableCell LookupTable::CellAt(double x, double y) const {
  return {CellOf(x * cells_per_m_), CellOf(y * cells_per_m_)};
}

// `low` is the first cell, `high` the one after the last.
void LookupTable::Allocate(TableCell low, TableCell high, int levels) {
  assert(levels >= 1);
  // A cell of the coarsest level larger than all that is in the table would only make it larger.
  const std::int64_t extent = std::max(std::int64_t{high.x} - low.x, std::int64_t{high.y} - low.y);
  while (levels > 1 && (std::int64_t{1} << std::min(levels - 1, 62)) > 2 * extent) --levels;
  levels_.resize(static_cast<std::size_t>(levels));
  // Level 0 begins and ends on a cell of the coarsest level, so that all levels cover the same
  // ground.
  const int shift = levels - 1;
  const std::int32_t first_x = low.x >> shift;
  const std::int32_t first_y = low.y >> shift;
  const std::int32_t columns = ((high.x - 1) >> shift) - first_x + 1;
  const std::int32_t rows = ((high.y - 1) >> shift) - first_y + 1;
  std::size_t bytes = 0;
  std::vector<std::size_t> offsets;
  for (int l = 0; l < levels; ++l) {
    Level& level = levels_[static_cast<std::size_t>(l)];
    const std::int32_t scale = 1 << (shift - l);
    level.x0 = first_x * scale;
    level.y0 = first_y * scale;
    level.width = columns * scale;
    level.height = rows * scale;
    level.stride = (level.width + 2 * kPadding + 15) / 16 * 16;
    offsets.push_back(bytes + static_cast<std::size_t>(kPadding * level.stride + kPadding));
    bytes += static_cast<std::size_t>(level.stride * (level.height + 2 * kPadding));
  }
  storage_.reset(static_cast<std::uint8_t*>(std::calloc(bytes, 1)));
  if (!storage_) throw std::bad_alloc();
  bytes_ = bytes;
  for (std::size_t l = 0; l < levels_.size(); ++l) levels_[l].data = storage_.get() + offsets[l];
}

void LookupTable::Blur(const std::vector<pcl::PointXY>& points, double join_gap_m,
                       const BlurKernels& kernels, int threads) {
  constexpr std::size_t kOfOneThread = 2000;  // points; to start a thread takes as long
  const std::size_t parts =
      std::min(static_cast<std::size_t>(std::max(threads, 1)), 1 + points.size() / kOfOneThread);
  const std::int64_t height = levels_.front().height;
  const auto row_of = [&](std::size_t part) {
    return height * static_cast<std::int64_t>(part) / static_cast<std::int64_t>(parts);
  };
  ForEach(parts, threads, [&](std::size_t part) {
    BlurInto({row_of(part), row_of(part + 1)}, points, join_gap_m, kernels);
  });
}

void LookupTable::BlurInto(const Rows& rows, const std::vector<pcl::PointXY>& points,
                           double join_gap_m, const BlurKernels& kernels) {
  // Near enough for the blur to show no beads.
  const double spacing = std::max(0.5 * resolution_, sigma_ / 3.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    BlurPoint(points[i].x, points[i].y, kernels, rows);
    if (i == 0 || !(join_gap_m > 0.0)) continue;
    const double dx = double{points[i].x} - points[i - 1].x;
    const double dy = double{points[i].y} - points[i - 1].y;
    const double gap = std::sqrt(dx * dx + dy * dy);
    if (gap > join_gap_m) continue;
    const int steps = static_cast<int>(gap / spacing) + 1;
    for (int step = 1; step < steps; ++step) {
      const double fraction = static_cast<double>(step) / steps;
      BlurPoint(points[i - 1].x + fraction * dx, points[i - 1].y + fraction * dy, kernels, rows);
    }
  }
}

void LookupTable::BlurPoint(double x, double y, const BlurKernels& kernels, const Rows& rows) {
  const Level& cells = levels_.front();
  const double x_in_cells = x * cells_per_m_;
  const double y_in_cells = y * cells_per_m_;
  const TableCell cell{CellOf(x_in_cells), CellOf(y_in_cells)};
  const auto phase = [](double in_cells, std::int32_t index) {
    // Far outside given bounds the index is that of a border, and the difference no int.
    return static_cast<int>(
        std::clamp((in_cells - index) * BlurKernels::kPhases, 0.0, BlurKernels::kPhases - 1.0));
  };
  const std::uint8_t* kernel = kernels.Rows(phase(x_in_cells, cell.x), phase(y_in_cells, cell.y));
  const int radius = kernels.radius();
  const int size = 2 * radius + 1;
  // 64 bits: a point far outside given bounds must not overflow.
  const std::int64_t left = std::int64_t{cell.x} - radius - cells.x0;
  const std::int64_t bottom = std::int64_t{cell.y} - radius - cells.y0;
  if (left + size <= 0 || left >= cells.width) return;
  const std::int64_t first_row = std::max<std::int64_t>(0, rows.first - bottom);
  const std::int64_t end_row = std::min<std::int64_t>(size, rows.end - bottom);
  const bool is_inside = left >= 0 && left + size <= cells.width;
  for (std::int64_t row = first_row; row < end_row; ++row) {
    const std::uint8_t* from = kernel + row * kernels.row_bytes();
    std::uint8_t* to = Writable(cells) + (bottom + row) * cells.stride + left;
    if (is_inside && kernels.row_bytes() == 16) {
      MaxInto(to, from);
    } else if (is_inside) {
      for (int i = 0; i < kernels.row_bytes(); i += 16) MaxInto(to + i, from + i);
    } else {
      const std::int64_t first = std::max<std::int64_t>(0, -left);
      const std::int64_t end = std::min<std::int64_t>(size, cells.width - left);
      for (std::int64_t i = first; i < end; ++i) to[i] = std::max(to[i], from[i]);
    }
  }
}

// Level l + 1 from level l: cell C of it spans the cells 2C, 2C + 1 and 2C + 2 of the finer level,
// whose own spans overlap by all but one cell. Whole rows of bytes at a time, for the compiler to
// turn into vector code.
void LookupTable::BuildPyramid() {
  const int width = levels_.front().width + 2 * kPadding;
  const auto widest = static_cast<std::size_t>(width);
  std::vector<std::uint8_t> rows(2 * widest);
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    const Level& fine = levels_[l];
    const Level& coarse = levels_[l + 1];
    const std::int32_t count = fine.width + 4;  // from cell -2 on
    std::uint8_t* const upward = rows.data();
    std::uint8_t* const rightward = rows.data() + widest;
    for (std::int32_t y = -1; y < coarse.height; ++y) {
      const std::uint8_t* row = fine.data + 2 * y * fine.stride - 2;
      MaxOfThree(row, row + fine.stride, row + 2 * fine.stride, count, upward);
      MaxOfThree(upward, upward + 1, upward + 2, count - 2, rightward);
      EverySecond(rightward, coarse.width + 1, Writable(coarse) + y * coarse.stride - 1);
    }
  }
}

}  // namespace masked_mapper
