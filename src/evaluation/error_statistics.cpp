// SPDX-License-Identifier: BSD-3-Clause
#include "error_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {

ErrorStatistics StatisticsOf(const std::vector<double>& errors) {
  ErrorStatistics statistics;
  statistics.count = errors.size();
  if (errors.empty()) return statistics;
  const auto count = static_cast<double>(errors.size());
  double sum = 0.0;
  for (const double error : errors) sum += error;
  statistics.mean = sum / count;
  double squares = 0.0;
  for (const double error : errors) {
    squares += (error - statistics.mean) * (error - statistics.mean);
  }
  statistics.std = std::sqrt(squares / count);
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  statistics.median = sorted[sorted.size() / 2];
  statistics.p99 = sorted[(99 * sorted.size() + 99) / 100 - 1];
  statistics.max = sorted.back();
  return statistics;
}

}  // namespace masked_mapper
