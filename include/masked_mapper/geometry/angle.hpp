// SPDX-License-Identifier: BSD-3-Clause
// Angles are radians everywhere inside; degrees appear only in names ending in `_deg`.
#pragma once

#include <cmath>

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

}  // namespace masked_mapper
