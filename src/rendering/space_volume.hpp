// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "masked_mapper/rendering/octree.hpp"
#include "octree_volume.hpp"

namespace masked_mapper {

/// Throws InputError when voxels lie beyond the tree's reach. The states must outlive it.
std::unique_ptr<Volume> VolumeOf(const SpaceStates& states, const HeightBand& heights);

}  // namespace masked_mapper
