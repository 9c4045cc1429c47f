// SPDX-License-Identifier: BSD-3-Clause
#include "saved_map_path.hpp"

#include <fstream>
#include <string_view>

#include "masked_mapper/log/open_bag.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

bool IsOutOrMap(const std::string& path) {
  // ROS 2 bags are folders and SQLite files as well.
  if (std::filesystem::is_directory(path)) {
    return std::filesystem::exists(std::filesystem::path(path) / kMapFileName) || !IsBag(path);
  }
  if (std::filesystem::path(path).extension() == ".db3") return false;
  constexpr std::string_view kDatabase("SQLite format 3\0", 16);
  std::string start(kDatabase.size(), '\0');
  std::ifstream in(path, std::ios::binary);
  return in.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kDatabase;
}

std::filesystem::path MapFileOf(const std::string& out_or_map) {
  if (!std::filesystem::is_directory(out_or_map)) return out_or_map;
  std::filesystem::path file = std::filesystem::path(out_or_map) / kMapFileName;
  if (!std::filesystem::exists(file)) {
    throw InputError(out_or_map + ": holds no map (no building.mmap in it)");
  }
  return file;
}

}  // namespace masked_mapper
