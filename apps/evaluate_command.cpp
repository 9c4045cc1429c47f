// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper evaluate OUT [--relations FILE] [--truth FILE] [--checked OUT...] [--json]
#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "masked_mapper/evaluation/closures.hpp"
#include "masked_mapper/evaluation/floors.hpp"
#include "masked_mapper/evaluation/path_length.hpp"
#include "masked_mapper/evaluation/relations.hpp"
#include "masked_mapper/evaluation/result_folder.hpp"
#include "masked_mapper/evaluation/trajectory_error.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

struct EvaluateArguments {
  std::string folder;
  std::string relations;
  std::string truth;
  std::vector<std::string> checked;
  std::size_t drive = 0;  ///< of a map of several logs, from 1; 0: all of it
  bool json = false;
  bool quiet = false;
};

/// What could be computed of the given inputs.
struct Evaluation {
  std::optional<RelationsError> relations;
  std::optional<TrajectoryError> trajectory;
  std::optional<ClosureError> closures;
  std::optional<FloorIdentity> floors;
  std::optional<PathLengthError> path_length;
};

MappedGraph GraphOf(const ResultFolder& result, const std::string& folder) {
  if (result.graph && result.graph->nodes.size() > 1) return *result.graph;
  throw InputError("--checked: " + folder + " has no graph of two nodes or more");
}

/// With --checked, the paper's truth: the shortest way over maps that are free of false closures.
std::optional<PathLengthError> ErrorAgainstChecked(const EvaluateArguments& arguments,
                                                   const ResultFolder& result,
                                                   const std::vector<StampPair>& pairs) {
  const auto stamps = [](const ResultFolder& map) {
    return std::make_pair(map.scans.front().stamp, map.scans.back().stamp);
  };
  std::vector<MappedGraph> checked;
  for (const std::string& folder : arguments.checked) {
    const ResultFolder map = ReadResultFolder(folder);
    checked.push_back(GraphOf(map, folder));
    if (stamps(map) != stamps(result)) {
      throw InputError("--checked: " + folder + " is no map of the log of " + arguments.folder);
    }
  }
  return CompareWithCheckedMaps(GraphOf(result, arguments.folder), checked, pairs);
}

/// A truth of one drive says nothing of the others, whose stamps may be shifted besides.
void RequireTruthOfAll(const EvaluateArguments& arguments, const ResultFolder& result,
                       const Truth& truth) {
  if (result.drives.size() < 2 || truth.poses.empty()) return;
  const double first = truth.poses.front().stamp;
  const double last = truth.poses.back().stamp;
  const auto covered = static_cast<std::size_t>(std::count_if(
      result.trajectory.begin(), result.trajectory.end(),
      [&](const StampedPose& pose) { return pose.stamp >= first && pose.stamp <= last; }));
  constexpr std::size_t kMostLeftOut = 10;  // percent
  // Drives whose stamps had to be shifted to follow each other tell one time twice.
  const bool is_one_time =
      std::all_of(result.drives.begin(), result.drives.end(),
                  [](const MappedDrive& drive) { return drive.stamp_offset == 0.0; });
  const std::size_t left_out = result.trajectory.size() - covered;
  if (is_one_time && 100 * left_out <= kMostLeftOut * result.trajectory.size()) return;
  throw InputError(arguments.folder + " holds " + std::to_string(result.drives.size()) +
                   " drives, and " + arguments.truth +
                   " is not the truth of all: say of which with --drive N");
}

Evaluation Evaluate(const EvaluateArguments& arguments) {
  ResultFolder result = ReadResultFolder(arguments.folder);
  if (arguments.drive > 0) result = OneDrive(arguments.folder, result, arguments.drive);
  Evaluation evaluation;
  if (!arguments.relations.empty()) {
    evaluation.relations =
        CompareWithRelations(result.trajectory, ReadRelations(arguments.relations));
  }
  const std::vector<StampPair> pairs =
      DrawStampPairs(result.scans.front().stamp, result.scans.back().stamp);
  if (!arguments.checked.empty()) {
    evaluation.path_length = ErrorAgainstChecked(arguments, result, pairs);
  }
  if (arguments.truth.empty()) return evaluation;
  const Truth truth = ReadTruth(arguments.truth);
  RequireTruthOfAll(arguments, result, truth);
  evaluation.trajectory = CompareWithTruth(result.trajectory, truth, result.floors);
  evaluation.floors = CompareFloors(result.trajectory, result.floors, truth.floors);
  if (!result.graph) return evaluation;
  const auto true_nodes = TruePosesOf(result.graph->log_stamps, truth, result.trajectory);
  const ClosureTolerance tolerance = ToleranceOf(truth);
  if (result.closures) {
    evaluation.closures = CheckClosures(*result.graph, *result.closures, true_nodes, tolerance);
  }
  if (arguments.checked.empty()) {
    evaluation.path_length = ComparePathLengths(*result.graph, true_nodes, pairs, tolerance);
  }
  return evaluation;
}

Json SpreadJson(const ErrorStatistics& statistics) {
  return {{"mean", statistics.mean},
          {"std", statistics.std},
          {"median", statistics.median},
          {"max", statistics.max}};
}

void AddPosition(Json& json, const AbsoluteError& error) {
  json["mean_m"] = error.position_m.mean;
  json["std_m"] = error.position_m.std;
  json["median_m"] = error.position_m.median;
  json["p99_m"] = error.position_m.p99;
  json["max_m"] = error.position_m.max;
  json["heading_deg"] = SpreadJson(error.heading_deg);
}

Json AbsoluteJson(const AbsoluteError& error) {
  Json json;
  AddPosition(json, error);
  return json;
}

Json RelationsJson(const RelationsError& relations) {
  Json json = {{"count", relations.count}, {"used", relations.used}};
  if (relations.used > 0) {
    json["translation_m"] = SpreadJson(relations.translation_m);
    json["rotation_deg"] = SpreadJson(relations.rotation_deg);
  }
  return json;
}

Json TrajectoryJson(const TrajectoryError& error) {
  Json json = {{"scans", error.scans}, {"paired", error.paired}};
  AddPosition(json, error.as_it_stands);
  json["aligned"] = AbsoluteJson(error.aligned);
  json["elevation_m"] = SpreadJson(error.elevation_m);
  json["relative"] = {{"over_m", error.relative_over_m},
                      {"count", error.relative_translation_m.count},
                      {"translation_m", SpreadJson(error.relative_translation_m)},
                      {"rotation_deg", SpreadJson(error.relative_rotation_deg)}};
  json["floors"] = Json::array();
  for (const FloorError& floor : error.floors) {
    Json entry = {{"label", floor.label}, {"paired", floor.as_it_stands.position_m.count}};
    AddPosition(entry, floor.as_it_stands);
    entry["aligned"] = AbsoluteJson(floor.aligned);
    json["floors"].push_back(entry);
  }
  return json;
}

Json ClosuresJson(const ClosureError& closures) {
  Json json = {{"validated", closures.validated},
               {"checked", closures.checked},
               {"false", closures.false_closures.size()},
               {"true_pairs", closures.true_pairs},
               {"closed_pairs", closures.closed_pairs}};
  if (closures.Precision()) json["precision"] = *closures.Precision();
  if (closures.Recall()) json["recall"] = *closures.Recall();
  json["false_closures"] = Json::array();
  for (const FalseClosure& closure : closures.false_closures) {
    json["false_closures"].push_back({{"t_a", closure.stamp_a},
                                      {"t_b", closure.stamp_b},
                                      {"translation_m", closure.translation_m},
                                      {"rotation_deg", closure.rotation_deg}});
  }
  return json;
}

void PrintJson(const Evaluation& evaluation) {
  Json json = Json::object();
  if (evaluation.relations) json["relations"] = RelationsJson(*evaluation.relations);
  if (evaluation.trajectory) json["trajectory"] = TrajectoryJson(*evaluation.trajectory);
  if (evaluation.closures) json["closures"] = ClosuresJson(*evaluation.closures);
  if (evaluation.floors) {
    json["floors"] = {{"right", evaluation.floors->Right()},
                      {"scans", evaluation.floors->scans},
                      {"same_label", evaluation.floors->same_label},
                      {"renaming", evaluation.floors->renaming}};
  }
  if (evaluation.path_length) {
    json["path_length"] = {{"mean_m", evaluation.path_length->error_m.mean},
                           {"median_m", evaluation.path_length->error_m.median},
                           {"max_m", evaluation.path_length->error_m.max},
                           {"missing_m", evaluation.path_length->missing_m},
                           {"false_m", evaluation.path_length->false_m},
                           {"pairs", evaluation.path_length->error_m.count}};
  }
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

std::string Fixed(double value, int decimals) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string Percent(double share) { return Fixed(100.0 * share, 2) + " %"; }

void Line(const std::string& name, const std::string& value) {
  const std::size_t width = 22;
  std::cout << "  " << name << std::string(name.size() < width ? width - name.size() : 1, ' ')
            << value << "\n";
}

std::string SpreadText(const ErrorStatistics& statistics, int decimals, const std::string& unit) {
  return Fixed(statistics.mean, decimals) + " +- " + Fixed(statistics.std, decimals) + " " + unit +
         " (median " + Fixed(statistics.median, decimals) + ", largest " +
         Fixed(statistics.max, decimals) + ")";
}

std::string PositionText(const ErrorStatistics& statistics) {
  return "mean " + Fixed(statistics.mean, 3) + " m, median " + Fixed(statistics.median, 3) +
         " m, 99 % below " + Fixed(statistics.p99, 3) + " m, largest " + Fixed(statistics.max, 3) +
         " m";
}

void PrintTrajectory(const TrajectoryError& error) {
  std::cout << "trajectory: " << error.paired << " of " << error.scans << " scans compared\n";
  Line("as it stands", PositionText(error.as_it_stands.position_m));
  Line("aligned", PositionText(error.aligned.position_m));
  Line("heading, aligned", SpreadText(error.aligned.heading_deg, 3, "deg"));
  Line("elevation", SpreadText(error.elevation_m, 3, "m"));
  const std::string stretch = "over " + Fixed(error.relative_over_m, 0) + " m of the way";
  if (error.relative_translation_m.count > 0) {
    Line(stretch, SpreadText(error.relative_translation_m, 3, "m"));
    Line("", SpreadText(error.relative_rotation_deg, 3, "deg"));
  }
  for (const FloorError& floor : error.floors) {
    Line("floor " + floor.label, "mean " + Fixed(floor.as_it_stands.position_m.mean, 3) +
                                     " m, aligned " + Fixed(floor.aligned.position_m.mean, 3) +
                                     " m (" + std::to_string(floor.aligned.position_m.count) +
                                     " scans)");
  }
}

void PrintClosures(const ClosureError& closures) {
  std::cout << "closures\n";
  Line("validated", std::to_string(closures.validated) + ", " + std::to_string(closures.checked) +
                        " checked, " + std::to_string(closures.false_closures.size()) + " false");
  if (closures.Precision()) Line("precision", Percent(*closures.Precision()));
  if (closures.Recall()) {
    Line("recall", Percent(*closures.Recall()) + " of " + std::to_string(closures.true_pairs) +
                       " pairs of nodes that see the same place");
  }
  for (const FalseClosure& closure : closures.false_closures) {
    Line("false", "stamps " + Fixed(closure.stamp_a, 6) + " and " + Fixed(closure.stamp_b, 6) +
                      ": off by " + Fixed(closure.translation_m, 2) + " m, " +
                      Fixed(closure.rotation_deg, 1) + " deg");
  }
}

void PrintText(const Evaluation& evaluation) {
  if (evaluation.relations) {
    const RelationsError& relations = *evaluation.relations;
    std::cout << "relations: " << relations.used << " of " << relations.count << " used\n";
    if (relations.used > 0) {
      Line("translation", SpreadText(relations.translation_m, 4, "m"));
      Line("rotation", SpreadText(relations.rotation_deg, 3, "deg"));
    }
  }
  if (evaluation.trajectory) PrintTrajectory(*evaluation.trajectory);
  if (evaluation.closures) PrintClosures(*evaluation.closures);
  if (evaluation.floors) {
    std::cout << "floors\n";
    Line("right", Percent(evaluation.floors->Right()) + " of " +
                      std::to_string(evaluation.floors->scans) + " scans outside transit");
  }
  if (evaluation.path_length) {
    std::cout << "path length: " << evaluation.path_length->error_m.count << " pairs of stamps\n";
    Line("error", "mean " + Fixed(evaluation.path_length->error_m.mean, 3) + " m");
    Line("missing closures", Fixed(evaluation.path_length->missing_m, 3) + " m too long");
    Line("false closures", Fixed(evaluation.path_length->false_m, 3) + " m too short");
  }
}

int RunEvaluate(const EvaluateArguments& arguments) {
  if (arguments.relations.empty() && arguments.truth.empty() && arguments.checked.empty()) {
    throw InputError("evaluate: nothing to compare with: give --relations, --truth or --checked");
  }
  const Evaluation evaluation = Evaluate(arguments);
  if (!arguments.truth.empty() && !evaluation.trajectory) {
    throw InputError(arguments.truth + ": no scan of " + arguments.folder +
                     " has a stamp of this truth");
  }
  if (evaluation.relations && evaluation.relations->used == 0) {
    throw InputError(arguments.relations + ": no relation falls inside the trajectory of " +
                     arguments.folder);
  }
  (arguments.json ? PrintJson : PrintText)(evaluation);
  return 0;
}

}  // namespace

void AddEvaluateCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = program.add_subcommand("evaluate", "Hold a map against the truth");
  command->add_option("OUT", arguments->folder, "what `map` wrote")->required();
  command->add_option("--relations", arguments->relations,
                      "true motions of the robot, lines `t1 t2 x y z roll pitch yaw`");
  command->add_option("--truth", arguments->truth,
                      "true poses, lines `t x y z qx qy qz qw` or `t x y theta`; a name that ends "
                      "in .truth.tum says that they are exact");
  command
      ->add_option(
          "--checked", arguments->checked,
          "maps of the same log without false closures: the shortest of their ways are the "
          "true lengths that path lengths are held against")
      ->type_name("OUT...");
  command
      ->add_option("--drive", arguments->drive,
                   "of a map of several logs: this drive alone, with the stamps of its own log;\n"
                   "from 1, in the order of summary.json")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}))
      ->type_name("N");
  command->add_flag("--json", arguments->json, "as JSON, for programs");
  command->add_flag("--quiet", arguments->quiet, "print errors and the result only");
  command->footer(
      "Floors are read from X.truth_floors.csv beside X.truth.tum. A closure is false when it is\n"
      "off by more than 0.5 m or 5 deg (1 m or 15 deg where the truth is not exact).\n\n"
      "Examples:\n"
      "  masked_mapper evaluate out --relations aces.relations\n"
      "  masked_mapper evaluate out --truth campus.log.truth.tum --json\n"
      "  masked_mapper evaluate out --drive 2 --truth tuesday.log.truth.tum\n"
      "  masked_mapper evaluate out --checked out other-mask");
  command->callback([arguments, &run] { run = [arguments] { return RunEvaluate(*arguments); }; });
}

}  // namespace masked_mapper
