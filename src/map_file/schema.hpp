// SPDX-License-Identifier: BSD-3-Clause
// The tables of a saved map (docs/map_file.md), and how its bytes are vouched for.
#pragma once

#include <cstdint>
#include <string>

#include "database.hpp"

namespace masked_mapper {

constexpr std::int64_t kMapApplicationId = 0x4d6d6170;  // "Mmap"
constexpr std::int64_t kMapVersion = 6;

/// The newest versions that know no edges of kind heading, and that have no table for clouds
/// either. Maps without any are written as these, for older programs to read.
constexpr std::int64_t kMapVersionWithoutHeadings = 5;
constexpr std::int64_t kMapVersionWithoutClouds = 4;

/// Makes the tables of one of these three versions in an empty database.
void MakeTables(Database& database, std::int64_t version);

/// Says in table `content` how many rows each table has and what their checksum is.
void Seal(Database& database);

/// Throws DatabaseError when the file is not whole: its pages, its tables, the checksums of their
/// rows. `version` is the file's, between 1 and kMapVersion.
void CheckSeal(Database& database, std::int64_t version);

/// Adds to the tables of a version before kMapVersionWithoutClouds what that has in them. Table
/// `attempts`, which `closures` stands for since version 3, stays as it is.
void Upgrade(Database& database, std::int64_t version);

}  // namespace masked_mapper
