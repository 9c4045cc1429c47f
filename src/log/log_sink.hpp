// SPDX-License-Identifier: BSD-3-Clause
// What a log is written to, of whatever kind.
#pragma once

#include <memory>
#include <string>

#include "masked_mapper/log/log_writer.hpp"

namespace masked_mapper {

class LogSink {
 public:
  virtual ~LogSink() = default;
  virtual void Write(const Observation& observation) = 0;
  virtual void WriteCloud(const CloudReading& cloud) = 0;
  /// Where the kind of log has a place for it.
  virtual void WriteComment(const std::string& text) = 0;
  /// Throws std::runtime_error when anything could not be written.
  virtual void Close() = 0;
};

}  // namespace masked_mapper
