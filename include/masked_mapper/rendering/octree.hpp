// SPDX-License-Identifier: BSD-3-Clause
// The OctoMap of a building, filled from the grids of its floors: walls as columns, free space as a
// slab. A free layer of one voxel cannot be pruned and makes trees of millions of nodes; a slab
// that is a power of two thick and starts at a multiple of its thickness collapses into few large
// cubes.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace octomap {
class OcTree;
}

namespace masked_mapper {

class SpaceStates;

struct OctreeOptions {
  double wall_height_m = 1.6;  ///< walls reach from the floor's elevation up to here
  double free_height_m = 0.8;  ///< thickness of free space, rounded to a power of two of voxels
};

struct FloorLayer {
  const OccupancyGrid* grid = nullptr;
  double elevation = 0.0;  ///< m
};

/// Heights in world, m.
struct HeightBand {
  double low_m = -std::numeric_limits<double>::infinity();
  double high_m = std::numeric_limits<double>::infinity();

  bool operator==(const HeightBand& other) const {
    return low_m == other.low_m && high_m == other.high_m;
  }
  bool operator!=(const HeightBand& other) const { return !(*this == other); }
};

/// A pruned tree as OctoMap's binary files hold it: unknown, free or occupied.
struct OctreeData {
  double resolution_m = 0.0;
  std::size_t nodes = 0;
  std::string bytes;  ///< of the nodes with children: two bits for each child, depth first
};

/// The tree itself, of about a hundred times the size.
std::shared_ptr<octomap::OcTree> OcTreeOf(const OctreeData& data);

/// A tree whose voxels are the grids' cells: an occupied cell is a wall column that starts
/// at the floor's elevation; a free cell is free in the first aligned slab at or above it (so less
/// than `free_height_m` above it; inside the walls' height as long as walls are twice as high as
/// the slab). Where floors overlap, a wall of one outvotes the free space of another. All grids
/// have one resolution; empty ones are ignored. Throws InputError when the building reaches beyond
/// what the tree's 16-bit keys can address (32768 voxels from the origin). Voxels with their middle
/// outside `heights` are left out.
OctreeData BuildOctree(const std::vector<FloorLayer>& floors, const OctreeOptions& options,
                       const HeightBand& heights = {});

/// The same of what 3D lidars saw: each voxel as it is. Where floors overlap, an occupied voxel of
/// one outvotes a free one of another. All have one resolution. Throws as above.
OctreeData BuildSpaceOctree(const std::vector<const SpaceStates*>& floors,
                            const HeightBand& heights = {});

}  // namespace masked_mapper
