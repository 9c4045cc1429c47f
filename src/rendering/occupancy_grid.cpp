// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/occupancy_grid.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <future>
#include <string>

#include "beam_strokes.hpp"
#include "fixed_line.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr int kCentroidBits = 8;     // of a cell, summed over hits in 32 bits
constexpr int kBandRows = 256;       // bounds the memory of counting: 16 bytes per cell of a band
constexpr double kMaxCells = 4.0e8;  // 1 km^2 at 5 cm
constexpr double kMaxCoordinate = 1e7;  // m; far inside what Fixed can hold

std::string TooLarge(double width_m, double height_m, double resolution_m) {
  return "a floor of " + FixedText(width_m, 0) + " x " + FixedText(height_m, 0) +
         " m is too large for a grid of " + ShortText(resolution_m) +
         " m cells: use a coarser resolution, or look for a jump in the odometry";
}

FixedBox BoxOf(const PosedScan& posed, const GridOptions& options, BeamDirections* cache) {
  FixedBox box;
  ForEachBeam(posed, options, cache, [&box](const FixedPoint& start, const FixedPoint& end, bool) {
    box.Add(start);
    box.Add(end);
  });
  return box;
}

struct HitCount {
  std::uint32_t hits = 0;
  std::uint32_t sum_x = 0;  // of the hits' places within the cell, 2^-kCentroidBits of a cell
  std::uint32_t sum_y = 0;

  void Add(const HitCount& other) {
    hits += other.hits;
    sum_x += other.sum_x;
    sum_y += other.sum_y;
  }
};

// Counts of the rows [first_row, last_row) of the grid.
class Band {
 public:
  Band(int first_row, int last_row, int width)
      : first_row_(first_row),
        last_row_(last_row),
        width_(width),
        visits_(static_cast<std::size_t>(last_row - first_row) * static_cast<std::size_t>(width)),
        hits_(visits_.size()) {}

  bool Contains(int row) const { return row >= first_row_ && row < last_row_; }
  int first_row() const { return first_row_; }
  int last_row() const { return last_row_; }

  void Draw(const FixedPoint& start, const FixedPoint& end, bool hit) {
    const int start_row = CellOf(start.y);
    const int end_row = CellOf(end.y);
    if (std::max(start_row, end_row) < first_row_ || std::min(start_row, end_row) >= last_row_) {
      return;
    }
    if (std::abs(end.x - start.x) >= std::abs(end.y - start.y)) {
      DrawFlat(start, end);
    } else {
      DrawSteep(start, end);
    }
    const int start_column = CellOf(start.x);
    const int end_column = CellOf(end.x);
    if (Contains(start_row) && (start_row != end_row || start_column != end_column)) {
      ++visits_[Index(start_column, start_row)];
    }
    if (!Contains(end_row)) return;
    const std::size_t index = Index(end_column, end_row);
    ++visits_[index];
    if (hit) AddHit(end, &hits_[index]);
  }

  /// What follows is of a newer drive.
  void BeginDrive() {
    older_visits_.swap(visits_);
    older_hits_.swap(hits_);
    visits_.assign(older_visits_.size(), 0);
    hits_.assign(older_hits_.size(), {});
  }

  /// Of a cell that the drive saw often enough to tell a wall by, it alone is believed; elsewhere
  /// what older ones saw counts as well.
  void EndDrive(const GridOptions& options) {
    const double enough = options.min_hits / options.occupied_ratio;
    for (std::size_t index = 0; index < older_visits_.size(); ++index) {
      if (visits_[index] >= enough) continue;
      visits_[index] += older_visits_[index];
      hits_[index].Add(older_hits_[index]);
    }
  }

  // Sets the band's cells, and returns its wall points.
  std::vector<WallPoint> Classify(const GridOptions& options, OccupancyGrid* grid) const {
    std::vector<WallPoint> walls;
    Cell* cells = grid->cells.data() +
                  static_cast<std::size_t>(first_row_) * static_cast<std::size_t>(width_);
    for (std::size_t index = 0; index < visits_.size(); ++index) {
      if (visits_[index] == 0) continue;
      const HitCount& count = hits_[index];
      if (count.hits < options.occupied_ratio * visits_[index] || count.hits == 0) {
        cells[index] = Cell::kFree;
      } else if (static_cast<std::int64_t>(count.hits) >= options.min_hits) {
        cells[index] = Cell::kOccupied;
        walls.push_back(PointOf(index, *grid));
      }
    }
    return walls;
  }

 private:
  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  void DrawFlat(const FixedPoint& start, const FixedPoint& end) {
    SampledLine line = SampleLine(start.x, start.y, end.x, end.y);
    if (line.first >= line.last) return;
    if (!Contains(line.MinorCell(line.first)) || !Contains(line.MinorCell(line.last - 1))) {
      ClipMinor(first_row_, last_row_, &line);
    }
    Fixed minor = line.minor_at_first - (Fixed{first_row_} << 32);
    std::uint32_t* visits = visits_.data();
    for (int column = line.first; column < line.last; ++column, minor += line.slope) {
      ++visits[(minor >> 32) * width_ + column];
    }
  }

  void DrawSteep(const FixedPoint& start, const FixedPoint& end) {
    const SampledLine line = SampleLine(start.y, start.x, end.y, end.x);
    const int first = std::max(line.first, first_row_);
    const int last = std::min(line.last, last_row_);
    if (first >= last) return;
    Fixed minor = line.minor_at_first + line.slope * (first - line.first);
    std::uint32_t* visits = visits_.data() + Index(0, first);
    for (int row = first; row < last; ++row, minor += line.slope, visits += width_) {
      ++visits[minor >> 32];
    }
  }

  static void AddHit(const FixedPoint& point, HitCount* count) {
    constexpr Fixed kFraction = (Fixed{1} << kFractionBits) - 1;
    ++count->hits;
    count->sum_x +=
        static_cast<std::uint32_t>((point.x & kFraction) >> (kFractionBits - kCentroidBits));
    count->sum_y +=
        static_cast<std::uint32_t>((point.y & kFraction) >> (kFractionBits - kCentroidBits));
  }

  WallPoint PointOf(std::size_t index, const OccupancyGrid& grid) const {
    const HitCount& count = hits_[index];
    const auto width = static_cast<std::size_t>(width_);
    const auto place = [&](std::size_t cell, std::uint32_t sum) {
      // Half a quantum makes up for the cut-off digits.
      const double within = (sum / static_cast<double>(count.hits) + 0.5) / (1 << kCentroidBits);
      return (static_cast<double>(cell) + within) * grid.resolution_m;
    };
    const std::size_t row = index / width + static_cast<std::size_t>(first_row_);
    return {static_cast<float>(grid.origin_x + place(index % width, count.sum_x)),
            static_cast<float>(grid.origin_y + place(row, count.sum_y))};
  }

  int first_row_;
  int last_row_;
  std::int64_t width_;
  std::vector<std::uint32_t> visits_;  // beams that crossed or hit the cell
  std::vector<HitCount> hits_;
  // Of the drives before, where older ones are to be forgotten.
  std::vector<std::uint32_t> older_visits_;
  std::vector<HitCount> older_hits_;
};

struct BoxedScan {
  const PosedScan* posed = nullptr;
  FixedBox box;
};

// The scans of the floor that tell anything, with what they cover.
std::vector<BoxedScan> ScansOf(const std::vector<PosedScan>& scans, std::int32_t floor,
                               const GridOptions& options) {
  std::vector<BoxedScan> chosen;
  BeamDirections cache;
  for (const PosedScan& posed : scans) {
    if (posed.floor != floor) continue;
    const double reach = std::max(std::abs(posed.T_world_robot.x), std::abs(posed.T_world_robot.y));
    if (!(reach < kMaxCoordinate)) {
      throw InputError(TooLarge(reach, reach, options.resolution_m));
    }
    const FixedBox box = BoxOf(posed, options, &cache);
    if (!box.empty()) chosen.push_back({&posed, box});
  }
  return chosen;
}

OccupancyGrid EmptyGrid(const FixedBox& box, const GridOptions& options) {
  const double columns = static_cast<double>(box.high.x - box.low.x) / (2.0 * kHalfCell) + 2.0;
  const double rows = static_cast<double>(box.high.y - box.low.y) / (2.0 * kHalfCell) + 2.0;
  if (columns * rows > kMaxCells) {
    throw InputError(TooLarge(columns * options.resolution_m, rows * options.resolution_m,
                              options.resolution_m));
  }
  OccupancyGrid grid;
  grid.resolution_m = options.resolution_m;
  grid.origin_x = static_cast<double>(box.low.x >> kFractionBits) * options.resolution_m;
  grid.origin_y = static_cast<double>(box.low.y >> kFractionBits) * options.resolution_m;
  grid.width = CellOf(box.high.x - EdgeOf(box.low.x)) + 1;
  grid.height = CellOf(box.high.y - EdgeOf(box.low.y)) + 1;
  grid.cells.resize(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  return grid;
}

}  // namespace

OccupancyGrid RenderGrid(const std::vector<PosedScan>& scans, std::int32_t floor,
                         const GridOptions& options) {
  assert(options.resolution_m > 0.0 && options.max_usable_range_m > 0.0);
  const std::vector<BoxedScan> chosen = ScansOf(scans, floor, options);
  FixedBox box;
  for (const BoxedScan& scan : chosen) box.Add(scan.box);
  OccupancyGrid empty;
  empty.resolution_m = options.resolution_m;
  if (box.empty()) return empty;

  OccupancyGrid grid = EmptyGrid(box, options);
  const FixedPoint corner{EdgeOf(box.low.x), EdgeOf(box.low.y)};
  const int bands = (grid.height + kBandRows - 1) / kBandRows;
  std::vector<std::vector<WallPoint>> walls(static_cast<std::size_t>(bands));
  std::atomic<int> next_band{0};
  const auto render_bands = [&] {
    BeamDirections cache;
    for (int index = next_band++; index < bands; index = next_band++) {
      Band band(index * kBandRows, std::min((index + 1) * kBandRows, grid.height), grid.width);
      std::size_t drive = chosen.front().posed->drive;
      for (const BoxedScan& scan : chosen) {
        if (CellOf(scan.box.high.y - corner.y) < band.first_row() ||
            CellOf(scan.box.low.y - corner.y) >= band.last_row()) {
          continue;
        }
        if (options.forget && scan.posed->drive != drive) {
          band.EndDrive(options);
          band.BeginDrive();
          drive = scan.posed->drive;
        }
        ForEachBeam(*scan.posed, options, &cache,
                    [&](const FixedPoint& start, const FixedPoint& end, bool hit) {
                      band.Draw({start.x - corner.x, start.y - corner.y},
                                {end.x - corner.x, end.y - corner.y}, hit);
                    });
      }
      band.EndDrive(options);
      walls[static_cast<std::size_t>(index)] = band.Classify(options, &grid);
    }
  };
  std::vector<std::future<void>> helpers;
  for (int thread = 1; thread < std::min(options.threads, bands); ++thread) {
    helpers.push_back(std::async(std::launch::async, render_bands));
  }
  render_bands();
  for (std::future<void>& helper : helpers) helper.get();
  for (const auto& part : walls) grid.walls.insert(grid.walls.end(), part.begin(), part.end());
  return grid;
}

double KnownArea(const OccupancyGrid& grid) {
  const auto known = std::count_if(grid.cells.begin(), grid.cells.end(),
                                   [](Cell cell) { return cell != Cell::kUnknown; });
  return static_cast<double>(known) * grid.resolution_m * grid.resolution_m;
}

}  // namespace masked_mapper
