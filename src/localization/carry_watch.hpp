// SPDX-License-Identifier: BSD-3-Clause
// Whether a robot may have been carried, pushed or powered off between two scans: its motion tells
// nothing of it.
#pragma once

#include <optional>
#include <string>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

class CarryWatch {
 public:
  /// Another log begins.
  void Break() { is_broken_ = stamp_before_.has_value(); }

  /// Scans in order. Why the robot may be elsewhere than its motion since the scan before says, for
  /// people; empty: no reason.
  std::string Observe(const LaserScan& scan);

 private:
  bool is_broken_ = false;
  std::optional<double> stamp_before_;  ///< s
  std::optional<Pose2> T_odom_before_;  ///< by the wheels
};

}  // namespace masked_mapper
