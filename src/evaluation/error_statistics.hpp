// SPDX-License-Identifier: BSD-3-Clause
// What is said of a list of errors: mean, spread, median, and the worst.
#pragma once

#include <cstddef>
#include <vector>

#include "masked_mapper/evaluation/evaluation.hpp"

namespace masked_mapper {

/// All zero for no errors.
ErrorStatistics StatisticsOf(const std::vector<double>& errors);

}  // namespace masked_mapper
