// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper map LOG... -o OUT
#include <memory>
#include <string>

#include "commands.hpp"
#include "map_run.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/options/option_table.hpp"

namespace masked_mapper {
namespace {

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

void AddInputs(CLI::App* command, MapArguments* arguments) {
  command->add_option(
      "LOG", arguments->logs,
      "the robot's log, `-`: standard input; several drives of one building are joined,\n"
      "bags of one recording that go on from each other are one drive");
  command
      ->add_option("--follow", arguments->follow,
                   "in place of LOG: one that is still being written, until Ctrl-C")
      ->type_name("FILE");
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
  command->add_flag("--forget", arguments->forget,
                    "draw what the newest drive saw where it saw enough, not what stood there\n"
                    "before: the same as --set grid.forget=true");
}

void AddRunFlags(CLI::App* command, MapArguments* arguments) {
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
  command
      ->add_option("--every", arguments->every_s,
                   "of a log that comes live (`-` from a pipe, --follow): write the map so far\n"
                   "every so many seconds, 0: only when SIGUSR1 asks")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->type_name("SECONDS");
  command->add_flag("--force", arguments->force, "replace the map that is in OUT");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
  command->add_flag_callback(
      "--help-options", [] { throw CLI::CallForVersion(OptionListing(), 0); },
      "list every option of --config and --set, with default, meaning and range");
}

constexpr const char* kFooter =
    "Examples:\n"
    "  masked_mapper map drive.log.gz -o out\n"
    "  masked_mapper map drive.log.gz -o out --force --mask 'any(openings,eccentricity)'\n"
    "  masked_mapper map drive.log.gz -o out --set matcher.min_score=0.5 --set log.max_range=30\n"
    "  masked_mapper map drive.bag -o out --floors floors.csv\n"
    "  masked_mapper map monday.log.gz tuesday.log.gz -o out\n"
    "  masked_mapper map wednesday.log.gz --onto out -o grown\n"
    "  robot | masked_mapper map - -o out --every 60\n"
    "  masked_mapper map after_works.log.gz --onto out --forget -o renewed\n"
    "\n"
    "OUT holds building.mmap (the map itself), building.bt (OctoMap), building.pcd and .ply,\n"
    "floors/*.pgm + .yaml (map_server), trajectory.tum, graph.g2o, closures.csv, summary.json,\n"
    "and report.html to look at all of it in a browser. building.mmap is written first: a map "
    "that\n"
    "is finished stays, whatever becomes of the rest, and the same command with --resume writes "
    "what\n"
    "is not there. Drawn with other grid.* or octree.* options it is so, too, without mapping "
    "again.\n"
    "An OUT that exists is never replaced without --force. Until the map is finished, what is "
    "done\n"
    "is kept in a hidden folder beside OUT (.OUT.unfinished): whatever ends the run, the same\n"
    "command with --resume goes on.\n\n"
    "Several logs: each is mapped by itself, from an unknown start, and tied to the others by\n"
    "validated closures alone. A drive that nothing ties stays a piece of its own beside them,\n"
    "with floors called <label>.drive<n>; summary.json (`drives`) and a warning say so.\n\n"
    "While a log comes live, building.mmap in OUT is the map so far, and says so: all that came "
    "until\n"
    "it was asked for, mapped as if that were the log; `info`, `export` and `localize` open it. "
    "It is\n"
    "made beside the listening, in half of the time at most. When the writer ends, however, or "
    "with\n"
    "Ctrl-C, the map is that of all that came, as it is of the file. Whatever ends the program "
    "before,\n"
    "the map so far stays.";

}  // namespace

void AddMapCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = program.add_subcommand("map",
                                             "Map logs with 2D lidar: CARMEN text (.clf, .log), "
                                             "ROS bags (.bag, .mcap, .db3); packed, too");
  AddInputs(command, arguments.get());
  AddRunFlags(command, arguments.get());
  command->footer(kFooter);
  command->callback([arguments, &run] { run = [arguments] { return RunMap(*arguments); }; });
}

}  // namespace masked_mapper
