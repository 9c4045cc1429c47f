// SPDX-License-Identifier: BSD-3-Clause
// building.mmap: the saved map, one SQLite file from which every export can be written again.
// docs/map_file.md describes its tables.
#pragma once

#include <filesystem>

#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// Writes the file, which must not exist. The same map gives the same bytes. Throws
/// std::runtime_error when it cannot be written.
void WriteMapFile(const MapOrigin& origin, const BuildingMap& result,
                  const std::filesystem::path& path);

}  // namespace masked_mapper
