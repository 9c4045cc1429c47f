// SPDX-License-Identifier: BSD-3-Clause
// What `evaluate` prints.
#pragma once

#include "masked_mapper/evaluation/evaluation.hpp"

namespace masked_mapper {

void PrintEvaluation(const Evaluation& evaluation, bool as_json);

}  // namespace masked_mapper
