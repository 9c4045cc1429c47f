// SPDX-License-Identifier: BSD-3-Clause
#include "map_drives.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "masked_mapper/joining/drive_joining.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/mapping/map_log.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

/// One log as it is asked for among several.
MapOrigin OriginOfDrive(const MapOrigin& origin, std::size_t drive) {
  MapOrigin own = origin;
  if (drive == 0) return own;
  own.log = origin.later_logs[drive - 1].log;
  own.options.mapping.floors.file = origin.later_logs[drive - 1].floors;
  return own;
}

/// Maps one of the logs, unless it is done already.
BuildingMap MapDrive(const MapArguments& arguments, const MapOrigin& origin, std::size_t drive,
                     LogSource& source, Keeping& keeping, ProgressSink& progress) {
  const bool is_alone = keeping.drives == 1 && origin.onto.empty();
  if (!is_alone) {
    std::optional<BuildingMap> done = keeping.finished.Load(drive);
    if (done) return std::move(*done);
  }
  const MapOrigin own = OriginOfDrive(origin, drive);
  keeping.checkpoints = std::make_unique<CheckpointFile>(
      arguments.out, origin, arguments.checkpoint_s, arguments.resume, drive);
  // What came through a pipe is gone when the program ends: there is nothing to go on with.
  CheckpointStore* const store = source.is_stream() ? nullptr : keeping.checkpoints.get();
  BuildingMap map = MapLog(source, own.mask, own.options.mapping, progress, store);
  const bool is_worth_keeping = keeping.checkpoints->HasCheckpoint() ||
                                keeping.finished.count() > 0 || keeping.checkpoints->IsDue();
  if (is_alone || !is_worth_keeping || store == nullptr) return map;
  if (arguments.checkpoint_s == 0.0) return map;
  keeping.checkpoints.reset();
  try {
    keeping.finished.Save(drive, map);
  } catch (const std::runtime_error& error) {
    // As with checkpoints: a full disk must not end what needs none of it.
    progress.Warn(std::string(error.what()) + "; going on without keeping the drive");
  }
  return map;
}

}  // namespace

void WarnOfLeftAside(const std::string& name, const SavedMap& map, ProgressSink& progress) {
  for (const std::string& line : map.left_aside) progress.Warn(name + ": " + line);
}

BuildingMap MapLogs(const MapArguments& arguments, const MapOrigin& origin,
                    const LogSources& sources, Keeping& keeping, ProgressSink& progress) {
  std::vector<BuildingMap> maps;
  double onto_seconds = 0.0;
  if (!origin.onto.empty()) {
    const StageTimer timer(onto_seconds);
    progress.Stage("reading " + origin.onto);
    SavedMap old = ReadMapFile(MapFileOf(origin.onto));
    WarnOfLeftAside(origin.onto, old, progress);
    maps.push_back(std::move(old.result));
    if (maps.back().trajectory.empty() || maps.back().drives.empty()) {
      throw InputError(origin.onto + ": a map without a scan cannot be grown");
    }
  }
  for (std::size_t drive = 0; drive < keeping.drives; ++drive) {
    maps.push_back(MapDrive(arguments, origin, drive, *sources[drive], keeping, progress));
  }
  BuildingMap map = JoinDrives(std::move(maps), origin.options.drive_joins,
                               origin.options.mapping.closures, progress);
  map.seconds.read += onto_seconds;
  map.seconds.total += onto_seconds;
  return map;
}

}  // namespace masked_mapper
