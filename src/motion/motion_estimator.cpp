// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/motion_estimator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "dead_reckoning.hpp"
#include "gyro_bias.hpp"
#include "scan_odometry.hpp"
#include "straightened_scan.hpp"
#include "unheard_speed.hpp"
#include "wheel_noise.hpp"

namespace masked_mapper {
namespace {

constexpr double kSurelyBacking = 0.02;  // m that scans have seen a robot back

}  // namespace

LaserScan StraightenedBySteps(LaserScan scan, const Pose2& T_before_now, double seconds) {
  constexpr double kLongest = 2.0;  // s, of a step that tells how the robot goes on
  const bool is_known = seconds > 0.0 && seconds <= kLongest;
  return Straightened(std::move(scan),
                      is_known ? SteadyMotion(T_before_now, seconds) : SteadyMotion(Pose2{}, 1.0));
}

class MotionEstimator::Impl {
 public:
  explicit Impl(const MotionOptions& options);

  void Observe(const OdometryReading& reading);
  void Observe(const LaserScan& scan, bool must_match, const FacedPoints* points = nullptr);
  void StartNode() {
    T_node_robot_ = UncertainPose2{};
    unheard_speed_.StartWay();
  }
  void EnterTransit();
  void LeaveTransit();

  const Pose2& T_odom_robot() const { return T_odom_robot_; }
  const UncertainPose2& last_step() const { return last_step_; }
  const UncertainPose2& T_node_robot() const { return T_node_robot_; }

  template <class Archive>
  void Serialize(Archive& archive) {
    archive(wheels_, gyro_bias_, scan_odometry_, wheel_noise_, last_scan_stamp_, last_step_,
            last_step_s_, unheard_speed_, advance_m_, in_transit_, was_heard_, is_heard_,
            T_odom_robot_, T_node_robot_);
  }

 private:
  void RestartScans();
  bool HearsWheels(const LaserScan& scan);
  UncertainPose2 StepWithoutWheels(double stamp) const;
  UncertainPose2 StepWithoutTurns(double stamp) const;
  void NoteAdvance(double wheel_travel_m, double advance_m);
  void LearnWheelNoise(const Pose2& by_wheels, const Pose2& corrected);

  MotionOptions options_;
  DeadReckoning wheels_;  ///< since the scan before
  GyroBias gyro_bias_;
  ScanOdometry scan_odometry_;
  WheelNoise wheel_noise_;
  std::optional<double> last_scan_stamp_;
  UncertainPose2 last_step_;
  double last_step_s_ = 0.0;
  UnheardSpeed unheard_speed_;
  double advance_m_ = 0.0;   ///< by scans since the wheels rested; below 0 the robot backs
  bool in_transit_ = false;  ///< since the scene was last begun anew
  bool was_heard_ = false;   ///< the wheels, up to the scan before
  bool is_heard_ = false;    ///< the wheels, since the scan before
  Pose2 T_odom_robot_;
  UncertainPose2 T_node_robot_;
};

MotionEstimator::Impl::Impl(const MotionOptions& options)
    : options_(options),
      wheels_(options.odometry),
      gyro_bias_(options.gyro_bias),
      scan_odometry_(options.scans),
      wheel_noise_(options.wheel_noise, options.odometry) {
  assert(options.source != MotionSource::kAuto);
}

void MotionEstimator::Impl::Observe(const OdometryReading& reading) {
  wheels_.Observe(reading);
  is_heard_ = true;
  gyro_bias_.Observe(reading);
}

void MotionEstimator::Impl::RestartScans() {
  in_transit_ = false;
  scan_odometry_.Restart();
  wheel_noise_.Restart();
}

void MotionEstimator::Impl::LeaveTransit() {
  in_transit_ = false;
  scan_odometry_.LeaveTransit();
  wheel_noise_.Restart();
}

// What was seen of the cab on the way into it stays: a map begun anew is as good as its first scan,
// and the robot may turn at once.
void MotionEstimator::Impl::EnterTransit() {
  in_transit_ = true;
  scan_odometry_.EnterTransit();
  wheel_noise_.Restart();
}

void MotionEstimator::Impl::LearnWheelNoise(const Pose2& by_wheels, const Pose2& corrected) {
  wheel_noise_.Observe(by_wheels, corrected, scan_odometry_.heading_sigma_rad());
  const WheelScales scales = wheel_noise_.scales();
  DeadReckoningOptions noise = options_.odometry;
  noise.sigma_heading_deg_per_sqrt_m *= scales.travel;
  noise.sigma_heading_deg_per_sqrt_rad *= scales.turn;
  wheels_.SetOptions(noise);
}

// Wheels tell of a step when they were heard at both ends of it. Where they come back, the way
// meanwhile is not theirs to tell.
bool MotionEstimator::Impl::HearsWheels(const LaserScan& scan) {
  if (scan.T_odom_robot) Observe(OdometryReading{scan.stamp, *scan.T_odom_robot});
  const bool hears = is_heard_ && (was_heard_ || !last_scan_stamp_);
  was_heard_ = is_heard_;
  is_heard_ = false;
  return hears && options_.source != MotionSource::kScans;
}

void MotionEstimator::Impl::Observe(const LaserScan& scan, bool must_match,
                                    const FacedPoints* points) {
  if (scan.beam_time != 0.0) {
    // Of the motion during the sweep the step before is the nearest that is known.
    Observe(StraightenedBySteps(scan, last_step_.mean, last_step_s_), must_match);
    return;
  }
  const bool has_wheels = HearsWheels(scan);
  const bool has_turns = has_wheels && options_.wheels_tell_turns;
  UncertainPose2 step = has_turns    ? wheels_.T_node_robot()
                        : has_wheels ? StepWithoutTurns(scan.stamp)
                                     : StepWithoutWheels(scan.stamp);
  const double wheel_travel_m = wheels_.T_node_robot().mean.x;
  wheels_.StartNode();
  const double elapsed = last_scan_stamp_ ? scan.stamp - *last_scan_stamp_ : 0.0;
  if (options_.source != MotionSource::kOdometry) {
    if (has_turns && last_scan_stamp_) {
      step.mean.theta = WrapAngle(step.mean.theta - gyro_bias_.rate() * elapsed);
    }
    const Pose2 by_wheels = step.mean;
    const Eigen::Matrix3d guess_covariance = step.covariance;
    // Scans stopped and the robot went on: what it sees now has little to do with the local map,
    // and a match would only seem to be one. Without a gap it is the wheels that leapt. A robot
    // that rides goes on without a step.
    constexpr double kGap = 5.0;  // s
    const bool went_on =
        in_transit_ ||
        (has_wheels && (std::hypot(by_wheels.x, by_wheels.y) > options_.longest_step_m ||
                        std::abs(by_wheels.theta) > DegToRad(options_.longest_turn_deg)));
    if (elapsed > kGap && went_on) RestartScans();
    step = scan_odometry_.Observe(scan, step, must_match, points, !has_wheels);
    if (has_turns) LearnWheelNoise(by_wheels, step.mean);
    NoteAdvance(wheel_travel_m, step.mean.x);
    if (has_wheels) {
      unheard_speed_.Hear(step, elapsed);
    } else if (elapsed > 0.0) {
      const UnheardSpeed::Guess guess{guess_covariance(0, 0),
                                      options_.wheelless.sigma_speed_m_per_s * elapsed};
      step.covariance = unheard_speed_.Observe(step, guess, scan_odometry_.seen_of_step(), elapsed);
    }
  }
  last_step_s_ = elapsed;
  last_scan_stamp_ = scan.stamp;
  last_step_ = step;
  T_odom_robot_ = T_odom_robot_ * step.mean;
  T_node_robot_ = T_node_robot_ * step;
}

// Ours: the speed of the step before goes on, and may change by what a robot of a person's pace
// does.
UncertainPose2 MotionEstimator::Impl::StepWithoutWheels(double stamp) const {
  UncertainPose2 step;
  if (!last_scan_stamp_) return step;
  const double elapsed = std::max(0.0, stamp - *last_scan_stamp_);
  if (last_step_s_ > 0.0) {
    const double ratio = std::min(2.0, elapsed / last_step_s_);
    step.mean = {ratio * last_step_.mean.x, ratio * last_step_.mean.y,
                 ratio * last_step_.mean.theta};
  }
  const double sigma_m = std::min(options_.wheelless.sigma_speed_m_per_s,
                                  options_.wheelless.sigma_acceleration_m_per_s2 * elapsed) *
                         elapsed;
  const double sigma_rad = DegToRad(options_.wheelless.sigma_turn_deg_per_s) * elapsed;
  step.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  return step;
}

// Ours: a robot drives forward unless scans have seen it back; it rests before it changes that.
void MotionEstimator::Impl::NoteAdvance(double wheel_travel_m, double advance_m) {
  constexpr double kAtRest = 0.001;    // m from scan to scan
  constexpr double kRemembered = 0.1;  // m
  if (wheel_travel_m < kAtRest) advance_m = -advance_m_;
  advance_m_ = std::clamp(advance_m_ + advance_m, -kRemembered, kRemembered);
}

// The way is an arc through the turn of the step before. Wheels at rest say nothing of a turn on
// the place.
UncertainPose2 MotionEstimator::Impl::StepWithoutTurns(double stamp) const {
  UncertainPose2 step = StepWithoutWheels(stamp);
  const double travel_m =
      (advance_m_ < -kSurelyBacking ? -1.0 : 1.0) * wheels_.T_node_robot().mean.x;
  step.mean.x = travel_m * std::cos(0.5 * step.mean.theta);
  step.mean.y = travel_m * std::sin(0.5 * step.mean.theta);
  const double aside = 0.5 * travel_m;
  const Eigen::Matrix3d by_wheels = wheels_.T_node_robot().covariance;
  step.covariance(0, 0) = by_wheels(0, 0);
  step.covariance(1, 1) = by_wheels(1, 1) + aside * aside * step.covariance(2, 2);
  return step;
}

MotionEstimator::MotionEstimator(const MotionOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
MotionEstimator::~MotionEstimator() = default;
MotionEstimator::MotionEstimator(MotionEstimator&&) noexcept = default;
MotionEstimator& MotionEstimator::operator=(MotionEstimator&&) noexcept = default;

void MotionEstimator::Observe(const OdometryReading& reading) { impl_->Observe(reading); }
void MotionEstimator::Observe(const LaserScan& scan, bool must_match, const FacedPoints* points) {
  impl_->Observe(scan, must_match, points);
}
void MotionEstimator::StartNode() { impl_->StartNode(); }
void MotionEstimator::EnterTransit() { impl_->EnterTransit(); }
void MotionEstimator::LeaveTransit() { impl_->LeaveTransit(); }

const Pose2& MotionEstimator::T_odom_robot() const { return impl_->T_odom_robot(); }
const UncertainPose2& MotionEstimator::last_step() const { return impl_->last_step(); }
const UncertainPose2& MotionEstimator::T_node_robot() const { return impl_->T_node_robot(); }

void MotionEstimator::Serialize(StateWriter& archive) { impl_->Serialize(archive); }
void MotionEstimator::Serialize(StateReader& archive) { impl_->Serialize(archive); }

}  // namespace masked_mapper
