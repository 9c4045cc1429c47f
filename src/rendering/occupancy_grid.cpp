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
#include "glass_walls.hpp"
#include "grid_band.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr int kBandRows = 256;       // bounds the memory of counting: 20 bytes per cell of a band
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
  std::vector<std::vector<GlassCell>> glass(static_cast<std::size_t>(bands));
  std::atomic<int> next_band{0};
  const auto render_bands = [&] {
    BeamDirections cache;
    Band band(grid.width);
    for (int index = next_band++; index < bands; index = next_band++) {
      band.Restart(index * kBandRows, std::min((index + 1) * kBandRows, grid.height));
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
      band.Classify(options, &grid, &walls[static_cast<std::size_t>(index)],
                    &glass[static_cast<std::size_t>(index)]);
    }
  };
  std::vector<std::future<void>> helpers;
  for (int thread = 1; thread < std::min(options.threads, bands); ++thread) {
    helpers.push_back(std::async(std::launch::async, render_bands));
  }
  render_bands();
  for (std::future<void>& helper : helpers) helper.get();
  for (const auto& part : walls) grid.walls.insert(grid.walls.end(), part.begin(), part.end());
  std::vector<GlassCell> all_glass;
  for (const auto& part : glass) all_glass.insert(all_glass.end(), part.begin(), part.end());
  KeepGlass(all_glass, &grid);
  return grid;
}

double KnownArea(const OccupancyGrid& grid) {
  const auto known = std::count_if(grid.cells.begin(), grid.cells.end(),
                                   [](Cell cell) { return cell != Cell::kUnknown; });
  return static_cast<double>(known) * grid.resolution_m * grid.resolution_m;
}

}  // namespace masked_mapper
