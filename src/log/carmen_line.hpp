// SPDX-License-Identifier: BSD-3-Clause
// One line of a CARMEN log, taken apart without a locale and without a string per number. What the
// fields mean for the robot (no-return ranges, the laser's place) is decided elsewhere, from the
// log as a whole.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// The next number of [cursor, end), which moves behind it; empty when there is none or when more
/// than the number stands in its word. `inf` and `nan` are numbers; what is too large (or too
/// small) for a double becomes the largest finite one. `*end` must be readable and no part of a
/// number (a newline, or a string's own zero).
std::optional<double> ParseNumber(const char*& cursor, const char* end);

/// FLASER or ROBOTLASER1 as written, SI and radians.
struct CarmenScan {
  bool is_flaser = true;
  std::size_t beams = 0;
  double start_angle = 0.0;    ///< rad, ROBOTLASER1 only
  double field_of_view = 0.0;  ///< rad, ROBOTLASER1 only
  double angle_step = 0.0;     ///< rad, ROBOTLASER1 only
  double maximum_range = 0.0;  ///< m, ROBOTLASER1 only
  Pose2 T_odom_laser;
  Pose2 T_odom_robot;
  double stamp = 0.0;         ///< s
  std::vector<float> ranges;  ///< m, as written; empty unless asked for
};

struct CarmenParam {
  std::string name;
  std::string value;
};

/// A message that is none of ours, by its name.
struct CarmenOther {
  std::string name;
};

/// Why a line was skipped.
struct CarmenError {
  std::string reason;
};

/// Blank or `#`.
struct CarmenNothing {};

using CarmenLine =
    std::variant<CarmenNothing, CarmenScan, OdometryReading, PressureReading, AccelerationReading,
                 FloorLabel, CarmenParam, CarmenOther, CarmenError>;

/// Takes [begin, end) apart; `*end` as for ParseNumber. A carriage return before the end is
/// ignored.
CarmenLine ParseCarmenLine(const char* begin, const char* end, bool read_ranges);

}  // namespace masked_mapper
