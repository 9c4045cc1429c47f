// SPDX-License-Identifier: BSD-3-Clause
// Writing observations as CARMEN text (DESIGN, Logs), gzip when the name ends in `.gz`.
#pragma once

#include <memory>
#include <string>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class LogWriter {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  explicit LogWriter(const std::string& path);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Scans are written as ROBOTLASER1 when they carry geometry FLASER cannot say, else as FLASER;
  /// the ranges with `decimals` digits.
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
