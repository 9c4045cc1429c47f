// SPDX-License-Identifier: BSD-3-Clause
// By which factor turns by wheels are those by scans, whatever single stretches say.
#pragma once

#include <vector>

#include "masked_mapper/motion/wheel_check.hpp"

namespace masked_mapper {

/// By which honest wheels and scans differ in a stretch, sigma.
inline constexpr double kTurnSigmaDeg = 2.0;

/// The turn of a stretch, rad.
struct TurnPair {
  double by_wheels = 0.0;
  double by_scans = 0.0;
};

/// Turns by scans as a factor times those by wheels.
struct TurnFit {
  double factor = 1.0;
  double left = 0.0;     // rad^2, mean bounded square of what the fit leaves
  double without = 0.0;  // rad^2, the same if wheels told of no turn at all
  double as_told = 0.0;  // rad^2, the same with a factor of 1
};

TurnFit FitTurns(const std::vector<TurnPair>& pairs);

/// Of what makes turns, by scans, in all, rad.
double Turning(const std::vector<TurnPair>& pairs);

/// Of turns, beginning with what is nearly right. All stretches have a say: wheels lag behind
/// scans, and those in which scans turn most are those in which wheels have not yet.
Estimated FineFactor(const std::vector<TurnPair>& pairs, double factor);

}  // namespace masked_mapper
