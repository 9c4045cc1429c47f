// SPDX-License-Identifier: BSD-3-Clause
// Which voxels of a floor are free, occupied or unknown, in world.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// A voxel covers [index, index + 1) * resolution along each axis.
using VoxelIndex = std::array<std::int32_t, 3>;

constexpr int kSpaceBlockBits = 4;
constexpr int kSpaceBlockSide = 1 << kSpaceBlockBits;
constexpr std::size_t kSpaceBlockVoxels = std::size_t{1} << (3 * kSpaceBlockBits);

/// A cube of voxels; `at` is its place in sides of such cubes.
struct SpaceBlock {
  VoxelIndex at{};
  std::array<Cell, kSpaceBlockVoxels> cells{};
};

/// Where in its block a voxel stands: x changes fastest.
inline std::size_t PlaceInBlock(const VoxelIndex& voxel) {
  constexpr std::int32_t kMask = kSpaceBlockSide - 1;
  return static_cast<std::size_t>(((voxel[2] & kMask) << (2 * kSpaceBlockBits)) |
                                  ((voxel[1] & kMask) << kSpaceBlockBits) | (voxel[0] & kMask));
}

/// One number of three that each lie within a million of 0.
inline std::uint64_t KeyOfPlace(const VoxelIndex& at) {
  constexpr int kBits = 21;
  constexpr std::int32_t kHalf = 1 << (kBits - 1);
  std::uint64_t key = 0;
  for (const std::int32_t part : at) key = key << kBits | static_cast<std::uint32_t>(part + kHalf);
  return key;
}

class SpaceStates {
 public:
  SpaceStates() = default;
  SpaceStates(double resolution_m, std::vector<SpaceBlock> blocks);

  double resolution_m() const { return resolution_m_; }
  const std::vector<SpaceBlock>& blocks() const { return blocks_; }
  Cell At(const VoxelIndex& voxel) const;
  /// The block that stands there; null: all of it is unknown.
  const SpaceBlock* BlockAt(const VoxelIndex& at) const;

 private:
  double resolution_m_ = GridOptions().resolution_m;
  std::vector<SpaceBlock> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
};

/// The floor as a robot meets it: a cell is occupied where a voxel between two heights (m, in
/// world) is, else free where one is. Walls have no points.
OccupancyGrid GridBetween(const SpaceStates& states, double low_m, double high_m);

}  // namespace masked_mapper
