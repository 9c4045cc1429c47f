// SPDX-License-Identifier: BSD-3-Clause
// Gives each scan the odometry at its own stamp, for logs whose scans come without: read between
// the odometry before and after it (Interpolate). Scans wait for the odometry behind them, but not
// long.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class OdometryAtScans {
 public:
  /// In order of stamps. `stream` is handed through.
  void Add(Observation observation, std::size_t stream);
  /// No more will come.
  void Finish() { finished_ = true; }
  /// Kept for scans that may come; bounded, also where none does.
  std::size_t readings_kept() const { return readings_.size(); }
  /// The next observation, in the order in which they were added.
  std::optional<std::pair<Observation, std::size_t>> Next();

 private:
  bool Complete(LaserScan* scan);
  void Forget(double stamp);

  std::deque<std::pair<Observation, std::size_t>> waiting_;
  std::size_t scans_waiting_ = 0;
  std::deque<OdometryReading> readings_;  ///< from a little before the first waiting scan on
  double newest_ = 0.0;                   ///< s
  bool finished_ = false;
};

}  // namespace masked_mapper
