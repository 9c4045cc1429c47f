// SPDX-License-Identifier: BSD-3-Clause
// A map from the tables of its file, once the file is known to be whole and its tables are those of
// the newest version.
#pragma once

#include <cstdint>

#include "database.hpp"
#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// Throws DatabaseError when rows do not hold together. `version` is the one that the file was
/// written with. Nothing is allocated that the file, of `file_size` bytes, does not pay for.
SavedMap ReadTables(const Database& database, std::int64_t version, std::uint64_t file_size);

}  // namespace masked_mapper
