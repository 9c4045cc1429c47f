// SPDX-License-Identifier: BSD-3-Clause
#include "floor_volume.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

std::string OutOfReach(double reach_m, double resolution_m) {
  return "the map reaches " + FixedText(reach_m, 0) + " m from its origin, but an octree of " +
         ShortText(resolution_m) + " m voxels ends at " +
         FixedText(kKeyOfOrigin * resolution_m, 0) + " m: use a coarser resolution";
}

// What of the range lies inside the band; nothing is [0, 0).
KeyRange Clipped(const KeyRange& range, const HeightBand& heights, double resolution_m) {
  const double low = std::ceil(heights.low_m / resolution_m - 0.5) + kKeyOfOrigin;
  const double high = std::floor(heights.high_m / resolution_m - 0.5) + 1.0 + kKeyOfOrigin;
  if (!(low < range.high && high > range.low && low < high)) return {};
  return {low > range.low ? static_cast<int>(low) : range.low,
          high < range.high ? static_cast<int>(high) : range.high};
}

// The sets of states in all aligned squares of a grid, level by level; what lies outside is
// unknown.
class StatePyramid {
 public:
  explicit StatePyramid(const OccupancyGrid& grid)
      : x_(CheckedKeys(std::round(grid.origin_x / grid.resolution_m), grid.width,
                       grid.resolution_m)),
        y_(CheckedKeys(std::round(grid.origin_y / grid.resolution_m), grid.height,
                       grid.resolution_m)) {
    levels_.push_back(Cells(grid));
    while (levels_.back().width > 1 || levels_.back().height > 1) {
      levels_.push_back(Coarser(levels_.back()));
    }
  }

  States At(const Block& block) const {
    // Above the top one square holds the whole grid; of larger squares it is a part.
    const int level = std::min(block.level, static_cast<int>(levels_.size()) - 1);
    const Level& squares = levels_[static_cast<std::size_t>(level)];
    if (level < block.level) {
      const bool inside = squares.low_x >> (block.level - level) == block.key[0] >> block.level &&
                          squares.low_y >> (block.level - level) == block.key[1] >> block.level;
      return inside ? static_cast<States>(squares.states[0] | kUnknownBit) : kUnknownBit;
    }
    const int x = (block.key[0] >> level) - squares.low_x;
    const int y = (block.key[1] >> level) - squares.low_y;
    if (x < 0 || y < 0 || x >= squares.width || y >= squares.height) return kUnknownBit;
    return squares.states[squares.Index(x, y)];
  }

 private:
  struct Level {
    int low_x = 0;  // key >> level of the first square
    int low_y = 0;
    int width = 0;
    int height = 0;
    std::vector<States> states;

    std::size_t Index(int x, int y) const {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(x);
    }
  };

  Level Cells(const OccupancyGrid& grid) const {
    Level level{x_.low, y_.low, grid.width, grid.height, {}};
    level.states.resize(grid.cells.size());
    std::transform(grid.cells.begin(), grid.cells.end(), level.states.begin(),
                   [](Cell cell) { return static_cast<States>(1 << static_cast<int>(cell)); });
    return level;
  }

  static Level Coarser(const Level& fine) {
    Level coarse;
    coarse.low_x = fine.low_x >> 1;
    coarse.low_y = fine.low_y >> 1;
    coarse.width = ((fine.low_x + fine.width - 1) >> 1) - coarse.low_x + 1;
    coarse.height = ((fine.low_y + fine.height - 1) >> 1) - coarse.low_y + 1;
    coarse.states.resize(static_cast<std::size_t>(coarse.width) *
                         static_cast<std::size_t>(coarse.height));
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        coarse.states[coarse.Index(((fine.low_x + x) >> 1) - coarse.low_x,
                                   ((fine.low_y + y) >> 1) - coarse.low_y)] |=
            fine.states[fine.Index(x, y)];
      }
    }
    MarkRim(fine, &coarse);
    return coarse;
  }

  // Squares that stick out over the finer level are unknown in part.
  static void MarkRim(const Level& fine, Level* coarse) {
    const bool left = fine.low_x & 1;
    const bool bottom = fine.low_y & 1;
    const bool right = (fine.low_x + fine.width) & 1;
    const bool top = (fine.low_y + fine.height) & 1;
    for (int y = 0; y < coarse->height; ++y) {
      if (left) coarse->states[coarse->Index(0, y)] |= kUnknownBit;
      if (right) coarse->states[coarse->Index(coarse->width - 1, y)] |= kUnknownBit;
    }
    for (int x = 0; x < coarse->width; ++x) {
      if (bottom) coarse->states[coarse->Index(x, 0)] |= kUnknownBit;
      if (top) coarse->states[coarse->Index(x, coarse->height - 1)] |= kUnknownBit;
    }
  }

  KeyRange x_;
  KeyRange y_;
  std::vector<Level> levels_;
};

// One floor in three dimensions.
class FloorVolume : public Volume {
 public:
  FloorVolume(const FloorLayer& layer, const OctreeOptions& options, const HeightBand& heights)
      : pyramid_(*layer.grid) {
    const double resolution = layer.grid->resolution_m;
    const double bottom = std::round(layer.elevation / resolution);
    const double walls = std::max(1.0, std::round(options.wall_height_m / resolution));
    const double slab =
        std::exp2(std::max(0.0, std::round(std::log2(options.free_height_m / resolution))));
    walls_ = Clipped(CheckedKeys(bottom, walls, resolution), heights, resolution);
    free_ = Clipped(CheckedKeys(std::ceil(bottom / slab) * slab, slab, resolution), heights,
                    resolution);
  }

  States At(const Block& block) const override {
    const Overlap in_walls = OverlapOf(block, walls_);
    const Overlap in_free = OverlapOf(block, free_);
    if (in_walls == Overlap::kNone && in_free == Overlap::kNone) return kUnknownBit;
    const States below = pyramid_.At(block);
    States states = below & kUnknownBit;
    if (below & kOccupiedBit) states |= Within(in_walls, kOccupiedBit);
    if (below & kFreeBit) states |= Within(in_free, kFreeBit);
    return states;
  }

 private:
  enum class Overlap { kNone, kPart, kWhole };

  static Overlap OverlapOf(const Block& block, const KeyRange& range) {
    const int low = block.key[2];
    const int high = low + (1 << block.level);
    if (high <= range.low || low >= range.high) return Overlap::kNone;
    return low >= range.low && high <= range.high ? Overlap::kWhole : Overlap::kPart;
  }

  static States Within(Overlap overlap, States bit) {
    switch (overlap) {
      case Overlap::kNone:
        return kUnknownBit;
      case Overlap::kPart:
        return kUnknownBit | bit;
      default:
        return bit;
    }
  }

  StatePyramid pyramid_;
  KeyRange walls_;
  KeyRange free_;
};

}  // namespace

KeyRange CheckedKeys(double first_cell, double count, double resolution_m) {
  const double low = first_cell + kKeyOfOrigin;
  const double high = low + count;
  if (!(low >= 0.0 && high <= 2.0 * kKeyOfOrigin)) {
    const double reach = std::max(std::abs(first_cell), std::abs(first_cell + count));
    throw InputError(OutOfReach(reach * resolution_m, resolution_m));
  }
  return {static_cast<int>(low), static_cast<int>(high)};
}

std::unique_ptr<Volume> VolumeOf(const FloorLayer& layer, const OctreeOptions& options,
                                 const HeightBand& heights) {
  return std::make_unique<FloorVolume>(layer, options, heights);
}

}  // namespace masked_mapper
