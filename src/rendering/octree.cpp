// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/octree.hpp"

// OctoMap prints from its headers in debug builds unless told not to.
#ifndef OCTOMAP_NODEBUGOUT
#define OCTOMAP_NODEBUGOUT
#endif
#include <octomap/octomap.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <string>

#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr int kTreeDepth = 16;
constexpr int kKeyOfOrigin = 1 << (kTreeDepth - 1);

// What the cells of a region may be, as a set.
using States = std::uint8_t;
constexpr States kUnknownBit = 1 << static_cast<int>(Cell::kUnknown);
constexpr States kFreeBit = 1 << static_cast<int>(Cell::kFree);
constexpr States kOccupiedBit = 1 << static_cast<int>(Cell::kOccupied);

// Keys [low, high) along one axis.
struct KeyRange {
  int low = 0;
  int high = 0;
};

// A cube of 2^level voxels a side, aligned to the tree.
struct Block {
  std::array<int, 3> key{};
  int level = 0;
};

std::string OutOfReach(double reach_m, double resolution_m) {
  return "the map reaches " + FixedText(reach_m, 0) + " m from its origin, but an octree of " +
         ShortText(resolution_m) + " m voxels ends at " +
         FixedText(kKeyOfOrigin * resolution_m, 0) + " m: use a coarser resolution";
}

KeyRange CheckedKeys(double first_cell, double count, double resolution_m) {
  const double low = first_cell + kKeyOfOrigin;
  const double high = low + count;
  if (!(low >= 0.0 && high <= 2.0 * kKeyOfOrigin)) {
    const double reach = std::max(std::abs(first_cell), std::abs(first_cell + count));
    throw InputError(OutOfReach(reach * resolution_m, resolution_m));
  }
  return {static_cast<int>(low), static_cast<int>(high)};
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
class FloorVolume {
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

  // The states that voxels of the block may have.
  States At(const Block& block) const {
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

// OctoMap offers no way to make the root alone.
class RootedTree : public octomap::OcTree {
 public:
  using octomap::OcTree::OcTree;

  octomap::OcTreeNode* MakeRoot() {
    assert(root == nullptr);
    root = new octomap::OcTreeNode();
    ++tree_size;
    size_changed = true;
    return root;
  }
};

// Fills the tree from the top, so that what is alike is one node from the start.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<FloorVolume>& floors, RootedTree* tree)
      : floors_(floors), tree_(tree) {}

  void Build() {
    const Block all{{}, kTreeDepth};
    const States states = At(all);
    if (states != kUnknownBit) Fill(tree_->MakeRoot(), all, states);
  }

 private:
  // Floors that know nothing of the block have no say in it.
  States At(const Block& block) const {
    States states = 0;
    for (const FloorVolume& floor : floors_) {
      const States of_floor = floor.At(block);
      if (of_floor != kUnknownBit) states |= of_floor;
    }
    if (states == 0) return kUnknownBit;
    if (block.level > 0) return states;
    return states & kOccupiedBit ? kOccupiedBit : kFreeBit;
  }

  void Fill(octomap::OcTreeNode* node, const Block& block, States states) {
    if (states == kOccupiedBit) {
      node->setLogOdds(tree_->getClampingThresMaxLog());
    } else if (states == kFreeBit) {
      node->setLogOdds(tree_->getClampingThresMinLog());
    } else {
      FillChildren(node, block);
    }
  }

  void FillChildren(octomap::OcTreeNode* node, const Block& block) {
    const int half = 1 << (block.level - 1);
    for (unsigned int child = 0; child < 8; ++child) {
      Block part{block.key, block.level - 1};
      for (unsigned int axis = 0; axis < 3; ++axis) {
        if (child >> axis & 1U) part.key[axis] += half;
      }
      const States states = At(part);
      if (states != kUnknownBit) Fill(tree_->createNodeChild(node, child), part, states);
    }
    // Where floors overlap, a block may look mixed and yet come out uniform.
    if (!tree_->pruneNode(node)) node->updateOccupancyChildren();
  }

  const std::vector<FloorVolume>& floors_;
  RootedTree* tree_;
};

}  // namespace

std::shared_ptr<octomap::OcTree> BuildOctree(const std::vector<FloorLayer>& floors,
                                             const OctreeOptions& options,
                                             const HeightBand& heights) {
  assert(options.wall_height_m > 0.0 && options.free_height_m > 0.0);
  double resolution = GridOptions().resolution_m;
  std::vector<FloorVolume> volumes;
  for (const FloorLayer& floor : floors) {
    if (floor.grid->cells.empty()) continue;
    assert(volumes.empty() || floor.grid->resolution_m == resolution);
    resolution = floor.grid->resolution_m;
    volumes.emplace_back(floor, options, heights);
  }
  auto tree = std::make_shared<RootedTree>(resolution);
  TreeBuilder(volumes, tree.get()).Build();
  return tree;
}

}  // namespace masked_mapper
