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
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "masked_mapper/rendering/space_states.hpp"

namespace masked_mapper {

struct SpaceVoteOptions {
  double resolution_m = 0.05;
  std::uint32_t least_hits = 2;  ///< clouds that must have hit what is occupied
  double occupied_ratio = 0.25;  ///< share of hits among votes from which a voxel is occupied
  std::size_t clouds_ahead = 32;
};

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

  void CastFirst();

  SpaceVoteOptions options_;
  std::unique_ptr<Volume> volume_;
  std::deque<Cloud> waiting_;
};

}  // namespace masked_mapper
