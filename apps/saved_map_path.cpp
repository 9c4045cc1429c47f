// SPDX-License-Identifier: BSD-3-Clause
#include "saved_map_path.hpp"

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/log/sqlite_file.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

bool IsOutOrMap(const std::string& path) {
  // ROS 2 bags are folders and SQLite files as well.
  if (std::filesystem::is_directory(path)) {
    return std::filesystem::exists(std::filesystem::path(path) / kMapFileName) || !IsBag(path);
  }
  if (std::filesystem::path(path).extension() == ".db3") return false;
  return BeginsAsSqlite(path);
}

std::filesystem::path MapFileOf(const std::string& out_or_map) {
  if (!std::filesystem::is_directory(out_or_map)) return out_or_map;
  std::filesystem::path file = std::filesystem::path(out_or_map) / kMapFileName;
  if (!std::filesystem::exists(file)) {
    throw InputError(out_or_map + ": holds no map (no " + std::string(kMapFileName) + " in it)");
  }
  return file;
}

}  // namespace masked_mapper
