// SPDX-License-Identifier: BSD-3-Clause
// The clouds of a bag once more, for a map that was made of it: every return of every sweep,
// straightened and levelled as the scans of the map were, one sweep at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

class CloudSource {
 public:
  /// Bags of one recording, in its order. Throws InputError as LogSource does, and where the scans
  /// of the log are no clouds.
  CloudSource(const std::vector<std::string>& paths, const LogOptions& options);
  ~CloudSource();

  /// The next in the order of recording; empty at the end. Of several lidars, each sweep by itself.
  std::optional<LevelledCloud> Next();
  /// Share of the log consumed so far, 0 to 1.
  double Progress() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
