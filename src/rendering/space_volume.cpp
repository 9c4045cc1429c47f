// SPDX-License-Identifier: BSD-3-Clause
#include "space_volume.hpp"

#include <array>
#include <unordered_map>
#include <vector>

#include "masked_mapper/rendering/space_votes.hpp"

namespace masked_mapper {
namespace {

class SpaceVolume : public Volume {
 public:
  SpaceVolume(const SpaceStates& states, const HeightBand& heights)
      : states_(states), heights_(heights) {
    levels_.resize(kTreeDepth - kSpaceBlockBits + 1);
    for (const SpaceBlock& block : states.blocks()) {
      VoxelIndex at{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CheckedKeys(static_cast<double>(block.at[axis]) * kSpaceBlockSide, kSpaceBlockSide,
                    states.resolution_m());
        at[axis] = block.at[axis] + (kKeyOfOrigin >> kSpaceBlockBits);
      }
      levels_.front()[KeyOfPlace(at)] = {Within(block, FirstOf(block), kSpaceBlockSide), 1};
      Raise(at);
    }
    for (std::size_t level = 1; level < levels_.size(); ++level) {
      for (auto& [key, cube] : levels_[level]) {
        // A cube that is not all there is unknown in part.
        if (cube.blocks != std::uint64_t{1} << (3 * level)) cube.states |= kUnknownBit;
      }
    }
  }

  States At(const Block& block) const override {
    if (block.level >= kSpaceBlockBits) {
      const auto& level = levels_[static_cast<std::size_t>(block.level - kSpaceBlockBits)];
      const auto found = level.find(KeyOfPlace(
          {block.key[0] >> block.level, block.key[1] >> block.level, block.key[2] >> block.level}));
      return found == level.end() ? kUnknownBit : found->second.states;
    }
    VoxelIndex voxel{};
    VoxelIndex at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      voxel[axis] = block.key[axis] - kKeyOfOrigin;
      at[axis] = voxel[axis] >> kSpaceBlockBits;
    }
    const SpaceBlock* const holder = states_.BlockAt(at);
    return holder == nullptr ? kUnknownBit : Within(*holder, voxel, 1 << block.level);
  }

 private:
  struct Cube {
    States states = 0;
    std::uint64_t blocks = 0;  ///< of those that it has room for
  };

  static VoxelIndex FirstOf(const SpaceBlock& block) {
    return {block.at[0] * kSpaceBlockSide, block.at[1] * kSpaceBlockSide,
            block.at[2] * kSpaceBlockSide};
  }

  bool IsWithin(std::int32_t z) const {
    const double middle = (z + 0.5) * states_.resolution_m();
    return middle >= heights_.low_m && middle <= heights_.high_m;
  }

  /// `first`: the lowest voxel of the part that is asked for.
  States Within(const SpaceBlock& block, const VoxelIndex& first, int side) const {
    States states = 0;
    for (int z = 0; z < side; ++z) {
      for (int y = 0; y < side; ++y) {
        if (!IsWithin(first[2] + z)) {
          states |= kUnknownBit;
          continue;
        }
        const std::size_t row = PlaceInBlock({first[0], first[1] + y, first[2] + z});
        for (int x = 0; x < side; ++x) {
          states |= static_cast<States>(
              1 << static_cast<int>(block.cells[row + static_cast<std::size_t>(x)]));
        }
      }
    }
    return states;
  }

  /// The states of a block into all cubes that hold it.
  void Raise(VoxelIndex at) {
    const States states = levels_.front()[KeyOfPlace(at)].states;
    for (std::size_t level = 1; level < levels_.size(); ++level) {
      for (std::int32_t& part : at) part >>= 1;
      Cube& cube = levels_[level][KeyOfPlace(at)];
      cube.states |= states;
      ++cube.blocks;
    }
  }

  const SpaceStates& states_;
  HeightBand heights_;
  std::vector<std::unordered_map<std::uint64_t, Cube>> levels_;  ///< from blocks up to all
};

}  // namespace

std::unique_ptr<Volume> VolumeOf(const SpaceStates& states, const HeightBand& heights) {
  return std::make_unique<SpaceVolume>(states, heights);
}

}  // namespace masked_mapper
