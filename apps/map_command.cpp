// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper map LOG... -o OUT
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/export/closing_table.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/joining/drive_joining.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/map/stage_timer.hpp"
#include "masked_mapper/map_file/checkpoint_file.hpp"
#include "masked_mapper/map_file/map_file_reader.hpp"
#include "masked_mapper/map_file/map_file_writer.hpp"
#include "masked_mapper/mapping/map_log.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/options/configuration.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "option_flags.hpp"
#include "progress_bar.hpp"
#include "run_description.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

struct MapArguments {
  std::vector<std::string> logs;
  std::string out;
  std::string mask = "openings";
  OptionFlags options;
  std::string edits;
  std::vector<std::string> floors;
  std::string onto;
  std::string threads;
  double checkpoint_s = 1.0;
  bool resume = false;
  bool force = false;
  bool quiet = false;
};

/// What stands in the way of writing to OUT.
ExistingFolder HowToTreat(const MapArguments& arguments) {
  const bool is_empty =
      std::filesystem::is_directory(arguments.out) && std::filesystem::is_empty(arguments.out);
  if (arguments.resume && is_empty) return ExistingFolder::kReplace;
  return arguments.force ? ExistingFolder::kReplace : ExistingFolder::kRefuse;
}

/// Whether OUT holds the map that is asked for already. Throws InputError when it holds another.
bool IsFinished(const MapArguments& arguments, const MapOrigin& origin) {
  const std::filesystem::path file = std::filesystem::path(arguments.out) / "building.mmap";
  if (arguments.force || !std::filesystem::exists(file)) return false;
  const std::string difference = DifferenceFrom(ReadMapFile(file).origin, origin);
  if (difference.empty()) return true;
  throw InputError(arguments.out + " holds a finished map that was made otherwise: " + difference +
                   "; --force replaces it");
}

/// One log as it is asked for among several.
MapOrigin OriginOfDrive(const MapOrigin& origin, std::size_t drive) {
  MapOrigin own = origin;
  if (drive == 0) return own;
  own.log = origin.later_logs[drive - 1].log;
  own.options.mapping.floors.file = origin.later_logs[drive - 1].floors;
  return own;
}

/// What is kept on disk of a map in the making.
struct Keeping {
  FinishedDrives finished;
  std::unique_ptr<CheckpointFile> checkpoints;  ///< of the drive at work
  std::size_t drives = 1;
  std::size_t drive = 0;  ///< at work

  bool HasAnything() const {
    return finished.count() > 0 || (checkpoints && checkpoints->HasCheckpoint());
  }
  /// To be gone on from, in percent of all logs.
  int Percent() const {
    const double part = checkpoints && checkpoints->HasCheckpoint() ? checkpoints->progress() : 0.0;
    const double done = static_cast<double>(drive) + part;
    return static_cast<int>(100.0 * done / static_cast<double>(drives));
  }
};

/// Maps every log by itself and joins them, to OLD first of all.
MappingResult MapLogs(const MapArguments& arguments, const MapOrigin& origin, Keeping& keeping,
                      ProgressBar& progress) {
  std::vector<MappingResult> maps;
  if (!origin.onto.empty()) {
    progress.Stage("reading " + origin.onto);
    maps.push_back(ReadMapFile(MapFileOf(origin.onto)).result);
    if (maps.back().trajectory.empty() || maps.back().drives.empty()) {
      throw InputError(origin.onto + ": a map without a scan cannot be grown");
    }
  }
  for (keeping.drive = 0; keeping.drive < keeping.drives; ++keeping.drive) {
    const bool is_alone = keeping.drives == 1 && maps.empty();
    if (!is_alone) {
      std::optional<MappingResult> done = keeping.finished.Load(keeping.drive);
      if (done) {
        maps.push_back(std::move(*done));
        continue;
      }
    }
    const MapOrigin own = OriginOfDrive(origin, keeping.drive);
    keeping.checkpoints = std::make_unique<CheckpointFile>(
        arguments.out, origin, arguments.checkpoint_s, arguments.resume, keeping.drive);
    maps.push_back(
        MapLog(own.log, own.mask, own.options.mapping, progress, keeping.checkpoints.get()));
    const bool is_worth_keeping = keeping.checkpoints->HasCheckpoint() ||
                                  keeping.finished.count() > 0 || keeping.checkpoints->IsDue();
    if (is_alone || !is_worth_keeping || arguments.checkpoint_s == 0.0) continue;
    keeping.checkpoints.reset();
    try {
      keeping.finished.Save(keeping.drive, maps.back());
    } catch (const std::runtime_error& error) {
      // As with checkpoints: a full disk must not end what needs none of it.
      progress.Warn(std::string(error.what()) + "; going on without keeping the drive");
    }
  }
  return JoinDrives(std::move(maps), origin.options.drive_joins, origin.options.mapping.closures,
                    progress);
}

/// Maps and writes all of OUT.
Summary MakeMap(const MapArguments& arguments, const MapOrigin& origin, ExistingFolder existing,
                Keeping& keeping, ProgressBar& progress) {
  const Options& options = origin.options;
  MappingResult result = MapLogs(arguments, origin, keeping, progress);
  if (!arguments.edits.empty()) ApplyEdits(arguments.edits, options.mapping.closures, result);
  progress.Stage("writing");
  OutputFolder folder(arguments.out, existing);
  double map_file_seconds = 0.0;
  {
    const StageTimer timer(map_file_seconds);
    WriteMapFile(origin, result, folder.path() / "building.mmap");
  }
  result.seconds.export_ += map_file_seconds;
  result.seconds.total += map_file_seconds;
  const ExportOptions export_options{options.grid, options.octree};
  Summary summary = WriteMap(result, DescriptionOf(origin, result), export_options, folder.path());
  ThrowIfInterrupted();
  folder.Commit();
  progress.Finish();
  return summary;
}

/// What to add to the word of a run that ended early.
std::string HowToGoOn(const Keeping& keeping) {
  return "; " + std::to_string(keeping.Percent()) + " % of the " +
         (keeping.drives > 1 ? "logs" : "log") + " is kept: the same command with --resume goes on";
}

MapOrigin OriginOf(const MapArguments& arguments, Options options) {
  const std::size_t given = arguments.floors.size();
  const bool is_given_to_all = given == arguments.logs.size();
  if (given > 0 && !is_given_to_all) {
    throw InputError("--floors is given " + std::to_string(given) + " times for " +
                     std::to_string(arguments.logs.size()) +
                     " logs: once for each, in their order, `-` for none");
  }
  const auto floors_of = [&](std::size_t log) {
    if (given == 0) return options.mapping.floors.file;
    return arguments.floors[log] == "-" ? std::string() : arguments.floors[log];
  };
  MapOrigin origin;
  origin.log = arguments.logs.front();
  origin.mask = arguments.mask;
  for (std::size_t i = 1; i < arguments.logs.size(); ++i) {
    origin.later_logs.push_back({arguments.logs[i], floors_of(i)});
  }
  origin.onto = arguments.onto;
  options.mapping.floors.file = floors_of(0);
  origin.options = std::move(options);
  CheckOptions(origin.options);
  return origin;
}

int RunMap(const MapArguments& arguments) {
  Options options = ReadOptions(arguments.options);
  if (!arguments.threads.empty()) SetOption("--threads", "threads", arguments.threads, options);
  CheckOptions(options);
  SettleThreads(options);
  MakeMask(arguments.mask, options.mapping.masks);  // throws before the log is looked at
  // Before the work: an hour of mapping must not end in "exists already".
  const ExistingFolder existing = HowToTreat(arguments);
  const MapOrigin origin = OriginOf(arguments, options);
  // The same of a later log or a map that is not there.
  for (const MapOrigin::LaterLog& later : origin.later_logs)
    OpenLog(later.log, options.mapping.log);
  if (!origin.onto.empty()) MapFileOf(origin.onto);
  Keeping keeping{FinishedDrives(arguments.out, origin, arguments.resume), nullptr,
                  arguments.logs.size()};
  if (arguments.resume && IsFinished(arguments, origin)) {
    if (!arguments.edits.empty()) {
      throw InputError(arguments.out + " is finished already: `export " + arguments.out +
                       " --format all --edits " + arguments.edits + " -o NEW` edits it");
    }
    keeping.finished.Remove();  // the program may have ended between the two
    if (!arguments.quiet) std::cout << "map: " << arguments.out << " is finished already\n";
    return 0;
  }
  CheckOutputFolder(arguments.out, existing);

  if (!arguments.resume && !arguments.force && CheckpointFile::Exists(arguments.out)) {
    throw InputError("an unfinished map of " + arguments.out +
                     " is there: --resume goes on with it, --force starts afresh");
  }

  // What an earlier run left of finished drives must not be taken for this one's.
  const bool keeps_drives = keeping.drives > 1 || !origin.onto.empty();
  if (!arguments.resume && keeps_drives) keeping.finished.Remove();
  CatchInterrupts();
  ProgressBar progress(arguments.quiet);
  Summary summary;
  try {
    summary = MakeMap(arguments, origin, existing, keeping, progress);
  } catch (const InputError& error) {
    if (!keeping.HasAnything()) throw;
    throw InputError(error.what() + HowToGoOn(keeping));
  } catch (const Interrupted&) {
    if (!keeping.HasAnything()) throw;
    throw Interrupted("interrupted" + HowToGoOn(keeping));
  } catch (const std::runtime_error& error) {
    if (!keeping.HasAnything()) throw;
    throw std::runtime_error(error.what() + HowToGoOn(keeping));
  }
  keeping.checkpoints.reset();
  keeping.finished.Remove();
  if (!arguments.quiet) std::cout << ClosingTable(summary) << "map: " << arguments.out << "\n";
  return 0;
}

/// The parser ends the text with a line break of its own.
std::string OptionListing() {
  std::string text = ConfigurationText(Options{});
  text.pop_back();
  return text;
}

std::string MaskHelp() {
  std::string names;
  for (const std::string& name : RegisteredMasks()) names += (names.empty() ? "" : ", ") + name;
  return "where scans are worth matching: " + names +
         "; combined as any(a,b), all(a,b), not(a), sparse(a)";
}

}  // namespace

void AddMapCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = program.add_subcommand(
      "map", "Map logs: CARMEN text (.clf, .log), plain or .gz, with 2D lidar and odometry");
  command
      ->add_option("LOG", arguments->logs,
                   "the robot's log; several drives of one building are joined")
      ->required();
  command->add_option("-o,--output", arguments->out, "folder to write the map to")
      ->required()
      ->type_name("OUT");
  command->add_option("--mask", arguments->mask, MaskHelp())
      ->capture_default_str()
      ->type_name("MASK");
  AddOptionFlags(*command, arguments->options);
  command
      ->add_option("--floors", arguments->floors,
                   "file of lines `t,label`: from t (s) on the robot is on that floor, `-`: in\n"
                   "transit; stands for the log's own FLOOR lines. Of several logs: once for\n"
                   "each, in their order, `-` for none")
      ->allow_extra_args(false)
      ->type_name("FILE");
  command
      ->add_option("--onto", arguments->onto,
                   "grow this map: what `map` wrote, or the building.mmap in it; OUT is another")
      ->type_name("OLD");
  command
      ->add_option("--threads", arguments->threads,
                   "threads to use, 0: all; the map is the same with any number")
      ->type_name("N");
  command
      ->add_option("--edits", arguments->edits,
                   "mend the finished map as this file says (docs/map_file.md)")
      ->type_name("FILE");
  command->add_flag("--resume", arguments->resume,
                    "go on with an unfinished map of OUT; without one, start afresh");
  command
      ->add_option("--checkpoint", arguments->checkpoint_s,
                   "seconds from which on what is done is kept, and between; 0: never")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->type_name("SECONDS");
  command->add_flag("--force", arguments->force, "replace the map that is in OUT");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
  command->add_flag_callback(
      "--help-options", [] { throw CLI::CallForVersion(OptionListing(), 0); },
      "list every option of --config and --set, with default, meaning and range");
  command->footer(
      "Examples:\n"
      "  masked_mapper map drive.log.gz -o out\n"
      "  masked_mapper map drive.log.gz -o out --force --mask 'any(openings,eccentricity)'\n"
      "  masked_mapper map drive.log.gz -o out --set matcher.min_score=0.5 --set log.max_range=30\n"
      "  masked_mapper map drive.bag -o out --floors floors.csv\n"
      "  masked_mapper map monday.log.gz tuesday.log.gz -o out\n"
      "  masked_mapper map wednesday.log.gz --onto out -o grown\n"
      "\n"
      "OUT holds building.mmap (the map itself), building.bt (OctoMap), building.pcd and .ply,\n"
      "floors/*.pgm + .yaml (map_server), trajectory.tum, graph.g2o, closures.csv, summary.json,\n"
      "and report.html to look at all of it in a browser. Nothing is written before all of it is,\n"
      "and an OUT that exists is never replaced without --force. Until then, what is done is kept\n"
      "in a hidden folder beside OUT (.OUT.unfinished): whatever ends the run, the same command\n"
      "with --resume goes on.\n\n"
      "Several logs: each is mapped by itself, from an unknown start, and tied to the others by\n"
      "validated closures alone. A drive that nothing ties stays a piece of its own beside them,\n"
      "with floors called <label>.drive<n>; summary.json (`drives`) and a warning say so.");
  command->callback([arguments, &run] { run = [arguments] { return RunMap(*arguments); }; });
}

}  // namespace masked_mapper
