// SPDX-License-Identifier: BSD-3-Clause
// Where the wheels put the robot over a whole drive, thinned: when it stood still, and how far it
// went in between. An elevator moves a robot only while its wheels rest; stairs only while they
// turn.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class WheelTrack {
 public:
  /// Readings in order of stamps; what is not finite or steps back in time is left out.
  void Observe(const OdometryReading& reading);

  /// Whether the wheels tell anything: a robot that never gets anywhere has none.
  bool Travels() const;
  /// Metres travelled between two stamps.
  double Travel(double start, double end) const;
  /// The longest period around a stamp in which the robot stays within `radius` (m) of where it is
  /// then; it may turn. Infinite at an end where the robot is still there when the log ends.
  TimeSpan StayAround(double stamp, double radius) const;
  /// Of the stays around the moments of [start, end], the one that has most of it.
  TimeSpan LongestStay(double start, double end, double radius) const;
  /// All stays of `min_duration` (s) and more, in order; they do not overlap.
  std::vector<TimeSpan> Stays(double radius, double min_duration) const;

 private:
  /// The robot stood here from `first` to `last`.
  struct Stand {
    double first = 0.0;
    double last = 0.0;
    Eigen::Vector2d position_in_odom = Eigen::Vector2d::Zero();
    double travelled = 0.0;  ///< m, from the beginning of the log
  };

  std::size_t StandAt(double stamp) const;
  double TravelledAt(double stamp) const;

  std::vector<Stand> stands_;
};

}  // namespace masked_mapper
