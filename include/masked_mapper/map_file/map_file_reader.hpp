// SPDX-License-Identifier: BSD-3-Clause
// Reading building.mmap back, whole or not at all.
#pragma once

#include <filesystem>

#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// The map as it was written, but for its seconds. Throws InputError when there is no such file,
/// when it is no saved map, was written by a newer program, or is damaged in any way.
SavedMap ReadMapFile(const std::filesystem::path& path);

}  // namespace masked_mapper
