// SPDX-License-Identifier: BSD-3-Clause
// A map as it is kept: what was asked for, and what came of it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

/// What a map was made from.
struct MapOrigin {
  std::string log;   ///< path as given
  std::string mask;  ///< expression as given
  Options options;   ///< as given; the number of threads is not kept

  /// Of several logs: those after the first.
  struct LaterLog {
    std::string log;     ///< path as given
    std::string floors;  ///< its file of floor labels; empty: none
  };
  std::vector<LaterLog> later_logs = {};
  std::string onto = {};      ///< the map that the logs were to join, path as given; empty: none
  std::string so_far = {};    ///< of a log that was still coming: how far it was; empty: all of it
  std::string identity = {};  ///< of a map in the making: what tells whether its logs have changed
};

struct SavedMap {
  MapOrigin origin;
  BuildingMap result;  ///< without its seconds, in which two runs differ
  /// What of the file was not understood and left aside, one line each, for people.
  std::vector<std::string> left_aside = {};
};

/// The file of a map in the folder that `map` writes.
constexpr const char* kMapFileName = "building.mmap";

using NamedValues = std::vector<std::pair<std::string, std::string>>;

/// Key and value of every option that differs from its default, but for the number of threads.
NamedValues ChangedOptions(const Options& options);

/// Whether an option says only how a finished map is drawn (`grid.*`, `octree.*`): it may be
/// another one each time that the map is exported.
bool IsOfDrawing(const std::string& option_key);

/// Everything that the map depends on, but for the program.
NamedValues KeyOf(const MapOrigin& origin);

/// In words, how one key differs from the other: "matcher.min_score was 0.425, now it is 0.5";
/// empty when it does not.
std::string FirstDifference(const NamedValues& before, const NamedValues& now);

/// The same of how another run differs from the one that made a map or a checkpoint.
std::string DifferenceFrom(const MapOrigin& before, const MapOrigin& now);

/// Reads it back, whole or not at all: the map as it was written, but for its seconds. Throws
/// InputError when there is no such file, when it is no saved map, was written by a newer program,
/// or is damaged in any way.
SavedMap ReadMapFile(const std::filesystem::path& path);

/// Writes building.mmap, one SQLite file from which every export can be written again (its tables:
/// docs/map_file.md). It must not exist. The same map gives the same bytes. Throws
/// std::runtime_error when it cannot be written.
void WriteMapFile(const MapOrigin& origin, const BuildingMap& result,
                  const std::filesystem::path& path);

}  // namespace masked_mapper
