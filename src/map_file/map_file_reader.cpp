// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <fstream>
#include <string>
#include <system_error>

#include "database.hpp"
#include "map_tables.hpp"
#include "masked_mapper/log/sqlite_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "schema.hpp"

namespace masked_mapper {
namespace {

// What can be said before SQLite looks at the file, in clearer words than SQLite has.
std::uint64_t CheckIsDatabase(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path.string() + ": not a file");
  }
  if (!std::ifstream(path, std::ios::binary)) throw InputError(path.string() + ": cannot be read");
  if (!BeginsAsSqlite(path)) throw InputError(path.string() + ": not a saved map");
  return std::filesystem::file_size(path, error);
}

}  // namespace

SavedMap ReadMapFile(const std::filesystem::path& path) {
  const std::uint64_t size = CheckIsDatabase(path);
  try {
    Database database(path, OpenMode::kRead);
    if (database.Number("PRAGMA application_id") != kMapApplicationId) {
      throw InputError(path.string() + ": not a saved map, but another database");
    }
    const std::int64_t version = database.Number("PRAGMA user_version");
    if (version > kMapVersion) {
      throw InputError(path.string() + ": written by a newer program (map version " +
                       std::to_string(version) + ", this one reads up to " +
                       std::to_string(kMapVersion) + ")");
    }
    if (version < 1) throw DatabaseError("it has no version");
    CheckSeal(database, version);
    if (version >= kMapVersionWithoutClouds) return ReadTables(database, version, size);
    Database upgraded = Database::CopyInMemory(database);
    Upgrade(upgraded, version);
    return ReadTables(upgraded, version, size);
  } catch (const DatabaseError& error) {
    throw InputError(path.string() + ": damaged, cannot be used: " + error.what());
  }
}

}  // namespace masked_mapper
