// SPDX-License-Identifier: BSD-3-Clause
// A log whose wheels lie, read as if they did not: what a survey found out of them is put right
// before anybody else reads it.
#pragma once

#include <memory>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/sensor/time_span.hpp"

namespace masked_mapper {

struct OdometryMending {
  double scan_clock_s = 0.0;    ///< s by which the stamps of scans are ahead of the odometry's
  double travel_factor = 1.0;   ///< true travel over what wheels say
  double turn_factor = 1.0;     ///< the same of turns
  bool turns_left_out = false;  ///< turns by wheels are of no use, the length of their way is
  /// In which wheels say nothing of use, by the stamps of scans as they are read with
  /// `scan_clock_s` taken off; in order, ends included.
  std::vector<TimeSpan> left_out;

  bool IsNone() const {
    return scan_clock_s == 0.0 && travel_factor == 1.0 && turn_factor == 1.0 && !turns_left_out &&
           left_out.empty();
  }
};

/// The same log mended. Scans keep their `log_stamp`; where wheels are left out they come without
/// odometry, and so does nothing else of the wheels. Where turns are left out, the wheels' path
/// goes straight on along x. In order of the new stamps.
std::unique_ptr<LogReader> Mended(std::unique_ptr<LogReader> log, OdometryMending mending);

}  // namespace masked_mapper
