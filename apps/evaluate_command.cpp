// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper evaluate OUT [--relations FILE] [--truth FILE] [--checked OUT...] [--json]
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "evaluation_output.hpp"
#include "masked_mapper/evaluation/result_folder.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct EvaluateArguments {
  std::string folder;
  std::string relations;
  std::string truth;
  std::vector<std::string> checked;
  std::size_t drive = 0;  ///< of a map of several logs, from 1; 0: all of it
  bool json = false;
  bool quiet = false;
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
  PrintEvaluation(evaluation, arguments.json);
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
