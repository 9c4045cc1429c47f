// SPDX-License-Identifier: BSD-3-Clause
// One thing that a log's own data say of a sensor, against or beyond what the log claims of it.
#pragma once

#include <string>

namespace masked_mapper {

struct SensorFinding {
  std::string what;         ///< "clock of the first scans", with the unit of the value in its words
  double value = 0.0;       ///< in SI units
  double sigma = 0.0;       ///< of the value; 0: it is exact
  double t_a = 0.0;         ///< s, the span of the log that it is about, by its stamps
  double t_b = 0.0;         ///< s
  std::string consequence;  ///< what was done about it, or what the user can do
};

/// For people, in one line.
inline std::string TextOf(const SensorFinding& finding) {
  return finding.what + ": " + finding.consequence;
}

}  // namespace masked_mapper
