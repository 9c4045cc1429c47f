// SPDX-License-Identifier: BSD-3-Clause
// A mask of one's own: fires while the robot goes through a doorway. One class, one line.
#include <algorithm>
#include <cmath>
#include <limits>

#include "masked_mapper/masks/mask_registry.hpp"

namespace {

using masked_mapper::DegToRad;
using masked_mapper::LaserScan;

class DoorwayMask : public masked_mapper::Mask {
 public:
  void Observe(const masked_mapper::MaskObservation& observation) override {
    // What nothing returned from is not near: the width is infinite, and no doorway.
    const double left = NearestAbeam(observation.scan, DegToRad(90.0));
    const double right = NearestAbeam(observation.scan, DegToRad(-90.0));
    is_in_doorway_ = left + right < kMaxWidth;
  }
  bool Fires() const override { return is_in_doorway_; }
  void Restart() override { is_in_doorway_ = false; }

 private:
  static constexpr double kMaxWidth = 1.2;  ///< m

  /// Range of the nearest hit within 15 degrees of a direction in the robot frame, m.
  static double NearestAbeam(const LaserScan& scan, double direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t beam = 0; beam < scan.size(); ++beam) {
      if (!scan.IsHit(beam)) continue;
      const double off = scan.T_robot_laser.theta + scan.Angle(beam) - direction;
      if (std::abs(masked_mapper::WrapAngle(off)) > DegToRad(15.0)) continue;
      nearest = std::min<double>(nearest, scan.ranges[beam]);
    }
    return nearest;
  }

  bool is_in_doorway_ = false;
};

const bool kRegistered = masked_mapper::RegisterMask(
    "doorways",
    [](const masked_mapper::MaskOptions& /*options*/) { return std::make_unique<DoorwayMask>(); });

}  // namespace
