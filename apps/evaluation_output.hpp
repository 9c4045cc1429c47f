// SPDX-License-Identifier: BSD-3-Clause
// What `evaluate` prints.
#pragma once

#include <optional>

#include "masked_mapper/evaluation/closures.hpp"
#include "masked_mapper/evaluation/floors.hpp"
#include "masked_mapper/evaluation/path_length.hpp"
#include "masked_mapper/evaluation/relations.hpp"
#include "masked_mapper/evaluation/trajectory_error.hpp"

namespace masked_mapper {

/// What could be computed of the given inputs.
struct Evaluation {
  std::optional<RelationsError> relations;
  std::optional<TrajectoryError> trajectory;
  std::optional<ClosureError> closures;
  std::optional<FloorIdentity> floors;
  std::optional<PathLengthError> path_length;
};

void PrintEvaluation(const Evaluation& evaluation, bool as_json);

}  // namespace masked_mapper
