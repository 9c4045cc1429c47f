// SPDX-License-Identifier: BSD-3-Clause
// Angles of beams as the scanner's maker set them.
#pragma once

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

/// Scanners are built in degrees, and logs hold a few digits of radians: bags single precision,
/// text a dozen decimals. Where a short number of degrees is the same in single precision, it was
/// meant: a bag and a text log then give the same beams. Radians.
inline double AngleAsMeant(double angle) {
  constexpr double kStepsPerDegree = 1e4;
  const double meant = DegToRad(std::round(RadToDeg(angle) * kStepsPerDegree) / kStepsPerDegree);
  return static_cast<float>(meant) == static_cast<float>(angle) ? meant : angle;
}

}  // namespace masked_mapper
