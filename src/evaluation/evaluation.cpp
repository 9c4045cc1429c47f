// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/evaluation.hpp"

#include <algorithm>
#include <utility>

#include "closures.hpp"
#include "floors.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "path_length.hpp"
#include "relations.hpp"
#include "result_folder.hpp"
#include "trajectory_error.hpp"
#include "truth.hpp"

namespace masked_mapper {
namespace {

MappedGraph GraphOf(const ResultFolder& result, const std::string& folder) {
  if (result.graph && result.graph->nodes.size() > 1) return *result.graph;
  throw InputError("--checked: " + folder + " has no graph of two nodes or more");
}

/// With --checked, the paper's truth: the shortest way over maps that are free of false closures.
std::optional<PathLengthError> ErrorAgainstChecked(const EvaluationInputs& inputs,
                                                   const ResultFolder& result,
                                                   const std::vector<StampPair>& pairs) {
  const auto stamps = [](const ResultFolder& map) {
    return std::make_pair(map.scans.front().stamp, map.scans.back().stamp);
  };
  std::vector<MappedGraph> checked;
  for (const std::string& folder : inputs.checked) {
    const ResultFolder map = ReadResultFolder(folder);
    checked.push_back(GraphOf(map, folder));
    if (stamps(map) != stamps(result)) {
      throw InputError("--checked: " + folder + " is no map of the log of " + inputs.folder);
    }
  }
  return CompareWithCheckedMaps(GraphOf(result, inputs.folder), checked, pairs);
}

/// A truth of one drive says nothing of the others, whose stamps may be shifted besides.
void RequireTruthOfAll(const EvaluationInputs& inputs, const ResultFolder& result,
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
  throw InputError(inputs.folder + " holds " + std::to_string(result.drives.size()) +
                   " drives, and " + inputs.truth +
                   " is not the truth of all: say of which with --drive N");
}

}  // namespace

Evaluation Evaluate(const EvaluationInputs& inputs) {
  ResultFolder result = ReadResultFolder(inputs.folder);
  if (inputs.drive > 0) result = OneDrive(inputs.folder, result, inputs.drive);
  Evaluation evaluation;
  if (!inputs.relations.empty()) {
    evaluation.relations = CompareWithRelations(result.trajectory, ReadRelations(inputs.relations));
  }
  const std::vector<StampPair> pairs =
      DrawStampPairs(result.scans.front().stamp, result.scans.back().stamp);
  if (!inputs.checked.empty()) {
    evaluation.path_length = ErrorAgainstChecked(inputs, result, pairs);
  }
  if (inputs.truth.empty()) return evaluation;
  const Truth truth = ReadTruth(inputs.truth);
  RequireTruthOfAll(inputs, result, truth);
  evaluation.trajectory = CompareWithTruth(result.trajectory, truth, result.floors);
  evaluation.floors = CompareFloors(result.trajectory, result.floors, truth.floors);
  if (!result.graph) return evaluation;
  const auto true_nodes = TruePosesOf(result.graph->log_stamps, truth, result.trajectory);
  const ClosureTolerance tolerance = ToleranceOf(truth);
  if (result.closures) {
    evaluation.closures = CheckClosures(*result.graph, *result.closures, true_nodes, tolerance);
  }
  if (inputs.checked.empty()) {
    evaluation.path_length = ComparePathLengths(*result.graph, true_nodes, pairs, tolerance);
  }
  return evaluation;
}

}  // namespace masked_mapper
