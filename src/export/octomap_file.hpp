// SPDX-License-Identifier: BSD-3-Clause
// OctoMap's binary format (.bt): free, occupied, or unknown.
#pragma once

#include <filesystem>

#include "masked_mapper/rendering/octree.hpp"

namespace masked_mapper {

/// Throws std::runtime_error when the file cannot be written.
void WriteOctomap(const OctreeData& tree, const std::filesystem::path& path);

}  // namespace masked_mapper
