// SPDX-License-Identifier: BSD-3-Clause
// A first pass over a log: what it holds, and what must be known before the first scan is mapped.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/mapping/mapping_options.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/motion/sweep_check.hpp"

namespace masked_mapper {

struct LogSurvey {
  std::uint64_t scans = 0;
  bool has_odometry = false;
  bool odometry_moves = false;   ///< if not, something else was written where odometry belongs
  double median_travel_m = 0.0;  ///< by wheels, from scan to scan, of those that moved
  double median_turn_rad = 0.0;
  double median_period_s = 0.0;
  double sweep_s_per_rad = 0.0;  ///< of the scanner, signed as SweepTiming has it; 0: not bent
  FloorTimeline floors;
  FloorSource floor_source = FloorSource::kNone;  ///< what the floors were found by
  std::vector<SensorFinding> findings;
  OdometryMending mending;  ///< of what scans found out of the wheels; the source is mended so
  std::optional<DeadReckoningOptions> wheels;  ///< as closures found them, where that was asked
  bool reconsidered = false;  ///< all of the log said otherwise of its sensors than its beginning
  std::vector<std::string> warnings;
};

/// Wheels that scans find to lie are mended in `source`, and the log is then surveyed as mended.
/// Throws InputError when the log cannot be read or holds no scan, or its file of floors is not one
/// of this log.
LogSurvey SurveyLog(LogSource& source, const MappingOptions& options);

/// What `options.source` comes to for this log. Throws InputError when wheels are asked for and the
/// log has none; `path` is for the message.
MotionSource SettleMotionSource(const std::string& path, const MotionOptions& options,
                                const LogSurvey& survey);

/// A pass from the beginning. Without wheels scans come as they are, with the time of their beams.
std::unique_ptr<LogReader> ReadStraightened(const LogSource& source, const SweepTiming& timing);

}  // namespace masked_mapper
