// SPDX-License-Identifier: BSD-3-Clause
// Reading a robot's log one observation at a time; memory does not grow with the log.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

struct LogOptions {
  double max_range = 0.0;   ///< m; ranges at or beyond it are "no return"; 0: found from the log
  double min_range = 0.05;  ///< m; anything nearer says nothing
  double laser_x = 0.0;  ///< m, scanner on the robot; any of the three not 0: the log is overruled
  double laser_y = 0.0;  ///< m
  double laser_theta_deg = 0.0;    ///< deg
  bool upside_down = false;        ///< the scanner hangs: beams run the other way than the log says
  double field_of_view_deg = 0.0;  ///< deg, of FLASER; 0: by PARAM, else by the number of beams
  bool read_ranges = true;         ///< false: scans come without beams

  // Of ROS bags. Empty: the only topic of its type; `none`: not to be read.
  std::string scan_topic;      ///< several, separated by commas, are merged into one virtual scan
  std::string odometry_topic;  ///< without any: tf from odom to the robot
  std::string odom_frame;  ///< of tf, which is then read for odometry; empty: found by what moves
  std::string imu_topic;   ///< for the vertical acceleration
  std::string pressure_topic;
  bool strongest_echo = false;  ///< of MultiEchoLaserScan; false: the first
};

/// What a reader met so far. Everything skipped is counted here and nowhere else.
struct LogStatistics {
  std::uint64_t lines = 0;  ///< lines or messages read
  std::uint64_t scans = 0;
  std::uint64_t odometry = 0;  ///< odometry readings of their own (not those inside scans)
  std::uint64_t pressure = 0;
  std::uint64_t acceleration = 0;
  std::uint64_t floor_labels = 0;
  std::uint64_t bad_lines = 0;       ///< skipped: malformed, wrong count, not a number
  std::string first_bad_line;        ///< "line 17: FLASER: expected 180 ranges, found 179"
  std::uint64_t invalid_ranges = 0;  ///< single beams skipped: NaN, negative or absurdly far
  std::uint64_t empty_scans = 0;     ///< valid, but not one beam returned
  std::uint64_t stamp_jumps = 0;     ///< stamps that stepped backwards or wrapped, and were mended
  std::uint64_t reordered = 0;  ///< messages logged late, and put back in the order of their stamps
  bool truncated = false;       ///< the file ends in the middle of a line or of its gzip stream
  std::uint64_t trailing_bytes = 0;  ///< bytes after the end of the gzip stream, ignored
  std::map<std::string, std::uint64_t> other_messages;  ///< counted, not read
  double max_range = 0.0;                               ///< m, the limit in force (given or found)
  double first_stamp = 0.0;                             ///< s
  double last_stamp = 0.0;                              ///< s
};

class LogReader {
 public:
  virtual ~LogReader() = default;
  /// The next observation in order of stamps; empty at the end of the log.
  virtual std::optional<Observation> Next() = 0;
  /// Complete once Next() has returned empty; before, it may be a few observations ahead.
  virtual const LogStatistics& Statistics() const = 0;
  /// Share of the file consumed so far, 0 to 1, for progress.
  virtual double Progress() const = 0;
};

/// One pass through a log that is told by its content (CARMEN text, plain or gzip; ROS 1 or ROS 2
/// bag). Who reads it more than once opens a LogSource. Throws InputError as that does.
std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogOptions& options);

}  // namespace masked_mapper
