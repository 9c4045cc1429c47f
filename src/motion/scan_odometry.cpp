// SPDX-License-Identifier: BSD-3-Clause
#include "scan_odometry.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
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

constexpr double kMapMargin = 1.0;  // m; more than a robot moves from one keyframe to the next

/// Travel after a transit through which a door may still open.
constexpr double kSuspected = 3.0;  // m

/// How far off a match at one pose may be where the scene supports it, beside what wheels and walls
/// leave open: cells, people, a door on its way.
constexpr double kMatchSigma = 0.02;    // m
constexpr double kMatchSigmaDeg = 0.3;  // deg

constexpr double kSceneSigma = 0.05;  // m, to tell the same scene from another one

constexpr double kSameScene = 0.7;  // of the points near the robot agree: surely the same scene

/// Sigma of the turn since the last match up to which wheels know that there was none.
constexpr double kSureOfRestDeg = 1.0;  // deg

constexpr double kMostChi2 = 16.0;  // of three degrees of freedom: one in a thousand

constexpr int kMostLost = 5;  // scans in a row that agree with nothing: this is another place

/// Of a match against where the wheels put the robot.
double Chi2(const Pose2& expected, const Pose2& found, const Eigen::Matrix3d& expected_covariance) {
  Eigen::Matrix3d covariance = expected_covariance;
  covariance.diagonal() += Eigen::Vector3d(kMatchSigma * kMatchSigma, kMatchSigma * kMatchSigma,
                                           DegToRad(kMatchSigmaDeg) * DegToRad(kMatchSigmaDeg));
  const Eigen::Vector3d error(found.x - expected.x, found.y - expected.y,
                              WrapAngle(found.theta - expected.theta));
  return error.dot(covariance.inverse() * error);
}

/// Turns what is told in map into the robot's frame.
Eigen::Matrix2d RotationTo(const Pose2& T_map_robot) {
  return Eigen::Rotation2Dd(-T_map_robot.theta).toRotationMatrix();
}

double Turn(const Pose2& a, const Pose2& b) { return std::abs(WrapAngle(b.theta - a.theta)); }

}  // namespace

void ScanOdometry::Restart() {
  reach_m_ = std::numeric_limits<double>::infinity();
  suspected_m_ = 0.0;
  maps_ = Maps{};
  path_.T_matched_robot = UncertainPose2{};
  path_.T_map_matched = path_.T_map_robot;
  path_.heading_variance = 0.0;
  rest_scans_ = 0;
  lost_ = 0;
}

void ScanOdometry::EnterTransit() {
  reach_m_ = options_.transit_reach_m;
  suspected_m_ = std::numeric_limits<double>::infinity();
}

void ScanOdometry::LeaveTransit() {
  if (std::isfinite(reach_m_)) Restart();
  suspected_m_ = kSuspected;
}

Alignment ScanOdometry::AlignFromSeveralGuesses(const FacedPoints& points, const Pose2& T_map_guess,
                                                const Eigen::Matrix3d& prior_information) const {
  Alignment best = maps_.current->Align(points, T_map_guess, prior_information);
  // The last corrected step done once more, where the wheels say something else.
  const Pose2 T_map_repeated = path_.T_map_matched * path_.last_step;
  if (Distance(T_map_repeated, T_map_guess) > options_.repeat_difference_m) {
    const Alignment other = maps_.current->Align(points, T_map_repeated, prior_information);
    if (other.inlier_share > best.inlier_share + 0.02) best = other;
  }
  if (best.inlier_share >= options_.min_inlier_share) return best;
  // Wheels slip most in turns: guesses around the predicted heading, the best refined.
  for (const double turn_deg : {-4.0, 4.0, -8.0, 8.0, -12.0, 12.0}) {
    Pose2 guess = T_map_guess;
    guess.theta = WrapAngle(guess.theta + DegToRad(turn_deg));
    const Alignment other = maps_.current->Align(
        points, guess, Eigen::Matrix3d::Identity() * 1e-3 + 0.05 * prior_information);
    if (other.inlier_share > best.inlier_share + 0.05) best = other;
  }
  return best;
}

// In a blank corridor the one thing that tells of the way along it may be a person who walks ahead
// at the robot's pace. Wheels are overruled by a scan as a whole, not by a few points of it.
Alignment ScanOdometry::AlignUnlessOverruled(const FacedPoints& points, const Pose2& T_map_guess,
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
  const Alignment held = maps_.current->AlignHeld(
      points, {T_map_guess.x, T_map_guess.y, aligned.T_map_robot.theta}, firm);
  return aligned.inlier_share < held.inlier_share + options_.overruling_share ? held : aligned;
}

// The stages of a scan: Predict by the wheels, Match against the local map, Believe the match or
// not, Fuse it with the wheels, and KeepMap.
UncertainPose2 ScanOdometry::Observe(const LaserScan& scan, const UncertainPose2& T_last_now,
                                     bool must_match, const FacedPoints* points, bool tells_alone) {
  View view(scan, reach_m_, points);
  seen_of_step_.setZero();
  if (!maps_.current) {
    Begin(view, T_last_now.mean);
    return T_last_now;
  }
  const Pose2 T_map_last = path_.T_map_robot;
  const bool is_at_rest = Predict(T_last_now);
  if (tells_alone && !view.SeesAll() && IsSameSceneAsAWhole(view)) view.SeeAll();
  if (is_at_rest && !must_match) {
    if (NeedsNoMatch()) {
      if (IsAnotherScene(view)) {
        BeginAnew(view);
      } else {
        AddToYoungMap(view);
      }
      // The next match answers for this step too: its uncertainty is not counted twice.
      return {T_last_now.mean, Eigen::Matrix3d::Zero()};
    }
    ++rest_scans_;
  }
  const Prediction predicted = PriorOf(is_at_rest);
  const Alignment aligned = AlignUnlessOverruled(view.Points(), path_.T_map_robot, predicted.prior);
  inlier_share_ = aligned.inlier_share;
  const bool is_believed = Believe(view, aligned, predicted, must_match);
  UncertainPose2 step =
      is_believed ? Fuse(aligned, predicted, T_map_last) : GoOnByWheels(T_last_now.mean, predicted);
  if (is_believed && tells_alone) {
    seen_of_step_ = SeenOfStep(aligned, predicted, T_map_last);
  }
  lost_ = is_believed ? 0 : lost_ + 1;
  path_.T_map_matched = path_.T_map_robot;
  path_.T_matched_robot = UncertainPose2{};
  suspected_m_ = std::max(0.0, suspected_m_ - predicted.travelled_m);
  if (is_believed) {
    KeepMap(view);
  } else if (lost_ >= kMostLost || IsAnotherScene(view)) {
    BeginAnew(view);
  }
  return step;
}

const FacedPoints& ScanOdometry::View::MapPoints() {
  return Within(reach_m_ + kMapMargin, &map_points_);
}

const FacedPoints& ScanOdometry::View::AllPoints() {
  if (given_ != nullptr) return *given_;
  if (!all_points_) all_points_.emplace(*PointsInRobot(scan_));
  return *all_points_;
}

const FacedPoints& ScanOdometry::View::Within(double reach_m, std::optional<FacedPoints>* points) {
  if (std::isinf(reach_m)) return AllPoints();
  if (!*points) {
    const ScanPoints::ConstPtr all = PointsInRobot(scan_);
    ScanPoints near;
    for (const pcl::PointXY& point : *all) {
      if (std::hypot(point.x, point.y) <= reach_m) near.push_back(point);
    }
    points->emplace(near);
  }
  return **points;
}

void ScanOdometry::Begin(View& view, const Pose2& T_last_now) {
  path_.T_map_robot = path_.T_map_robot * T_last_now;
  path_.T_map_matched = path_.T_map_robot;
  if (!view.MapPoints().empty()) AddKeyframe(view.MapPoints());
}

/// Whether the robot is where it was matched last. A wheel that says so is believed; a guess
/// without wheels is not.
bool ScanOdometry::Predict(const UncertainPose2& T_last_now) {
  path_.T_matched_robot = path_.T_matched_robot * T_last_now;
  path_.T_map_robot = path_.T_map_matched * path_.T_matched_robot.mean;
  heading_sigma_rad_ = std::numeric_limits<double>::infinity();
  const Eigen::Matrix3d& covariance = path_.T_matched_robot.covariance;
  const bool is_sure = covariance.topLeftCorner<2, 2>().trace() <
                           options_.match_distance_m * options_.match_distance_m &&
                       covariance(2, 2) < DegToRad(kSureOfRestDeg) * DegToRad(kSureOfRestDeg);
  const bool is_at_rest =
      is_sure && Distance(path_.T_map_matched, path_.T_map_robot) < options_.match_distance_m &&
      Turn(path_.T_map_matched, path_.T_map_robot) < DegToRad(options_.match_angle_deg);
  if (!is_at_rest) rest_scans_ = 0;
  return is_at_rest;
}

// In a cab that is also what is near. On stairs, whose walls are blank, what is farther off tells
// of the way where no wheels do.
bool ScanOdometry::IsSameSceneAsAWhole(View& view) const {
  return maps_.current->Agreement(view.AllPoints(), path_.T_map_robot, kSceneSigma) >= kSameScene;
}

// Scans of a robot at rest err each on its own: a few more settle what a poor view left open.
bool ScanOdometry::NeedsNoMatch() const {
  return std::sqrt(path_.heading_variance) < DegToRad(options_.settled_deg) ||
         rest_scans_ >= options_.rest_scans;
}

// The heading is filtered over scans. The position is not: along a blank corridor its uncertainty
// would grow until the little that walls seem to tell of the way overrules the wheels.
ScanOdometry::Prediction ScanOdometry::PriorOf(bool is_at_rest) const {
  Prediction predicted;
  predicted.travelled_m = Distance(path_.T_map_matched, path_.T_map_robot);
  predicted.turned_rad = Turn(path_.T_map_matched, path_.T_map_robot);
  predicted.is_at_rest = is_at_rest;
  predicted.motion_in_map =
      (UncertainPose2{path_.T_map_matched, Eigen::Matrix3d::Zero()} * path_.T_matched_robot)
          .covariance;
  Eigen::Matrix3d predicted_in_map = predicted.motion_in_map;
  predicted_in_map(2, 2) += path_.heading_variance;
  predicted.covariance = predicted_in_map;
  predicted.prior = FlooredInverse(predicted_in_map);
  return predicted;
}

// Where the scene may have become another one, a match has to be good: of another scene a match
// has some points that agree, but seldom half of them. Near walls alone come closer to it, so they
// also have to lie where the wheels put the robot. Wheels are no better judge than that: they slip,
// and lag behind the scans of a robot that turns.
bool ScanOdometry::Believe(const View& view, const Alignment& aligned, const Prediction& predicted,
                           bool must_match) const {
  if (suspected_m_ == 0.0 && !must_match) {
    return aligned.inlier_share >= options_.lost_inlier_share;
  }
  const bool sees_all = view.SeesAll() && !predicted.is_at_rest;
  if (sees_all || aligned.inlier_share >= kSameScene) {
    return aligned.inlier_share >= options_.min_inlier_share;
  }
  return aligned.inlier_share >= options_.min_inlier_share &&
         Chi2(path_.T_map_robot, aligned.T_map_robot, predicted.covariance) <= kMostChi2;
}

// The scan does not even fit where the wheels put it.
bool ScanOdometry::IsAnotherScene(View& view) const {
  return suspected_m_ > 0.0 && maps_.current->Agreement(view.Points(), path_.T_map_robot,
                                                        kSceneSigma) < options_.min_inlier_share;
}

// Scans against one map err alike: a short step is worth its share of an alignment's covariance,
// and all of it only over the way on which the map itself has become another.
UncertainPose2 ScanOdometry::Fuse(const Alignment& aligned, const Prediction& predicted,
                                  const Pose2& T_map_last) {
  heading_sigma_rad_ = 1.0 / std::sqrt(std::max(aligned.information(2, 2), 1e-12));
  path_.heading_variance = (aligned.information + predicted.prior).inverse()(2, 2);
  const Eigen::Matrix3d covariance_in_map =
      (aligned.information / ShareOf(predicted) + FlooredInverse(predicted.motion_in_map))
          .inverse();
  path_.T_map_robot = aligned.T_map_robot;
  path_.last_step = Between(path_.T_map_matched, path_.T_map_robot);
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = RotationTo(T_map_last);
  return {Between(T_map_last, path_.T_map_robot),
          rotation * covariance_in_map * rotation.transpose()};
}

double ScanOdometry::ShareOf(const Prediction& predicted) const {
  const double share = predicted.travelled_m / options_.decorrelation_distance_m +
                       predicted.turned_rad / DegToRad(options_.decorrelation_angle_deg);
  return std::clamp(share, 1e-3, 1.0);
}

Eigen::Matrix2d ScanOdometry::SeenOfStep(const Alignment& aligned, const Prediction& predicted,
                                         const Pose2& T_map_last) const {
  const Eigen::Matrix3d& all = aligned.information;
  Eigen::Matrix2d seen = all.topLeftCorner<2, 2>() - aligned.information_of_noise;
  if (all(2, 2) > 0.0) {
    seen -= all.topRightCorner<2, 1>() * all.bottomLeftCorner<1, 2>() / all(2, 2);
  }
  const Eigen::Matrix2d rotation = RotationTo(T_map_last);
  return rotation * seen * rotation.transpose() / ShareOf(predicted);
}

UncertainPose2 ScanOdometry::GoOnByWheels(const Pose2& by_wheels, const Prediction& predicted) {
  path_.heading_variance = predicted.covariance(2, 2);
  return {by_wheels, path_.T_matched_robot.covariance};
}

// Nothing agrees any more (a door opened on another place, the log jumped): begin again here, and
// of what is seen now all is one scene.
void ScanOdometry::BeginAnew(View& view) {
  reach_m_ = std::numeric_limits<double>::infinity();
  maps_.current.reset();
  maps_.next.reset();
  path_.heading_variance = 0.0;
  lost_ = 0;
  if (!view.AllPoints().empty()) AddKeyframe(view.AllPoints());
}

void ScanOdometry::KeepMap(View& view) {
  const std::optional<Pose2>& T_map_keyframe = maps_.T_map_keyframe;
  if (!T_map_keyframe ||
      Distance(*T_map_keyframe, path_.T_map_robot) >= options_.keyframe_distance_m ||
      Turn(*T_map_keyframe, path_.T_map_robot) >= DegToRad(options_.keyframe_angle_deg)) {
    AddKeyframe(view.MapPoints());
  } else if (rest_scans_ > 0) {
    AddToYoungMap(view);
  }
}

// A young map is as noisy as its few scans, and all that follows is held against it.
void ScanOdometry::AddToYoungMap(View& view) {
  if (maps_.current->scans() < static_cast<std::size_t>(options_.rest_scans)) {
    maps_.current->Add(view.MapPoints(), path_.T_map_robot);
  }
}

void ScanOdometry::AddKeyframe(const FacedPoints& points) {
  const auto begin_next = [&] {
    maps_.next.emplace(options_.map, path_.T_map_robot.Translation());
    maps_.next->Add(points, path_.T_map_robot);
  };
  if (!maps_.current) maps_.current.emplace(options_.map, path_.T_map_robot.Translation());
  maps_.current->Add(points, path_.T_map_robot);
  if (maps_.next) maps_.next->Add(points, path_.T_map_robot);
  const auto full = static_cast<std::size_t>(options_.keyframes_per_map);
  if (!maps_.next && maps_.current->scans() >= full) {
    begin_next();
  } else if (maps_.next && maps_.next->scans() >= full) {
    maps_.current = std::move(maps_.next);
    begin_next();
  }
  maps_.T_map_keyframe = path_.T_map_robot;
}

}  // namespace masked_mapper
