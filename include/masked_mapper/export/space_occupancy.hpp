// SPDX-License-Identifier: BSD-3-Clause
// What is free and what is not in the building, in space, by the clouds of the map's log: an octree
// of all floors, and grids of each as a robot of some height meets it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "masked_mapper/export/cloud_poses.hpp"
#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/octree.hpp"
#include "masked_mapper/rendering/space_votes.hpp"

namespace masked_mapper {

/// Above the floor, m: what stands there is in a robot's way.
struct RobotHeights {
  double low_m = 0.1;   ///< lower is a threshold that it drives over, or the floor
  double high_m = 1.0;  ///< higher it passes below
};

struct SpaceOccupancyOptions {
  SpaceVoteOptions votes;
  double max_range_m = 30.0;  ///< farther returns are left out
  CloudSpacing spacing{0.3, 20.0};
  std::optional<FloorId> floor;  ///< empty: all
  HeightBand heights;            ///< of the octree, in world
  double memory_mib = 1024.0;    ///< of votes; floors for which it is too little wait
};

class SpaceOccupancy {
 public:
  /// The map must outlive it.
  SpaceOccupancy(const BuildingMap& map, const SpaceOccupancyOptions& options);

  /// Clouds of the map's log in its order. Throws InputError when one floor alone needs more memory
  /// than there may be.
  void Add(const LevelledCloud& cloud);
  /// After the last cloud of the log: true when floors wait for it to be read once more.
  bool Finish();

  /// What the votes of a floor say of a place in world, once all is seen.
  Cell At(FloorId floor, const Eigen::Vector3d& place_in_world) const;

  const CloudPoses& poses() const { return *poses_; }
  double peak_mib() const { return peak_mib_; }  ///< of votes and what was made of them

  /// Of all floors. Throw std::runtime_error when a file cannot be written.
  void WriteOctree(const std::filesystem::path& path) const;
  /// `stem`.pgm and `stem`.yaml.
  void WriteGrid(FloorId floor, const RobotHeights& heights,
                 const std::filesystem::path& stem) const;

 private:
  struct FloorVotes {
    std::optional<SpaceVotes> votes;
    SpaceStates states;  ///< once all is seen
    bool is_done = false;
    bool waits = false;  ///< for the next pass of the log
  };

  double VotesMib() const;
  void KeepWithinMemory();

  const BuildingMap& map_;
  SpaceOccupancyOptions options_;
  std::optional<CloudPoses> poses_;
  std::vector<FloorVotes> floors_;  ///< by id
  double peak_mib_ = 0.0;
};

}  // namespace masked_mapper
