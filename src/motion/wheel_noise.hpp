// SPDX-License-Identifier: BSD-3-Clause
// How good this robot's heading is, learnt on the way. The defaults of dead reckoning cover the
// worst wheels of public logs; a robot with a gyro is twenty times better, and where scans see
// little (an elevator's cab, stairs) that is what its heading hangs on. The paper takes the noise
// of its odometry as given; this is ours.
#pragma once

#include "dead_reckoning.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/motion/motion_options.hpp"

namespace masked_mapper {

/// Factors of the heading sigmas of dead reckoning, at most 1.
struct WheelScales {
  double travel = 1.0;
  double turn = 1.0;
};

class WheelNoise {
 public:
  WheelNoise(const WheelNoiseOptions& options, const DeadReckoningOptions& wheels);

  /// One step by wheels, what scans made of it, and the sigma of the scan's heading against its map
  /// in radians (infinite when the step was not corrected).
  void Observe(const Pose2& by_wheels, const Pose2& corrected, double scan_sigma_rad);

  /// The window that runs began elsewhere: start another.
  void Restart();

  WheelScales scales() const;

  /// The state, for a checkpoint (sensor/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(travel_.mean, travel_.windows, turn_.mean, turn_.windows, runs_, travelled_m_,
            turned_rad_, error_rad_);
  }

 private:
  struct Ratio {
    double mean = 1.0;  ///< of squared error over the variance that dead reckoning expects
    double windows = 0.0;
  };
  void Learn(double squared_error, double expected, Ratio& ratio) const;

  WheelNoiseOptions options_;
  DeadReckoningOptions wheels_;
  Ratio travel_;
  Ratio turn_;
  bool runs_ = false;  ///< a window that began at a sure scan
  double travelled_m_ = 0.0;
  double turned_rad_ = 0.0;
  double error_rad_ = 0.0;
};

}  // namespace masked_mapper
