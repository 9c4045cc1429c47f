// SPDX-License-Identifier: BSD-3-Clause
#include "map_run.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "finished_map.hpp"
#include "interrupt.hpp"
#include "live_input.hpp"
#include "map_drives.hpp"
#include "map_so_far.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map_file/checkpoint_file.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "progress_bar.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

/// Whether OUT holds what came of a log before it was over, and nobody finished it.
bool HoldsMapSoFar(const std::string& out) {
  const std::filesystem::path file = std::filesystem::path(out) / kMapFileName;
  return std::filesystem::exists(file) && !ReadMapFile(file).origin.so_far.empty();
}

/// What stands in the way of writing to OUT.
ExistingFolder HowToTreat(const MapArguments& arguments) {
  if (arguments.force) return ExistingFolder::kReplace;
  const bool is_empty =
      std::filesystem::is_directory(arguments.out) && std::filesystem::is_empty(arguments.out);
  const bool may_go_on = arguments.resume && (is_empty || HoldsMapSoFar(arguments.out));
  return may_go_on ? ExistingFolder::kReplace : ExistingFolder::kRefuse;
}

/// The map that is asked for, when OUT holds it already. Throws InputError when it holds another.
std::optional<SavedMap> FinishedMap(const MapArguments& arguments, const MapOrigin& origin) {
  const std::filesystem::path file = std::filesystem::path(arguments.out) / kMapFileName;
  if (!arguments.resume || arguments.force || !std::filesystem::exists(file)) return {};
  SavedMap map = ReadMapFile(file);
  if (!map.origin.so_far.empty()) return {};
  const std::string difference = DifferenceFrom(map.origin, origin);
  if (difference.empty()) return map;
  throw InputError(arguments.out + " holds a finished map that was made otherwise: " + difference +
                   "; --force replaces it");
}

/// Mends the map; empty, or why it stays as it is.
std::string EditFault(const MapArguments& arguments, const Options& options, BuildingMap& map) {
  if (arguments.edits.empty()) return "";
  double seconds = 0.0;
  try {
    const StageTimer timer(seconds);
    ApplyEdits(arguments.edits, options.mapping.closures, map);
  } catch (const InputError& error) {
    return error.what();
  }
  map.seconds.optimisation += seconds;
  map.seconds.total += seconds;
  return "";
}

/// What to add to the word of a run that ended early and left something.
std::string WhatIsKept(const Keeping& keeping, const std::string& out) {
  if (!keeping.HasAnything()) return "; the map so far stays in " + out;
  return "; " + std::to_string(keeping.Percent()) + " % of the " +
         (keeping.drives > 1 ? "logs" : "log") + " is kept: the same command with --resume goes on";
}

/// The words for who has the map, but not all that it is exported as.
ExportAdvice HowToExport(const MapArguments& arguments) {
  // With edits the map that is kept is not the one that the command would make.
  if (!arguments.edits.empty()) return ExportAdvice::kExport;
  return ExportAdvice::kResume;
}

/// Files of each log: one, or the parts of a recording that was split.
using Recordings = std::vector<std::vector<std::string>>;

std::string NameOf(const std::vector<std::string>& files) {
  std::string name;
  for (const std::string& file : files) name += (name.empty() ? "" : " + ") + file;
  return name;
}

/// The file of floors of a log; of one in parts, the first that is given for any of them.
std::string FloorsOf(const std::vector<std::string>& files, const MapArguments& arguments,
                     const std::string& of_all) {
  if (arguments.floors.empty()) return of_all;
  for (std::size_t i = 0; i < arguments.logs.size(); ++i) {
    const bool is_part = std::find(files.begin(), files.end(), arguments.logs[i]) != files.end();
    if (is_part && arguments.floors[i] != "-") return arguments.floors[i];
  }
  return "";
}

MapOrigin OriginOf(const MapArguments& arguments, const Recordings& recordings, Options options) {
  const std::size_t given = arguments.floors.size();
  if (given > 0 && given != arguments.logs.size()) {
    throw InputError("--floors is given " + std::to_string(given) + " times for " +
                     std::to_string(arguments.logs.size()) +
                     " logs: once for each, in their order, `-` for none");
  }
  const auto floors_of = [&](std::size_t log) {
    return FloorsOf(recordings[log], arguments, options.mapping.floors.file);
  };
  MapOrigin origin;
  origin.log = NameOf(recordings.front());
  origin.mask = arguments.mask;
  for (std::size_t i = 1; i < recordings.size(); ++i) {
    origin.later_logs.push_back({NameOf(recordings[i]), floors_of(i)});
  }
  origin.onto = arguments.onto;
  options.mapping.floors.file = floors_of(0);
  origin.options = std::move(options);
  CheckOptions(origin.options);
  return origin;
}

/// Maps and puts the map into OUT, where nothing loses it any more.
BuildingMap MakeMap(const MapArguments& arguments, const MapOrigin& origin,
                    const LogSources& sources, ExistingFolder existing, Keeping& keeping,
                    ProgressBar& progress) {
  BuildingMap result;
  std::string edit_fault;
  try {
    result = MapLogs(arguments, origin, sources, keeping, progress);
    edit_fault = EditFault(arguments, origin.options, result);
    progress.Stage("writing");
    KeepMap(origin, result, arguments.out, existing);
  } catch (const InputError&) {
    throw;  // what is at fault is still so when the same command is run again
  } catch (const Interrupted&) {
    if (!keeping.HasAnything() && !keeping.has_map_so_far) throw;
    throw Interrupted("interrupted" + WhatIsKept(keeping, arguments.out));
  } catch (const std::runtime_error& error) {
    if (!keeping.HasAnything() && !keeping.has_map_so_far) throw;
    throw std::runtime_error(error.what() + WhatIsKept(keeping, arguments.out));
  }
  keeping.checkpoints.reset();
  keeping.finished.Remove();
  if (!edit_fault.empty()) {
    throw InputError(edit_fault + "; the map is kept in " + arguments.out +
                     " as it was before the edits: `export " + arguments.out +
                     " --format all --edits FILE -o NEW` edits it");
  }
  return result;
}

/// Goes on from a finished map: writes what is not there, or all when it is to be drawn otherwise.
int ResumeFinished(const MapArguments& arguments, const MapOrigin& origin, SavedMap map,
                   ProgressBar& progress) {
  if (!arguments.edits.empty()) {
    throw InputError(arguments.out + " is finished already: `export " + arguments.out +
                     " --format all --edits " + arguments.edits + " -o NEW` edits it");
  }
  WarnOfLeftAside(arguments.out, map, progress);
  const bool is_drawn_so = IsDrawnSo(map.origin, origin);
  if (is_drawn_so && IsComplete(map.result, arguments.out)) {
    if (!arguments.quiet) std::cout << "map: " << arguments.out << " is finished already\n";
    return 0;
  }
  progress.Stage("writing");
  map.origin.options.grid = origin.options.grid;
  map.origin.options.octree = origin.options.octree;
  const Summary summary =
      ExportMap(map, arguments.out, is_drawn_so ? MapFileNow::kAsItIs : MapFileNow::kNew,
                HowToExport(arguments));
  progress.Finish();
  if (!arguments.quiet) std::cout << ClosingTable(summary) << "map: " << arguments.out << "\n";
  return 0;
}

Options AskedOptions(const MapArguments& arguments) {
  Options options = ReadOptions(arguments.options);
  if (!arguments.threads.empty()) SetOption("--threads", "threads", arguments.threads, options);
  if (arguments.forget) options.grid.forget = true;
  CheckOptions(options);
  SettleThreads(options);
  return options;
}

/// A log that comes live, when it is over.
std::unique_ptr<LogSource> Listen(const MapArguments& arguments, const MapOrigin& origin,
                                  ExistingFolder existing, Keeping& keeping,
                                  ProgressBar& progress) {
  CatchRequests();
  LiveInput input(origin.log);
  MapSoFar so_far(arguments, origin, input.kept_path(), existing, progress);
  try {
    input.Listen([&](std::string_view bytes) { so_far.Note(bytes); }, [&] { so_far.Look(); },
                 progress);
  } catch (const InputError& error) {
    if (!so_far.Finish()) throw;
    throw InputError(std::string(error.what()) + "; the map so far stays in " + arguments.out);
  }
  keeping.has_map_so_far = so_far.Finish();
  return input.Source(origin.options.mapping.log);
}

LogSources OpenAll(const Recordings& recordings, const LogOptions& options) {
  LogSources sources;
  for (const std::vector<std::string>& files : recordings) {
    sources.push_back(OpenRecording(files, options));
  }
  return sources;
}

/// Whether the log is one that comes live. Throws InputError where flags need one that is.
bool ComesLive(const MapArguments& arguments) {
  const bool is_pipe =
      arguments.logs.size() == 1 && arguments.logs.front() == "-" && Spool::IsStream("/dev/stdin");
  const bool is_live = is_pipe || !arguments.follow.empty();
  if (arguments.every_s > 0.0 && !is_live) {
    throw InputError("--every is for a log that comes live: `-` from a pipe, or --follow FILE");
  }
  return is_live;
}

/// What must not be found out after an hour of mapping.
void CheckInputs(const MapArguments& arguments, const MapOrigin& origin) {
  if (!origin.onto.empty()) MapFileOf(origin.onto);
  if (!arguments.edits.empty() && !std::filesystem::exists(arguments.edits)) {
    throw InputError(arguments.edits + ": no such list of edits");
  }
}

}  // namespace

int RunMap(const MapArguments& asked) {
  if (asked.logs.empty() && asked.follow.empty()) {
    throw InputError("map: LOG is required, or --follow FILE");
  }
  if (!asked.logs.empty() && !asked.follow.empty()) {
    throw InputError("map: expected LOG or --follow FILE, one of the two");
  }
  MapArguments arguments = asked;
  if (!asked.follow.empty()) arguments.logs = {asked.follow};
  const bool is_live = ComesLive(arguments);
  Options options = AskedOptions(arguments);
  MakeMask(arguments.mask, options.mapping.masks);  // throws before the log is looked at
  // Before the work: an hour of mapping must not end in "exists already".
  ExistingFolder existing = HowToTreat(arguments);
  const Recordings recordings = RecordingsOf(arguments.logs);
  const MapOrigin origin = OriginOf(arguments, recordings, std::move(options));
  CheckInputs(arguments, origin);
  Keeping keeping{FinishedDrives(arguments.out, origin, arguments.resume), nullptr,
                  recordings.size()};
  CatchInterrupts();
  ProgressBar progress(arguments.quiet);
  if (std::optional<SavedMap> finished = FinishedMap(arguments, origin)) {
    keeping.finished.Remove();  // the program may have ended between the two
    return ResumeFinished(arguments, origin, std::move(*finished), progress);
  }
  CheckOutputFolder(arguments.out, existing);
  if (!arguments.resume && !arguments.force && CheckpointFile::Exists(arguments.out)) {
    throw InputError("an unfinished map of " + arguments.out +
                     " is there: --resume goes on with it, --force starts afresh");
  }
  LogSources sources;
  if (is_live) {
    sources.push_back(Listen(arguments, origin, existing, keeping, progress));
    if (keeping.has_map_so_far) existing = ExistingFolder::kReplace;
  } else {
    sources = OpenAll(recordings, origin.options.mapping.log);
  }
  // What an earlier run left of finished drives must not be taken for this one's.
  const bool keeps_drives = keeping.drives > 1 || !origin.onto.empty();
  if (!arguments.resume && keeps_drives) keeping.finished.Remove();
  SavedMap map{origin, MakeMap(arguments, origin, sources, existing, keeping, progress)};
  const Summary summary =
      ExportMap(map, arguments.out, MapFileNow::kAsItIs, HowToExport(arguments));
  progress.Finish();
  if (!arguments.quiet) std::cout << ClosingTable(summary) << "map: " << arguments.out << "\n";
  return 0;
}

}  // namespace masked_mapper
