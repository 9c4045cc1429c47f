// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper localize LOG... --in OUT|MAP -o DIR [--json] [--poses]
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "live_input.hpp"
#include "masked_mapper/export/localization_export.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/localization/localizer.hpp"
#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/log/log_summary.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/mapping/log_survey.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "option_flags.hpp"
#include "progress_bar.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

struct LocalizeArguments {
  std::vector<std::string> logs;
  std::string map;
  std::string out;
  OptionFlags options;
  std::string follow;  ///< a file that grows
  bool json = false;
  bool poses = false;
  bool force = false;
  bool quiet = false;
};

/// The rooms' options as the user sets them, for this log; the mask is the map's.
LocalizerOptions LocalizerOptionsOf(const Options& options) {
  LocalizerOptions localizer;
  const MappingOptions& mapping = options.mapping;
  localizer.motion = mapping.motion;
  localizer.floors = mapping.floors;
  localizer.masks = mapping.masks;
  localizer.closures = mapping.closures;
  localizer.closures.refine = mapping.motion.source != MotionSource::kOdometry;
  localizer.min_edge_length_m = mapping.nodes.min_edge_length_m;
  localizer.max_edge_length_m = mapping.nodes.max_edge_length_m;
  localizer.floor_search = {options.drive_joins.search, FineSearchOptions(),
                            options.drive_joins.seen, mapping.closures.matcher.table.max_range_m};
  constexpr double kSeenCell = 0.2;  // m
  localizer.floor_search.seen.resolution_m = kSeenCell;
  localizer.floor_search.seen.min_hits = 1;
  return localizer;
}

class LocalizeRun {
 public:
  LocalizeRun(const BuildingMap& map, Localizer& localizer, ProgressBar& progress)
      : map_(map), localizer_(localizer), progress_(progress) {}

  /// As `map` reads it: surveyed, its wheels mended, its scans straightened.
  void Drive(LogSource& source, const MappingOptions& options, bool says_poses) {
    progress_.Stage("reading");
    const LogSurvey survey = SurveyLog(source, options);
    const MotionSource motion = SettleMotionSource(source.path(), options.motion, survey);
    for (const SensorFinding& finding : survey.findings) Warn(source, TextOf(finding));
    for (const std::string& warning : survey.warnings) Warn(source, warning);
    progress_.Stage("localizing");
    const std::unique_ptr<LogReader> log =
        ReadStraightened(source, {survey.sweep_s_per_rad, motion != MotionSource::kScans});
    localizer_.BeginLog(motion);
    while (const std::optional<Observation> observation = log->Next()) {
      if (!localizer_.Observe(*observation)) continue;
      progress_.Progress(log->Progress(), localizer_.result().scans.size());
      if (says_poses) {
        std::cout << PoseLine(map_, localizer_.result().scans.back()) << std::endl;
      }
    }
    for (const std::string& warning : WarningsOf(log->Statistics())) Warn(source, warning);
  }

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void Warn(const LogSource& source, const std::string& text) {
    warnings_.push_back(source.path() + ": " + text);
    progress_.Warn(warnings_.back());
  }

  const BuildingMap& map_;
  Localizer& localizer_;
  ProgressBar& progress_;
  std::vector<std::string> warnings_;
};

/// Answers scan by scan, as the log comes. False: it is packed, or a bag, and can be read only when
/// all of it is there.
bool AnswerLive(LiveInput& input, const SavedMap& saved, const Options& options, bool says_poses,
                ProgressBar& progress) {
  Localizer localizer(saved.result, saved.origin.mask, LocalizerOptionsOf(options));
  LiveLog log(options.mapping.log);
  std::optional<bool> is_text;
  const auto answer = [&] {
    while (const std::optional<Observation> observation = log.Next()) {
      if (!localizer.Observe(*observation) || !says_poses) continue;
      std::cout << PoseLine(saved.result, localizer.result().scans.back()) << std::endl;
    }
  };
  input.Listen(
      [&](std::string_view bytes) {
        if (!is_text) is_text = BeginsAsText(bytes);
        if (!*is_text) return;
        log.Add(bytes);
        answer();
      },
      [] {}, progress);
  if (!is_text.value_or(true)) return false;
  log.Finish();
  answer();
  return true;
}

/// The log as it is when it is over; and, of one that comes live, whether its poses were said.
struct LiveDrive {
  std::unique_ptr<LiveInput> input;
  bool said_poses = false;
};

LiveDrive Listen(const LocalizeArguments& arguments, const SavedMap& saved, const Options& options,
                 ProgressBar& progress) {
  LiveDrive live;
  const bool is_pipe = arguments.logs.size() == 1 && arguments.logs.front() == "-";
  if (arguments.follow.empty() && !(is_pipe && arguments.poses)) return live;
  live.input = std::make_unique<LiveInput>(is_pipe ? "-" : arguments.follow);
  live.said_poses = AnswerLive(*live.input, saved, options, arguments.poses, progress);
  return live;
}

std::string Closing(const Localization& drive, const std::string& doubt, std::size_t changes) {
  std::size_t placed = 0;
  for (const LocatedScan& scan : drive.scans) placed += scan.placed ? 1 : 0;
  std::string text = drive.found
                         ? "found after " + FixedText(drive.found_after_m, 1) + " m of driving"
                         : "not found: " + doubt;
  text += "\n  placed    " + std::to_string(placed) + " of " + std::to_string(drive.scans.size()) +
          " scans\n  matches   " + std::to_string(drive.matches) + ", searches on whole floors " +
          std::to_string(drive.searches) + "\n";
  for (const UnsureSpan& span : drive.unsure_spans) {
    text += "  unsure    " + FixedText(span.t_a, 1) + " to " + FixedText(span.t_b, 1) +
            " s: " + span.why + "\n";
  }
  if (drive.found && !doubt.empty()) text += "  at the end not sure where: " + doubt + "\n";
  if (changes > 0) {
    text += "  changes   " + std::to_string(changes) + " regions are not as the map has them\n";
  }
  return text;
}

ExistingFolder HowToTreat(const LocalizeArguments& arguments) {
  const bool is_there = std::filesystem::exists(arguments.out);
  return arguments.force && is_there ? ExistingFolder::kComplete : ExistingFolder::kRefuse;
}

int RunLocalize(const LocalizeArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  Options options = ReadOptions(arguments.options);
  CheckOptions(options);
  SettleThreads(options);
  const ExistingFolder existing = HowToTreat(arguments);
  CheckOutputFolder(arguments.out, existing);
  const SavedMap saved = ReadMapFile(MapFileOf(arguments.map));
  if (arguments.logs.empty() == arguments.follow.empty()) {
    throw InputError("localize: expected LOG or --follow FILE, one of the two");
  }
  CatchInterrupts();
  ProgressBar progress(arguments.quiet);
  for (const std::string& line : saved.left_aside) progress.Warn(arguments.map + ": " + line);
  Localizer localizer(saved.result, saved.origin.mask, LocalizerOptionsOf(options));
  LocalizeRun run(saved.result, localizer, progress);
  const LiveDrive live = Listen(arguments, saved, options, progress);
  const bool says_poses = arguments.poses && !live.said_poses;
  const std::vector<std::vector<std::string>> recordings =
      live.input ? std::vector<std::vector<std::string>>{{live.input->path()}}
                 : RecordingsOf(arguments.logs);
  for (const std::vector<std::string>& files : recordings) {
    const std::unique_ptr<LogSource> source = live.input
                                                  ? live.input->Source(options.mapping.log)
                                                  : OpenRecording(files, options.mapping.log);
    run.Drive(*source, options.mapping, says_poses);
  }
  const std::vector<MapChange> changes = localizer.Changes();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const std::vector<std::string> logs =
      arguments.follow.empty() ? arguments.logs : std::vector<std::string>{arguments.follow};
  const LocalizationRun description{logs, arguments.map, taken.count(), run.warnings(),
                                    localizer.Doubt()};
  OutputFolder folder(arguments.out, existing);
  WriteLocalization(saved.result, localizer.result(), changes, description, folder.path());
  ThrowIfInterrupted();
  folder.Commit();
  progress.Finish();
  if (arguments.json) {
    std::cout << LocalizationSummaryText(saved.result, localizer.result(), changes, description);
  } else if (!arguments.quiet && !arguments.poses) {
    std::cout << Closing(localizer.result(), description.doubt, changes.size())
              << "drive: " << arguments.out << "\n";
  }
  return 0;
}

constexpr const char* kFooter =
    "Examples:\n"
    "  masked_mapper localize today.log.gz --in out -o today\n"
    "  masked_mapper localize today.log.gz --in out -o today --json\n"
    "  robot | masked_mapper localize - --in out -o today --poses\n"
    "\n"
    "No start pose is needed, and no floor: places that come into question are kept until one is\n"
    "believed. Then a scan is matched where the map's mask says that it pays. A robot that was\n"
    "carried off, or rode to a floor that nothing tells, is not sure, says so, and is found "
    "again.\n"
    "A log of another building is not found; that is an answer, and no error.\n"
    "\n"
    "With --poses, `-` answers each scan as it comes, if the log is CARMEN text; so does "
    "--follow.\n"
    "When the log is over, it is driven through once more with all that it tells of its sensors:\n"
    "DIR is the same as that of the whole log.\n"
    "\n"
    "DIR holds trajectory.tum (in the map's frame, placed scans only, also those that were placed "
    "in\n"
    "hindsight), floors.csv (t,label as known at t; `?`: not sure), summary.json, and page.html "
    "with\n"
    "the drive drawn into the map. The map stays as it is.";

}  // namespace

void AddLocalizeCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<LocalizeArguments>();
  CLI::App* command = program.add_subcommand("localize", "Find a robot in a finished map");
  command->add_option(
      "LOG", arguments->logs,
      "the robot's log, `-`: standard input; of several, one is driven after the other");
  command
      ->add_option("--follow", arguments->follow,
                   "a log in text that is still being written, until Ctrl-C")
      ->type_name("FILE");
  command->add_option("--in", arguments->map, "what `map` wrote, or the building.mmap in it")
      ->required()
      ->type_name("OUT|MAP");
  command->add_option("-o,--output", arguments->out, "folder to write to")
      ->required()
      ->type_name("DIR");
  AddOptionFlags(*command, arguments->options);
  command->add_flag("--json", arguments->json, "print what summary.json holds");
  command->add_flag("--poses", arguments->poses,
                    "print a line of JSON for every scan as it is answered:\n"
                    "t, floor, x, y, theta, sigma_x, sigma_y, sigma_theta, sure");
  command->add_flag("--force", arguments->force, "write into a DIR that exists");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
  command->footer(kFooter);
  command->callback([arguments, &run] { run = [arguments] { return RunLocalize(*arguments); }; });
}

}  // namespace masked_mapper
