// SPDX-License-Identifier: BSD-3-Clause
// Writing observations as CARMEN text (DESIGN, Logs), gzip when the name ends in `.gz`.
#pragma once

#include <memory>
#include <string>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class LogWriter {
 public:
  /// Ranges are written with `range_decimals` digits (1 to 9), poses and stamps with six.
  /// Throws std::runtime_error when the file cannot be created.
  explicit LogWriter(const std::string& path, int range_decimals = 3);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Scans are written as ROBOTLASER1 when they carry geometry FLASER cannot say, else as FLASER
  /// with a PARAM for their limit. No return is written as the limit, an invalid range as 0. A scan
  /// without odometry gets the last odometry written (identity before there is any).
  void Write(const Observation& observation);
  /// A `#` line.
  void WriteComment(const std::string& text);
  /// Flushes and closes; throws std::runtime_error when anything could not be written (disk full).
  void Close();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
