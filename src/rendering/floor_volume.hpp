// SPDX-License-Identifier: BSD-3-Clause
// One floor's grid in three dimensions: walls as columns, free space as a slab.
#pragma once

#include <memory>

#include "masked_mapper/rendering/octree.hpp"
#include "octree_volume.hpp"

namespace masked_mapper {

/// Throws InputError when the floor lies beyond the tree's reach. The layer's grid must outlive it.
std::unique_ptr<Volume> VolumeOf(const FloorLayer& layer, const OctreeOptions& options,
                                 const HeightBand& heights);

}  // namespace masked_mapper
