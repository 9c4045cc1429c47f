// SPDX-License-Identifier: BSD-3-Clause
// A map that is finished: it goes into its folder first, as building.mmap, and is exported from
// there, so that nothing that goes wrong in exporting loses it.
#pragma once

#include <string>

#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// Puts the map alone into OUT. Throws InputError or std::runtime_error when that cannot be.
void KeepMap(const MapOrigin& origin, BuildingMap& result, const std::string& out,
             ExistingFolder existing);

/// Whether both are drawn and filled with the same options.
bool IsDrawnSo(const MapOrigin& before, const MapOrigin& now);

/// Whether OUT holds every file that the map is exported as.
bool IsComplete(const BuildingMap& result, const std::string& out);

enum class MapFileNow {
  kAsItIs,  ///< building.mmap in OUT is of this map
  kNew,     ///< it says other options, and is written anew with the rest
};

/// What is advised to who has the map, but not all of its exports.
enum class ExportAdvice {
  kResume,  ///< the same command with --resume, or `export`
  kExport,  ///< `export` alone
};

/// Writes into OUT, which holds the map, all that it is exported as. What could not be written is a
/// std::runtime_error that says how to go on; the rest is there then, unless OUT was complete.
Summary ExportMap(const SavedMap& map, const std::string& out, MapFileNow map_file,
                  ExportAdvice advice);

}  // namespace masked_mapper
