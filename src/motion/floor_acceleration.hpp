// SPDX-License-Identifier: BSD-3-Clause
// Changes of floor by acceleration. A cab that carries a resting robot pushes it once and catches
// it once. Between the two the cab moves, before and after it stands, so the integral may be held
// to zero speed at both ends and what is left is the climb. On stairs and ramps the robot is
// pitched while its wheels turn: the sine of the pitch, times their way, is the climb.
#pragma once

#include <string>
#include <vector>

#include "floor_pressure.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// Vertical acceleration over the drive, thinned as it comes.
class AccelerationTrack {
 public:
  explicit AccelerationTrack(const FloorAccelerationOptions& options) : options_(options) {}

  /// Readings in order of stamps; what is not finite or steps back in time is left out.
  void Observe(const AccelerationReading& reading);

  bool IsEmpty() const { return spells_.empty() && count_ == 0; }

  /// Of what is kept, in order.
  std::vector<double> Stamps() const;

  struct Rides {
    std::vector<FloorTransit> transits;  ///< in order
    bool usable = false;                 ///< false: the readings are not those of an accelerometer
    std::vector<std::string> warnings;
  };
  Rides FindRides(const WheelTrack& track, const StoreyOptions& storeys) const;

 private:
  struct Spell {
    double stamp = 0.0;
    Eigen::Vector3d acceleration_in_robot = Eigen::Vector3d::Zero();
  };
  Spell Current() const;

  FloorAccelerationOptions options_;
  std::vector<Spell> spells_;
  // The spell that is still growing.
  double first_stamp_ = 0.0;
  double last_stamp_ = 0.0;
  double stamps_ = 0.0;  ///< from the first
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace masked_mapper
