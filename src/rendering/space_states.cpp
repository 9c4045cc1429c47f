// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/space_votes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace masked_mapper {
namespace {

constexpr std::int32_t kSide = kSpaceBlockSide;

/// What a block lays over the cells below it.
void Flatten(const SpaceBlock& block, std::int32_t low, std::int32_t high, OccupancyGrid* grid,
             const VoxelIndex& origin) {
  std::size_t i = 0;
  for (std::int32_t z = 0; z < kSide; ++z) {
    const std::int32_t height = block.at[2] * kSide + z;
    if (height < low || height >= high) {
      i += static_cast<std::size_t>(kSide * kSide);
      continue;
    }
    for (std::int32_t y = 0; y < kSide; ++y) {
      const std::int32_t row = block.at[1] * kSide + y - origin[1];
      for (std::int32_t x = 0; x < kSide; ++x, ++i) {
        const std::int32_t column = block.at[0] * kSide + x - origin[0];
        Cell& cell =
            grid->cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid->width) +
                        static_cast<std::size_t>(column)];
        cell = std::max(cell, block.cells[i]);
      }
    }
  }
}

}  // namespace

SpaceStates::SpaceStates(double resolution_m, std::vector<SpaceBlock> blocks)
    : resolution_m_(resolution_m), blocks_(std::move(blocks)) {
  index_.reserve(blocks_.size());
  for (std::size_t i = 0; i < blocks_.size(); ++i) index_.emplace(KeyOfPlace(blocks_[i].at), i);
}

const SpaceBlock* SpaceStates::BlockAt(const VoxelIndex& at) const {
  const auto found = index_.find(KeyOfPlace(at));
  return found == index_.end() ? nullptr : &blocks_[found->second];
}

Cell SpaceStates::At(const VoxelIndex& voxel) const {
  const SpaceBlock* const block = BlockAt(BlockOf(voxel));
  return block == nullptr ? Cell::kUnknown : block->cells[PlaceInBlock(voxel)];
}

OccupancyGrid GridBetween(const SpaceStates& states, double low_m, double high_m) {
  OccupancyGrid grid;
  grid.resolution_m = states.resolution_m();
  if (states.blocks().empty()) return grid;
  VoxelIndex first = states.blocks().front().at;
  VoxelIndex last = first;
  for (const SpaceBlock& block : states.blocks()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = std::min(first[axis], block.at[axis]);
      last[axis] = std::max(last[axis], block.at[axis]);
    }
  }
  const VoxelIndex origin{first[0] * kSide, first[1] * kSide, 0};
  grid.origin_x = origin[0] * grid.resolution_m;
  grid.origin_y = origin[1] * grid.resolution_m;
  grid.width = (last[0] - first[0] + 1) * kSide;
  grid.height = (last[1] - first[1] + 1) * kSide;
  grid.cells.resize(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  const auto low = static_cast<std::int32_t>(std::floor(low_m / grid.resolution_m + 1e-6));
  const auto high = static_cast<std::int32_t>(std::ceil(high_m / grid.resolution_m - 1e-6));
  for (const SpaceBlock& block : states.blocks()) Flatten(block, low, high, &grid, origin);
  return grid;
}

}  // namespace masked_mapper
