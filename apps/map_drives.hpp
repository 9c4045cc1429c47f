// SPDX-License-Identifier: BSD-3-Clause
// The mapping in `map`: each of the logs by itself, then all of them joined, and what is kept on
// disk meanwhile.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "map_run.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/map/progress_sink.hpp"
#include "masked_mapper/map_file/checkpoint_file.hpp"
#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// What is kept on disk of a map in the making.
struct Keeping {
  FinishedDrives finished;
  std::unique_ptr<CheckpointFile> checkpoints;  ///< of the drive at work
  std::size_t drives = 1;
  bool has_map_so_far = false;  ///< of a log that came live, in OUT

  bool HasAnything() const { return finished.count() > 0 || HasCheckpoint(); }
  /// To be gone on from, in percent of all logs.
  int Percent() const {
    const double part = HasCheckpoint() ? checkpoints->progress() : 0.0;
    const double done = static_cast<double>(finished.count()) + part;
    return static_cast<int>(100.0 * done / static_cast<double>(drives));
  }

 private:
  bool HasCheckpoint() const { return checkpoints && checkpoints->HasCheckpoint(); }
};

/// The logs, each opened once.
using LogSources = std::vector<std::unique_ptr<LogSource>>;

/// Maps every log by itself and joins them, to OLD first of all.
BuildingMap MapLogs(const MapArguments& arguments, const MapOrigin& origin,
                    const LogSources& sources, Keeping& keeping, ProgressSink& progress);

/// Says what of a map that was read was left aside.
void WarnOfLeftAside(const std::string& name, const SavedMap& map, ProgressSink& progress);

}  // namespace masked_mapper
