// SPDX-License-Identifier: BSD-3-Clause
// How far off the way is while no wheels are heard. The speed of the step before goes on
// (MotionEstimator), and so does what is wrong with it: where walls are blank along the way, errors
// of steps add up, and do not cancel out as those of independent steps would. Ours; a Kalman filter
// of the speed's error, which lasts for a while, of which only the covariance is asked.
#pragma once

#include <Eigen/Core>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

class UnheardSpeed {
 public:
  /// A step that wheels tell of: its speed is theirs.
  void Hear(const UncertainPose2& T_last_now, double elapsed);

  /// Of a step as it was guessed, m: variance from one step to the next, and sigma in the long run.
  struct Guess {
    double variance = 0.0;
    double most_sigma = 0.0;
  };
  /// A step without wheels, of `elapsed` > 0 s, of which a scan saw so much (information of x and
  /// y, in last). The covariance of the step, in last, such that the sum over the steps since
  /// StartWay is that of the way.
  Eigen::Matrix3d Observe(const UncertainPose2& T_last_now, const Guess& guess,
                          const Eigen::Matrix2d& seen, double elapsed);

  /// The way that is asked for begins here.
  void StartWay() { way_step_.setZero(); }

  template <class Archive>
  void Serialize(Archive& archive) {
    archive(T_last_now_, elapsed_, step_, way_step_);
  }

 private:
  void Keep(const UncertainPose2& T_last_now, double elapsed, const Eigen::Matrix2d& step);

  Pose2 T_last_now_;                                    ///< the step before
  double elapsed_ = 0.0;                                ///< s, of it; 0: none yet
  Eigen::Matrix2d step_ = Eigen::Matrix2d::Zero();      ///< covariance of its error, m^2, in last
  Eigen::Matrix2d way_step_ = Eigen::Matrix2d::Zero();  ///< of the way's error with the step's
};

}  // namespace masked_mapper
