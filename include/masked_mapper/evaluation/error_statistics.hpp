// SPDX-License-Identifier: BSD-3-Clause
// What is said of a list of errors: mean, spread, median, and the worst.
#pragma once

#include <cstddef>
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

/// All zero for no errors.
ErrorStatistics StatisticsOf(const std::vector<double>& errors);

}  // namespace masked_mapper
