// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper map LOG... -o OUT
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "masked_mapper/export/closing_table.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/log/input_error.hpp"
#include "masked_mapper/map_file/checkpoint_file.hpp"
#include "masked_mapper/map_file/map_file_reader.hpp"
#include "masked_mapper/map_file/map_file_writer.hpp"
#include "masked_mapper/mapping/configuration.hpp"
#include "masked_mapper/mapping/edits.hpp"
#include "masked_mapper/mapping/map_log.hpp"
#include "masked_mapper/mapping/option_table.hpp"
#include "masked_mapper/mapping/stage_timer.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "option_flags.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {
namespace {

struct MapArguments {
  std::vector<std::string> logs;
  std::string out;
  std::string mask = "openings";
  OptionFlags options;
  std::string edits;
  std::string floors;
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

/// Maps and writes all of OUT.
Summary MakeMap(const MapArguments& arguments, const MapOrigin& origin, ExistingFolder existing,
                CheckpointFile& checkpoints, ProgressBar& progress) {
  const Options& options = origin.options;
  MappingResult result = MapLog(origin.log, origin.mask, options, progress, &checkpoints);
  if (!arguments.edits.empty()) ApplyEdits(arguments.edits, options, result);
  progress.Stage("writing");
  OutputFolder folder(arguments.out, existing);
  double map_file_seconds = 0.0;
  {
    const StageTimer timer(map_file_seconds);
    WriteMapFile(origin, result, folder.path() / "building.mmap");
  }
  result.seconds.export_ += map_file_seconds;
  result.seconds.total += map_file_seconds;
  ExportOptions export_options{options.grid, options.octree};
  export_options.grid.threads = options.threads;
  Summary summary = WriteMap(result, {origin.log, origin.mask, OptionValues(options)},
                             export_options, folder.path());
  ThrowIfInterrupted();
  folder.Commit();
  progress.Finish();
  return summary;
}

/// What to add to the word of a run that ended early.
std::string HowToGoOn(const CheckpointFile& checkpoints) {
  const auto percent = static_cast<int>(100.0 * checkpoints.progress());
  return "; " + std::to_string(percent) +
         " % of the log is kept: the same command with --resume goes on";
}

int RunMap(const MapArguments& arguments) {
  Options options = ReadOptions(arguments.options);
  if (!arguments.threads.empty()) SetOption("--threads", "threads", arguments.threads, options);
  if (!arguments.floors.empty()) options.floors.file = arguments.floors;
  CheckOptions(options);
  if (options.threads == 0) {
    options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }
  MakeMask(arguments.mask, options.masks);  // throws before the log is looked at
  if (arguments.logs.size() > 1) {
    throw InputError("map takes one log, not " + std::to_string(arguments.logs.size()) +
                     "; several cannot be joined yet");
  }
  // Before the work: an hour of mapping must not end in "exists already".
  const ExistingFolder existing = HowToTreat(arguments);
  const MapOrigin origin{arguments.logs.front(), arguments.mask, options};
  CheckpointFile checkpoints(arguments.out, origin, arguments.checkpoint_s, arguments.resume);
  if (arguments.resume && IsFinished(arguments, origin)) {
    if (!arguments.edits.empty()) {
      throw InputError(arguments.out + " is finished already: `export " + arguments.out +
                       " --format all --edits " + arguments.edits + " -o NEW` edits it");
    }
    checkpoints.Remove();  // the program may have ended between the two
    if (!arguments.quiet) std::cout << "map: " << arguments.out << " is finished already\n";
    return 0;
  }
  CheckOutputFolder(arguments.out, existing);

  if (!arguments.resume && !arguments.force && CheckpointFile::Exists(arguments.out)) {
    throw InputError("an unfinished map of " + arguments.out +
                     " is there: --resume goes on with it, --force starts afresh");
  }

  CatchInterrupts();
  ProgressBar progress(arguments.quiet);
  Summary summary;
  try {
    summary = MakeMap(arguments, origin, existing, checkpoints, progress);
  } catch (const InputError& error) {
    if (!checkpoints.HasCheckpoint()) throw;
    throw InputError(error.what() + HowToGoOn(checkpoints));
  } catch (const Interrupted&) {
    if (!checkpoints.HasCheckpoint()) throw;
    throw Interrupted("interrupted" + HowToGoOn(checkpoints));
  } catch (const std::runtime_error& error) {
    if (!checkpoints.HasCheckpoint()) throw;
    throw std::runtime_error(error.what() + HowToGoOn(checkpoints));
  }
  checkpoints.Remove();
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
  return "where scans are worth matching: " + names + "; combined as any(a,b), all(a,b), not(a)";
}

}  // namespace

void AddMapCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = program.add_subcommand(
      "map", "Map a log: CARMEN text (.clf, .log), plain or .gz, with 2D lidar and odometry");
  command->add_option("LOG", arguments->logs, "the robot's log")->required();
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
                   "transit; stands for the log's own FLOOR lines")
      ->type_name("FILE");
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
      "\n"
      "OUT holds building.mmap (the map itself), building.bt (OctoMap), building.pcd and .ply,\n"
      "floors/*.pgm + .yaml (map_server), trajectory.tum, graph.g2o, closures.csv, summary.json,\n"
      "and report.html to look at all of it in a browser. Nothing is written before all of it is,\n"
      "and an OUT that exists is never replaced without --force. Until then, what is done is kept\n"
      "in a hidden folder beside OUT (.OUT.unfinished): whatever ends the run, the same command\n"
      "with --resume goes on.");
  command->callback([arguments, &run] { run = [arguments] { return RunMap(*arguments); }; });
}

}  // namespace masked_mapper
