// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/motion_estimator.hpp"

#include <algorithm>
#include <cassert>

namespace masked_mapper {

MotionEstimator::MotionEstimator(const MotionOptions& options)
    : options_(options), wheels_(options.odometry), scan_odometry_(options.scans) {
  assert(options.source != MotionSource::kAuto);
}

void MotionEstimator::Observe(const OdometryReading& reading) { wheels_.Observe(reading); }

void MotionEstimator::Observe(const LaserScan& scan, bool must_match) {
  if (scan.T_odom_robot) wheels_.Observe({scan.stamp, *scan.T_odom_robot});
  const bool has_wheels = wheels_.HasStarted() && options_.source != MotionSource::kScans;
  UncertainPose2 step = has_wheels ? wheels_.T_node_robot() : StepWithoutWheels(scan.stamp);
  wheels_.StartNode();
  if (options_.source != MotionSource::kOdometry)
    step = scan_odometry_.Observe(scan, step, must_match);
  last_step_s_ = last_scan_stamp_ ? scan.stamp - *last_scan_stamp_ : 0.0;
  last_scan_stamp_ = scan.stamp;
  last_step_ = step;
  T_odom_robot_ = T_odom_robot_ * step.mean;
  T_node_robot_ = T_node_robot_ * step;
}

// Ours: the speed of the step before goes on, and may change by what a robot of a person's pace
// does.
UncertainPose2 MotionEstimator::StepWithoutWheels(double stamp) const {
  UncertainPose2 step;
  if (!last_scan_stamp_) return step;
  const double elapsed = std::max(0.0, stamp - *last_scan_stamp_);
  if (last_step_s_ > 0.0) {
    const double ratio = std::min(2.0, elapsed / last_step_s_);
    step.mean = {ratio * last_step_.mean.x, ratio * last_step_.mean.y,
                 ratio * last_step_.mean.theta};
  }
  const double sigma_m = options_.wheelless.sigma_speed_m_per_s * elapsed;
  const double sigma_rad = DegToRad(options_.wheelless.sigma_turn_deg_per_s) * elapsed;
  step.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  return step;
}

}  // namespace masked_mapper
