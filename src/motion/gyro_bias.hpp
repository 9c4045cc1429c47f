// SPDX-License-Identifier: BSD-3-Clause
// The drift of a gyro in odometry's heading, learnt while the wheels stand still: what turns then
// is not the robot. Ours; a robot whose heading comes from its wheels alone shows none.
#pragma once

#include <optional>

#include "dead_reckoning.hpp"
#include "masked_mapper/motion/motion_options.hpp"

namespace masked_mapper {

class GyroBias {
 public:
  explicit GyroBias(const GyroBiasOptions& options) : options_(options) {}

  /// Readings in order of stamps.
  void Observe(const OdometryReading& reading);

  /// What the heading drifts, radians per second.
  double rate() const { return rate_; }

  /// The state, for a checkpoint (sensor/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(last_, rate_, seconds_);
  }

 private:
  GyroBiasOptions options_;
  std::optional<OdometryReading> last_;
  double rate_ = 0.0;
  double seconds_ = 0.0;  ///< of rest that the rate is a mean of
};

}  // namespace masked_mapper
