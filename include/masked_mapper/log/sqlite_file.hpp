// SPDX-License-Identifier: BSD-3-Clause
// What can be said of a SQLite file without SQLite.
#pragma once

#include <filesystem>
#include <string>

namespace masked_mapper {

/// Whether the file is there, can be read, and begins as SQLite's do.
bool BeginsAsSqlite(const std::filesystem::path& path);

/// The path as the URI that SQLite opens; a few characters mean something else there.
std::string SqliteUri(const std::filesystem::path& path);

}  // namespace masked_mapper
