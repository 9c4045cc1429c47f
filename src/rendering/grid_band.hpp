// SPDX-License-Identifier: BSD-3-Clause
// What beams told of some rows of a grid, cell by cell, and what that makes of the cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "fixed_line.hpp"
#include "glass_walls.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

constexpr int kCentroidBits = 8;  // of a cell, summed over hits in 32 bits

struct HitCount {
  std::array<std::uint32_t, kBeamAxes> by_axis = {};
  std::uint32_t sum_x = 0;  // of the hits' places within the cell, 2^-kCentroidBits of a cell
  std::uint32_t sum_y = 0;

  std::uint32_t hits() const { return by_axis[0] + by_axis[1] + by_axis[2] + by_axis[3]; }
  void Add(const HitCount& other) {
    for (std::size_t axis = 0; axis < kBeamAxes; ++axis) by_axis[axis] += other.by_axis[axis];
    sum_x += other.sum_x;
    sum_y += other.sum_y;
  }
};

/// The hits of cells, of which few are hit.
class HitCounts {
 public:
  /// So many cells, none of them hit.
  void Restart(std::size_t cells) {
    place_of_.assign(cells, 0);
    counts_.assign(1, {});
  }

  const HitCount& at(std::size_t cell) const { return counts_[place_of_[cell]]; }

  /// To be counted up.
  HitCount& Of(std::size_t cell) {
    std::uint32_t& place = place_of_[cell];
    if (place == 0) {
      place = static_cast<std::uint32_t>(counts_.size());
      counts_.emplace_back();
    }
    return counts_[place];
  }

  void swap(HitCounts& other) {
    place_of_.swap(other.place_of_);
    counts_.swap(other.counts_);
  }

 private:
  std::vector<std::uint32_t> place_of_;  ///< by cell, in counts_
  std::vector<HitCount> counts_;         ///< the first: of cells that nothing hit
};

/// Counts of the rows [first_row, last_row) of the grid.
class Band {
 public:
  explicit Band(int width) : width_(width) {}

  /// Counts other rows from now on, in the same memory.
  void Restart(int first_row, int last_row) {
    first_row_ = first_row;
    last_row_ = last_row;
    const auto cells =
        static_cast<std::size_t>(last_row - first_row) * static_cast<std::size_t>(width_);
    for (Counts& visits : visits_) visits.assign(cells, 0);
    hits_.Restart(cells);
    for (Counts& visits : older_visits_) visits.clear();
    older_hits_.Restart(0);
  }

  bool Contains(int row) const { return row >= first_row_ && row < last_row_; }
  int first_row() const { return first_row_; }
  int last_row() const { return last_row_; }

  void Draw(const FixedPoint& start, const FixedPoint& end, bool hit) {
    const int start_row = CellOf(start.y);
    const int end_row = CellOf(end.y);
    if (std::max(start_row, end_row) < first_row_ || std::min(start_row, end_row) >= last_row_) {
      return;
    }
    const std::size_t axis = BeamAxisOf(end.x - start.x, end.y - start.y);
    Counts& visits = visits_[axis];
    if (std::abs(end.x - start.x) >= std::abs(end.y - start.y)) {
      DrawFlat(start, end, visits);
    } else {
      DrawSteep(start, end, visits);
    }
    const int start_column = CellOf(start.x);
    const int end_column = CellOf(end.x);
    if (Contains(start_row) && (start_row != end_row || start_column != end_column)) {
      ++visits[Index(start_column, start_row)];
    }
    if (!Contains(end_row)) return;
    const std::size_t index = Index(end_column, end_row);
    ++visits[index];
    if (hit) AddHit(end, axis, &hits_.Of(index));
  }

  /// What follows is of a newer drive.
  void BeginDrive() {
    older_visits_.swap(visits_);
    older_hits_.swap(hits_);
    const std::size_t cells = older_visits_[0].size();
    for (Counts& visits : visits_) visits.assign(cells, 0);
    hits_.Restart(cells);
  }

  /// Of a cell that the drive saw often enough to tell a wall by, it alone is believed; elsewhere
  /// what older ones saw counts as well.
  void EndDrive(const GridOptions& options) {
    const double enough = options.min_hits / options.occupied_ratio;
    for (std::size_t index = 0; index < older_visits_[0].size(); ++index) {
      if (VisitsOf(index) >= enough) continue;
      for (std::size_t axis = 0; axis < kBeamAxes; ++axis) {
        visits_[axis][index] += older_visits_[axis][index];
      }
      if (older_hits_.at(index).hits() != 0) hits_.Of(index).Add(older_hits_.at(index));
    }
  }

  /// Sets the band's cells. Walls and what may be glass follow in order of cells.
  void Classify(const GridOptions& options, OccupancyGrid* grid, std::vector<WallPoint>* walls,
                std::vector<GlassCell>* glass) const {
    const std::size_t first =
        static_cast<std::size_t>(first_row_) * static_cast<std::size_t>(width_);
    for (std::size_t index = 0; index < visits_[0].size(); ++index) {
      const std::uint32_t visits = VisitsOf(index);
      if (visits == 0) continue;
      Cell& cell = grid->cells[first + index];
      const std::uint32_t hits = hits_.at(index).hits();
      if (hits < options.occupied_ratio * visits || hits == 0) {
        cell = Cell::kFree;
        const std::uint8_t axes = options.glass && hits != 0 ? GlassAxesOf(index, options) : 0;
        if (axes != 0) glass->push_back({first + index, axes, PointOf(index, *grid)});
      } else if (static_cast<std::int64_t>(hits) >= options.min_hits) {
        cell = Cell::kOccupied;
        walls->push_back(PointOf(index, *grid));
      }
    }
  }

 private:
  using Counts = std::vector<std::uint32_t>;

  std::uint32_t VisitsOf(std::size_t index) const {
    return visits_[0][index] + visits_[1][index] + visits_[2][index] + visits_[3][index];
  }

  /// Along which beams are stopped as often as by a wall, and often enough to tell; a bit each.
  std::uint8_t GlassAxesOf(std::size_t index, const GridOptions& options) const {
    std::uint8_t axes = 0;
    for (std::size_t axis = 0; axis < kBeamAxes; ++axis) {
      const std::uint32_t visits = visits_[axis][index];
      if (visits < options.min_hits / options.occupied_ratio) continue;
      if (hits_.at(index).by_axis[axis] < options.occupied_ratio * visits) continue;
      axes = static_cast<std::uint8_t>(axes | (1U << axis));
    }
    return axes;
  }

  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  void DrawFlat(const FixedPoint& start, const FixedPoint& end, Counts& counts) {
    SampledLine line = SampleLine(start.x, start.y, end.x, end.y);
    if (line.first >= line.last) return;
    if (!Contains(line.MinorCell(line.first)) || !Contains(line.MinorCell(line.last - 1))) {
      ClipMinor(first_row_, last_row_, &line);
    }
    Fixed minor = line.minor_at_first - (Fixed{first_row_} << 32);
    std::uint32_t* visits = counts.data();
    for (int column = line.first; column < line.last; ++column, minor += line.slope) {
      ++visits[(minor >> 32) * width_ + column];
    }
  }

  void DrawSteep(const FixedPoint& start, const FixedPoint& end, Counts& counts) {
    const SampledLine line = SampleLine(start.y, start.x, end.y, end.x);
    const int first = std::max(line.first, first_row_);
    const int last = std::min(line.last, last_row_);
    if (first >= last) return;
    Fixed minor = line.minor_at_first + line.slope * (first - line.first);
    std::uint32_t* visits = counts.data() + Index(0, first);
    for (int row = first; row < last; ++row, minor += line.slope, visits += width_) {
      ++visits[minor >> 32];
    }
  }

  static void AddHit(const FixedPoint& point, std::size_t axis, HitCount* count) {
    constexpr Fixed kFraction = (Fixed{1} << kFractionBits) - 1;
    ++count->by_axis[axis];
    count->sum_x +=
        static_cast<std::uint32_t>((point.x & kFraction) >> (kFractionBits - kCentroidBits));
    count->sum_y +=
        static_cast<std::uint32_t>((point.y & kFraction) >> (kFractionBits - kCentroidBits));
  }

  WallPoint PointOf(std::size_t index, const OccupancyGrid& grid) const {
    const HitCount& count = hits_.at(index);
    const auto width = static_cast<std::size_t>(width_);
    const auto place = [&](std::size_t cell, std::uint32_t sum) {
      // Half a quantum makes up for the cut-off digits.
      const double within = (sum / static_cast<double>(count.hits()) + 0.5) / (1 << kCentroidBits);
      return (static_cast<double>(cell) + within) * grid.resolution_m;
    };
    const std::size_t row = index / width + static_cast<std::size_t>(first_row_);
    return {static_cast<float>(grid.origin_x + place(index % width, count.sum_x)),
            static_cast<float>(grid.origin_y + place(row, count.sum_y))};
  }

  int first_row_ = 0;
  int last_row_ = 0;
  std::int64_t width_;
  std::array<Counts, kBeamAxes> visits_;  // beams that crossed or hit the cell
  HitCounts hits_;
  // Of the drives before, where older ones are to be forgotten.
  std::array<Counts, kBeamAxes> older_visits_;
  HitCounts older_hits_;
};

}  // namespace masked_mapper
