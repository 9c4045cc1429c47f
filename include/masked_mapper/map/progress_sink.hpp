// SPDX-License-Identifier: BSD-3-Clause
// What mapping tells while it works. The library never prints: who wants to show a bar, or to save
// what is done so far, implements this. Every call comes from the thread that called the mapper.
#pragma once

#include <cstdint>
#include <string>

namespace masked_mapper {

class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  /// A new stage begins ("mapping", "rendering"); the progress of the last one is over.
  virtual void Stage(const std::string& /*name*/) {}
  /// Share of the stage that is done, 0 to 1, and the scans worked on so far in it.
  virtual void Progress(double /*fraction*/, std::uint64_t /*scans*/) {}
  /// One line that a person should read; the work goes on.
  virtual void Warn(const std::string& /*message*/) {}
};

}  // namespace masked_mapper
