// SPDX-License-Identifier: BSD-3-Clause
// A map held against the truth: how far off it is, in the words of those who measure maps.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace masked_mapper {

struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0.0;
  double std = 0.0;     ///< of the population
  double median = 0.0;  ///< the upper one of two middle values
  double p99 = 0.0;     ///< the smallest value that 99 % do not exceed
  double max = 0.0;
};

struct RelationsError {
  std::size_t count = 0;
  std::size_t used = 0;  ///< both stamps lie in the trajectory, or within 0.5 s of it
  ErrorStatistics translation_m;
  ErrorStatistics rotation_deg;
};

struct AbsoluteError {
  ErrorStatistics position_m;  ///< in the plane
  ErrorStatistics heading_deg;
};

struct FloorError {
  std::string label;
  AbsoluteError as_it_stands;
  AbsoluteError aligned;  ///< each floor by itself
};

struct TrajectoryError {
  std::size_t scans = 0;
  std::size_t paired = 0;  ///< scans whose true pose is known (`TruePoseAt`)
  AbsoluteError as_it_stands;
  AbsoluteError aligned;
  ErrorStatistics elevation_m;
  double relative_over_m = 10.0;  ///< length of the stretches along the true way
  ErrorStatistics relative_translation_m;
  ErrorStatistics relative_rotation_deg;
  std::vector<FloorError> floors;  ///< the map's floors that have paired scans
};

struct FalseClosure {
  double stamp_a = 0.0;  ///< s
  double stamp_b = 0.0;  ///< s
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};

struct ClosureError {
  std::size_t validated = 0;
  std::size_t checked = 0;  ///< validated, and the truth at both ends is known
  std::size_t true_pairs = 0;
  std::size_t closed_pairs = 0;
  std::vector<FalseClosure> false_closures;

  std::optional<double> Precision() const;  ///< share of the checked ones that are true
  std::optional<double> Recall() const;     ///< share of the true pairs that are closed
};

struct FloorIdentity {
  std::size_t scans = 0;       ///< outside transit, with a true floor
  std::size_t right = 0;       ///< up to the renaming
  std::size_t same_label = 0;  ///< label and true label are the same text
  std::map<std::string, std::string>
      renaming;  ///< true label of each of the map's, where it has one

  double Right() const { return static_cast<double>(right) / static_cast<double>(scans); }
};

struct PathLengthError {
  ErrorStatistics error_m;  ///< of the magnitude, over all pairs
  double missing_m = 0.0;   ///< mean over all pairs of what is too long
  double false_m = 0.0;     ///< mean over all pairs of what is too short; the two sum to the mean
};

/// What could be computed of the given inputs.
struct Evaluation {
  std::optional<RelationsError> relations;
  std::optional<TrajectoryError> trajectory;
  std::optional<ClosureError> closures;
  std::optional<FloorIdentity> floors;
  std::optional<PathLengthError> path_length;
};

/// The truth stands in what is given; at least one of `relations`, `truth` and `checked` is.
struct EvaluationInputs {
  std::string folder;     ///< what `map` wrote
  std::string relations;  ///< file of true motions between stamps; empty: none
  std::string truth;      ///< file of true poses; empty: none
  /// Folders of maps of the same log that are known to be free of false closures.
  std::vector<std::string> checked;
  std::size_t drive = 0;  ///< of a map of several logs, from 1; 0: all of it
};

/// Throws InputError where something cannot be read, or cannot be held against the map.
Evaluation Evaluate(const EvaluationInputs& inputs);

}  // namespace masked_mapper
