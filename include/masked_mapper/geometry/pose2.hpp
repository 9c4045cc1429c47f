// SPDX-License-Identifier: BSD-3-Clause
// Rigid transforms of the plane, and the one convention for frames:
//
//   `T_a_b` maps coordinates in frame b to coordinates in frame a; it is also the pose of b in a.
//   Adjacent letters cancel: T_a_c = T_a_b * T_b_c, points_in_a = T_a_b * points_in_b.
//
// Metres and radians everywhere inside; degrees appear only in names ending in `_deg`.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

namespace masked_mapper {

constexpr double kPi = 3.14159265358979323846;

constexpr double DegToRad(double angle_deg) { return angle_deg * (kPi / 180.0); }
constexpr double RadToDeg(double angle_rad) { return angle_rad * (180.0 / kPi); }

/// The same direction in (-pi, pi]. Exact for angles already there; NaN stays NaN.
inline double WrapAngle(double angle_rad) {
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;

  Eigen::Vector2d Translation() const { return {x, y}; }
  Eigen::Vector3d AsVector() const { return {x, y, theta}; }
};

/// T_a_c = T_a_b * T_b_c (Eq. 3-4); the angle of the result is wrapped.
inline Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          WrapAngle(T_a_b.theta + T_b_c.theta)};
}

/// A pose with its sine and cosine at hand, which cost most of what it takes to move a point: for
/// many of them.
class PointTransform {
 public:
  explicit PointTransform(const Pose2& T_a_b)
      : x_(T_a_b.x), y_(T_a_b.y), cosine_(std::cos(T_a_b.theta)), sine_(std::sin(T_a_b.theta)) {}

  /// point_in_a.
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_in_b) const {
    return {x_ + cosine_ * point_in_b.x() - sine_ * point_in_b.y(),
            y_ + sine_ * point_in_b.x() + cosine_ * point_in_b.y()};
  }

 private:
  double x_;
  double y_;
  double cosine_;
  double sine_;
};

/// point_in_a = T_a_b * point_in_b.
inline Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& point_in_b) {
  return PointTransform(T_a_b) * point_in_b;
}

/// T_b_a of T_a_b.
inline Pose2 Inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, WrapAngle(-T_a_b.theta)};
}

/// T_a_b of two poses in a common frame: what b looks like from a.
inline Pose2 Between(const Pose2& T_w_a, const Pose2& T_w_b) { return Inverse(T_w_a) * T_w_b; }

/// The fraction of the way from T_w_a (0) to T_w_b (1): translation along the straight line,
/// rotation along the shorter arc. This is how a pose between two stamps is read everywhere.
inline Pose2 Interpolate(const Pose2& T_w_a, const Pose2& T_w_b, double fraction) {
  return {T_w_a.x + fraction * (T_w_b.x - T_w_a.x), T_w_a.y + fraction * (T_w_b.y - T_w_a.y),
          WrapAngle(T_w_a.theta + fraction * WrapAngle(T_w_b.theta - T_w_a.theta))};
}

/// Straight-line distance between the origins of two poses, metres.
inline double Distance(const Pose2& T_w_a, const Pose2& T_w_b) {
  return std::hypot(T_w_b.x - T_w_a.x, T_w_b.y - T_w_a.y);
}

/// T_a_b of least squared distances between pairs of points in a and in b; the identity for none,
/// and a shift alone where they do not spread.
Pose2 AlignRigidly(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& a_and_b);

}  // namespace masked_mapper
