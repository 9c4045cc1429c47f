// SPDX-License-Identifier: BSD-3-Clause
#include "driven_way.hpp"

namespace masked_mapper {

void DrivenWay::BeginLog(MotionSource source) {
  options_.source = source;
  motion_.reset();
  stamp_before_.reset();
  carrying_.Break();
}

void DrivenWay::Observe(const OdometryReading& reading) {
  if (motion_) motion_->Observe(reading);
}

LaserScan DrivenWay::Observe(const LaserScan& bent, bool must_match) {
  if (!motion_) {
    MotionOptions settled = options_;
    if (settled.source == MotionSource::kAuto) {
      settled.source = bent.T_odom_robot ? MotionSource::kFused : MotionSource::kScans;
    }
    motion_.emplace(settled);
  }
  carried_ = carrying_.Observe(bent);
  motion_->Observe(bent, must_match);
  const Pose2& T_odom_robot = motion_->T_odom_robot();
  const bool is_first = !stamp_before_;
  const Pose2 step = is_first ? Pose2{} : Between(T_odom_before_, T_odom_robot);
  const double elapsed_s = is_first ? 0.0 : bent.stamp - *stamp_before_;
  step_m_ = carried_.empty() ? step.Translation().norm() : 0.0;
  travelled_m_ += step_m_;
  stamp_before_ = bent.stamp;
  T_odom_before_ = T_odom_robot;
  // As the mapper does where wheels did not straighten it: by the step that it made.
  const bool may_straighten = bent.beam_time != 0.0 && !is_first;
  return StraightenedBySteps(bent, may_straighten ? step : Pose2{},
                             may_straighten ? elapsed_s : 0.0);
}

}  // namespace masked_mapper
