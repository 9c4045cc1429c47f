// SPDX-License-Identifier: BSD-3-Clause
// The voxels that one cloud of a lidar hit, and those that its rays passed: each once, however many
// rays did. Places are in voxels, the side of one being 1.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "masked_mapper/rendering/space_votes.hpp"

namespace masked_mapper {

/// Farther from the origin no voxel is told from others.
constexpr std::int32_t kFarthestVoxel = 1 << 19;

class CloudRays {
 public:
  /// One bit for each voxel of a block, by PlaceInBlock().
  using Bits = std::array<std::uint64_t, kSpaceBlockVoxels / 64>;
  struct Block {
    VoxelIndex at{};  ///< in sides of blocks
    Bits hit{};
    Bits passed{};
    /// Blocks before and behind along x, y, z; -1: not known.
    std::array<std::int32_t, 6> beside{};
  };

  /// Forgets the cloud before. Places lie within kFarthestVoxel of the origin.
  void Begin(const Eigen::Vector3d& lidar);

  /// Whether it is the first hit of the voxel.
  bool Hit(const VoxelIndex& voxel);

  /// From the far end of a ray to the lidar. Where its way is one with that of an earlier ray it
  /// ends: from there on the two are less than a voxel apart.
  void Pass(const Eigen::Vector3d& end);

  const std::vector<Block>& blocks() const { return blocks_; }
  std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  std::size_t PlaceOf(const VoxelIndex& at);
  std::size_t PlaceBeside(std::size_t block, const VoxelIndex& at);
  void GoTo(const VoxelIndex& at);
  bool Mark(const VoxelIndex& voxel);
  template <int kMain>
  void PassAlong(const Eigen::Vector3d& end, double length);

  Eigen::Vector3d lidar_ = Eigen::Vector3d::Zero();
  std::vector<Block> blocks_;
  std::unordered_map<std::uint64_t, std::int32_t> index_;
  std::size_t last_ = 0;  // the block that was asked for last
};

}  // namespace masked_mapper
