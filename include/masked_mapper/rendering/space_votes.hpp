// SPDX-License-Identifier: BSD-3-Clause
// Free, occupied or unknown in space, from the clouds of a 3D lidar on one floor. Every cloud has
// one vote per voxel: what it hit in one was there, what its rays passed was not. So one who walked
// by is outvoted by all who saw the wall behind.
//
// Rays that come in flat would pass, again and again, through the floor in which they end at last.
// A ray therefore says nothing of the layer about the surface that it hits: it ends where it comes
// within a good voxel's side of it. What the surface is, the hits of a neighbourhood tell together;
// rays are cast once the robot has gone on by some clouds, so that it is known by then.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
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

/// What == of the arrays is, without a call.
inline bool IsSame(const VoxelIndex& a, const VoxelIndex& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// The place of a voxel's block.
inline VoxelIndex BlockOf(const VoxelIndex& voxel) {
  return {voxel[0] >> kSpaceBlockBits, voxel[1] >> kSpaceBlockBits, voxel[2] >> kSpaceBlockBits};
}

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

struct SpaceVoteOptions {
  double resolution_m = 0.05;
  std::uint32_t least_hits = 2;  ///< clouds that must have hit what is occupied
  double occupied_ratio = 0.25;  ///< share of hits among votes from which a voxel is occupied
  std::size_t clouds_ahead = 32;
  int threads = 1;
};

class CloudRays;

class SpaceVotes {
 public:
  explicit SpaceVotes(const SpaceVoteOptions& options);
  ~SpaceVotes();
  SpaceVotes(SpaceVotes&&) noexcept;
  SpaceVotes& operator=(SpaceVotes&&) = delete;

  /// Returns of one cloud and the lidar that they came back to, in world, m. Heights of the floor
  /// and of the ceiling: surfaces that rays meet flat long before their neighbourhood is seen.
  void Add(const Eigen::Vector3d& lidar, std::vector<Eigen::Vector3f> ends, double floor_m,
           const std::optional<double>& ceiling_m);

  /// What the votes hold in memory, about.
  std::size_t bytes() const;

  /// Casts what waits, and counts. The votes are gone then.
  SpaceStates Count();

 private:
  struct Cloud;
  class Volume;
  class Casting;

  void CastFirst();
  void TakeVotes();

  SpaceVoteOptions options_;
  std::unique_ptr<Volume> volume_;
  std::unique_ptr<CloudRays> added_;  ///< what was hit by the cloud that is being added
  std::deque<Cloud> waiting_;
  std::unique_ptr<Casting> casting_;
};

}  // namespace masked_mapper
