// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/scan_odometry.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// Information of (x, y, theta). A floor keeps motions that the wheels call perfect from outvoting
/// every scan.
Eigen::Matrix3d FlooredInverse(Eigen::Matrix3d covariance) {
  covariance.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-7);
  return covariance.inverse();
}

ScanPoints::ConstPtr PointsWithin(const ScanPoints::ConstPtr& points_in_robot, double reach_m) {
  if (std::isinf(reach_m)) return points_in_robot;
  ScanPoints::Ptr near(new ScanPoints);
  for (const pcl::PointXY& point : *points_in_robot) {
    if (std::hypot(point.x, point.y) <= reach_m) near->push_back(point);
  }
  return near;
}

constexpr double kMapMargin = 1.0;  // m; more than a robot moves from one keyframe to the next

constexpr double kMostChi2 = 16.0;  // of three degrees of freedom: one in a thousand

double Chi2(const Pose2& expected, const Pose2& found, const Eigen::Matrix3d& information) {
  const Eigen::Vector3d error(found.x - expected.x, found.y - expected.y,
                              WrapAngle(found.theta - expected.theta));
  return error.dot(information * error);
}

double Turn(const Pose2& a, const Pose2& b) { return std::abs(WrapAngle(b.theta - a.theta)); }

}  // namespace

void ScanOdometry::Restart() {
  reach_m_ = std::numeric_limits<double>::infinity();
  map_.reset();
  next_map_.reset();
  T_map_keyframe_.reset();
  T_matched_robot_ = UncertainPose2{};
  T_map_matched_ = T_map_robot_;
  matched_heading_variance_ = 0.0;
  rest_scans_ = 0;
  lost_ = 0;
}

Alignment ScanOdometry::AlignFromSeveralGuesses(const ScanPoints& points, const Pose2& T_map_guess,
                                                const Eigen::Matrix3d& prior_information) const {
  Alignment best = map_->Align(points, T_map_guess, prior_information);
  // The last corrected step done once more, where the wheels say something else.
  const Pose2 T_map_repeated = T_map_matched_ * last_step_;
  if (Distance(T_map_repeated, T_map_guess) > options_.repeat_difference_m) {
    const Alignment other = map_->Align(points, T_map_repeated, prior_information);
    if (other.inlier_share > best.inlier_share + 0.02) best = other;
  }
  if (best.inlier_share >= options_.min_inlier_share) return best;
  // Wheels slip most in turns: guesses around the predicted heading, the best refined.
  for (const double turn_deg : {-4.0, 4.0, -8.0, 8.0, -12.0, 12.0}) {
    Pose2 guess = T_map_guess;
    guess.theta = WrapAngle(guess.theta + DegToRad(turn_deg));
    const Alignment other =
        map_->Align(points, guess, Eigen::Matrix3d::Identity() * 1e-3 + 0.05 * prior_information);
    if (other.inlier_share > best.inlier_share + 0.05) best = other;
  }
  return best;
}

// In a blank corridor the one thing that tells of the way along it may be a person who walks ahead
// at the robot's pace. Wheels are overruled by a scan as a whole, not by a few points of it.
Alignment ScanOdometry::AlignUnlessOverruled(const ScanPoints& points, const Pose2& T_map_guess,
                                             const Eigen::Matrix3d& prior_information) const {
  Alignment aligned = AlignFromSeveralGuesses(points, T_map_guess, prior_information);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> known(
      aligned.information.topLeftCorner<2, 2>());
  if (known.eigenvalues()(0) * options_.blank_ratio > known.eigenvalues()(1)) return aligned;
  const Eigen::Vector2d along = known.eigenvectors().col(0);
  const Eigen::Vector2d moved = aligned.T_map_robot.Translation() - T_map_guess.Translation();
  const Eigen::Matrix2d position_covariance =
      Eigen::Matrix3d(prior_information.inverse()).topLeftCorner<2, 2>();
  const double variance = along.dot(position_covariance * along);
  const double sigmas = along.dot(moved) / std::sqrt(variance);
  if (std::abs(sigmas) < options_.overruling_sigmas) return aligned;
  constexpr double kFirmly = 25.0;  // a fifth of its sigma
  Eigen::Matrix3d firm = Eigen::Matrix3d::Zero();
  firm.topLeftCorner<2, 2>() = kFirmly / variance * along * along.transpose();
  const Alignment held =
      map_->AlignHeld(points, {T_map_guess.x, T_map_guess.y, aligned.T_map_robot.theta}, firm);
  return aligned.inlier_share < held.inlier_share + options_.overruling_share ? held : aligned;
}

void ScanOdometry::AddKeyframe(const ScanPoints& points) {
  if (!map_) map_.emplace(options_.map, T_map_robot_.Translation());
  map_->Add(points, T_map_robot_);
  if (next_map_) next_map_->Add(points, T_map_robot_);
  const auto full = static_cast<std::size_t>(options_.keyframes_per_map);
  if (!next_map_ && map_->scans() >= full) {
    next_map_.emplace(options_.map, T_map_robot_.Translation());
    next_map_->Add(points, T_map_robot_);
  } else if (next_map_ && next_map_->scans() >= full) {
    map_ = std::move(next_map_);
    next_map_.emplace(options_.map, T_map_robot_.Translation());
    next_map_->Add(points, T_map_robot_);
  }
  T_map_keyframe_ = T_map_robot_;
}

UncertainPose2 ScanOdometry::Observe(const LaserScan& scan, const UncertainPose2& T_last_now,
                                     bool must_match) {
  const ScanPoints::ConstPtr all_points = PointsInRobot(scan);
  const ScanPoints::ConstPtr points = PointsWithin(all_points, reach_m_);
  // Where the points of a map end, they would hold back a robot that moves on.
  const ScanPoints::ConstPtr map_points = PointsWithin(all_points, reach_m_ + kMapMargin);
  const Pose2 T_map_last = T_map_robot_;
  UncertainPose2 step = T_last_now;
  if (!map_) {
    T_map_robot_ = T_map_robot_ * T_last_now.mean;
    T_map_matched_ = T_map_robot_;
    if (!map_points->empty()) AddKeyframe(*map_points);
    return step;
  }
  T_matched_robot_ = T_matched_robot_ * T_last_now;
  T_map_robot_ = T_map_matched_ * T_matched_robot_.mean;
  heading_sigma_rad_ = std::numeric_limits<double>::infinity();
  const double travelled = Distance(T_map_matched_, T_map_robot_);
  const double turned = Turn(T_map_matched_, T_map_robot_);
  // A wheel that says "at rest" is believed; a guess without wheels is not.
  const bool is_sure = T_matched_robot_.covariance.topLeftCorner<2, 2>().trace() <
                       options_.match_distance_m * options_.match_distance_m;
  const bool is_at_rest = is_sure && travelled < options_.match_distance_m &&
                          turned < DegToRad(options_.match_angle_deg);
  if (!is_at_rest) rest_scans_ = 0;
  if (is_at_rest && !must_match) {
    // Scans of a robot at rest err each on its own: a few more settle what a poor view left open.
    const bool is_settled = std::sqrt(matched_heading_variance_) < DegToRad(options_.settled_deg);
    if (is_settled || rest_scans_ >= options_.rest_scans) {
      // A young map is as noisy as its few scans, and all that follows is held against it.
      if (map_->scans() < static_cast<std::size_t>(options_.rest_scans)) {
        map_->Add(*map_points, T_map_robot_);
      }
      // The next match answers for this step too: its uncertainty is not counted twice.
      step.covariance.setZero();
      return step;
    }
    ++rest_scans_;
  }
  const Eigen::Matrix3d motion_in_map =
      (UncertainPose2{T_map_matched_, Eigen::Matrix3d::Zero()} * T_matched_robot_).covariance;
  // The heading is filtered over scans. The position is not: along a blank corridor its uncertainty
  // would grow until the little that walls seem to tell of the way overrules the wheels.
  Eigen::Matrix3d predicted_in_map = motion_in_map;
  predicted_in_map(2, 2) += matched_heading_variance_;
  const Eigen::Matrix3d prior = FlooredInverse(predicted_in_map);
  const Alignment aligned = AlignUnlessOverruled(*points, T_map_robot_, prior);
  inlier_share_ = aligned.inlier_share;
  // Where the scene may have become another one a match has to be good, and for a robot at rest no
  // news.
  const bool is_doubtful = must_match || std::isfinite(reach_m_);
  const bool is_believed =
      aligned.inlier_share >=
          (is_doubtful ? options_.min_inlier_share : options_.lost_inlier_share) &&
      !(is_doubtful && is_at_rest && Chi2(T_map_robot_, aligned.T_map_robot, prior) > kMostChi2);
  if (is_believed) {
    heading_sigma_rad_ = 1.0 / std::sqrt(std::max(aligned.information(2, 2), 1e-12));
    matched_heading_variance_ = (aligned.information + prior).inverse()(2, 2);
    // Scans against one map err alike: a short step is worth its share of an alignment's
    // covariance, and all of it only over the way on which the map itself has become another.
    const double share = std::min(1.0, travelled / options_.decorrelation_distance_m +
                                           turned / DegToRad(options_.decorrelation_angle_deg));
    const Eigen::Matrix3d covariance_in_map =
        (aligned.information / std::max(share, 1e-3) + FlooredInverse(motion_in_map)).inverse();
    T_map_robot_ = aligned.T_map_robot;
    last_step_ = Between(T_map_matched_, T_map_robot_);
    const double c = std::cos(T_map_last.theta);
    const double s = std::sin(T_map_last.theta);
    Eigen::Matrix3d rotation;
    rotation << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
    step.mean = Between(T_map_last, T_map_robot_);
    step.covariance = rotation * covariance_in_map * rotation.transpose();
    lost_ = 0;
  } else {
    step.covariance = T_matched_robot_.covariance;
    matched_heading_variance_ = predicted_in_map(2, 2);
  }
  if (!is_believed && ++lost_ >= 5) {
    // Nothing agrees any more (a door opened on another place, the log jumped): begin again here.
    map_.reset();
    next_map_.reset();
    matched_heading_variance_ = 0.0;
    lost_ = 0;
    if (!map_points->empty()) AddKeyframe(*map_points);
  }
  T_map_matched_ = T_map_robot_;
  T_matched_robot_ = UncertainPose2{};
  if (lost_ != 0) return step;
  if (!T_map_keyframe_ ||
      Distance(*T_map_keyframe_, T_map_robot_) >= options_.keyframe_distance_m ||
      Turn(*T_map_keyframe_, T_map_robot_) >= DegToRad(options_.keyframe_angle_deg)) {
    AddKeyframe(*map_points);
  } else if (rest_scans_ > 0 && map_->scans() < static_cast<std::size_t>(options_.rest_scans)) {
    // A young map is as noisy as its few scans, and all that follows is held against it.
    map_->Add(*map_points, T_map_robot_);
  }
  return step;
}

}  // namespace masked_mapper
