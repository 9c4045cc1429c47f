// SPDX-License-Identifier: BSD-3-Clause
// What an octree is filled from: something that tells of a cube which states its voxels have.
#pragma once

#include <array>
#include <cstdint>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

constexpr int kTreeDepth = 16;
constexpr int kKeyOfOrigin = 1 << (kTreeDepth - 1);

/// What the voxels of a region may be, as a set.
using States = std::uint8_t;
constexpr States kUnknownBit = 1 << static_cast<int>(Cell::kUnknown);
constexpr States kFreeBit = 1 << static_cast<int>(Cell::kFree);
constexpr States kOccupiedBit = 1 << static_cast<int>(Cell::kOccupied);

/// Keys [low, high) along one axis.
struct KeyRange {
  int low = 0;
  int high = 0;
};

/// Throws InputError when a tree of such voxels does not reach so far.
KeyRange CheckedKeys(double first_cell, double count, double resolution_m);

/// A cube of 2^level voxels a side, aligned to the tree.
struct Block {
  std::array<int, 3> key{};
  int level = 0;
};

class Volume {
 public:
  virtual ~Volume() = default;
  /// The states that voxels of the block may have; of a single one, the one that it has.
  virtual States At(const Block& block) const = 0;
};

}  // namespace masked_mapper
