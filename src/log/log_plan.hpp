// SPDX-License-Identifier: BSD-3-Clause
// A log that was looked at: all that its format must know to read it, pass after pass.
#pragma once

#include <memory>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"

namespace masked_mapper {

class LogPlan {
 public:
  virtual ~LogPlan() = default;

  /// A pass from the beginning. Nothing of the plan need outlive it.
  virtual std::unique_ptr<LogReader> Read() = 0;

  /// Behind a pass to the end: whether all of the log says otherwise than its beginning did, so
  /// that what was read is to be read again.
  virtual bool Reconsider() { return false; }

  /// Passes from now on keep some of the clouds that they cut scans from.
  virtual void KeepClouds() {}
  /// Those of the last pass, once it was read to its end.
  virtual std::vector<StampedCloud> KeptClouds() const { return {}; }

  /// What was found out of the sensors, as far as the log was read.
  virtual std::vector<SensorFinding> Findings() const { return {}; }
};

}  // namespace masked_mapper
