// SPDX-License-Identifier: BSD-3-Clause
// What a person wants to know of a log before mapping it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper {

struct LogSummary {
  LogStatistics statistics;
  std::vector<SensorFinding> findings;
  double duration_s = 0.0;
  double path_length_m =
      0.0;                  ///< by the odometry of the scans; of the ODOM lines if scans have none
  double turned_rad = 0.0;  ///< sum of all turns, by the same
  bool has_odometry = false;

  std::map<std::size_t, std::uint64_t> scans_of_beams;  ///< number of beams -> scans with so many
  double field_of_view_rad = 0.0;                       ///< widest
  Pose2 T_robot_laser;                                  ///< of the first scan
  double max_range_m = 0.0;

  /// Ranges below which 5, 25, 50, 75 and 95 % of all returns lie, m, to the centimetre; 0 without
  /// any.
  static constexpr std::array<double, 5> kQuantiles = {0.05, 0.25, 0.50, 0.75, 0.95};
  std::array<double, 5> range_quantiles_m{};
  double share_no_return = 0.0;  ///< of all beams
  double share_invalid = 0.0;    ///< of all beams

  double scan_rate_hz = 0.0;  ///< of each kind: the inverse of the median step between stamps
  double odometry_rate_hz = 0.0;
  double pressure_rate_hz = 0.0;
  double acceleration_rate_hz = 0.0;
  double largest_gap_s = 0.0;      ///< between scans
  double largest_gap_stamp = 0.0;  ///< s, the stamp of the scan before it
};

/// Reads the log from end to end; once more when all of it says otherwise than its beginning.
LogSummary Summarise(LogSource& source);

/// What was skipped or mended, and what has nothing to say, a line each for people.
std::vector<std::string> WarningsOf(const LogStatistics& log);

}  // namespace masked_mapper
