// SPDX-License-Identifier: BSD-3-Clause
#include "turn_fit.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr double kMostResidual = 15.0;  // deg; a greater one says no more than this
constexpr double kTurns = 4.0;          // deg of a stretch by scans that make it a turn

double Bounded(double residual) {
  const double most = DegToRad(kMostResidual);
  return std::min(residual * residual, most * most);
}

/// Sums over all stretches for the next factor. A residual of `scale_rad` halves a stretch's say.
struct WeightedSums {
  double products = 0.0;
  double squares = 0.0;
  double residuals = 0.0;  ///< of the factor's variance
};

WeightedSums SumsAt(const std::vector<TurnPair>& pairs, double factor, double scale_rad) {
  WeightedSums sums;
  for (const TurnPair& pair : pairs) {
    const double residual = pair.by_scans - factor * pair.by_wheels;
    const double ratio = residual / scale_rad;
    const double weight = 1.0 / (1.0 + ratio * ratio);
    sums.products += weight * pair.by_scans * pair.by_wheels;
    sums.squares += weight * pair.by_wheels * pair.by_wheels;
    sums.residuals += weight * weight * residual * residual * pair.by_wheels * pair.by_wheels;
  }
  return sums;
}

}  // namespace

TurnFit FitTurns(const std::vector<TurnPair>& pairs) {
  TurnFit fit;
  // Weights of bounded squares, from a factor of one on.
  for (int iteration = 0; iteration < 5; ++iteration) {
    const WeightedSums sums = SumsAt(pairs, fit.factor, DegToRad(kMostResidual));
    if (!(sums.squares > 1e-9)) break;
    fit.factor = sums.products / sums.squares;
  }
  for (const TurnPair& pair : pairs) {
    fit.left += Bounded(pair.by_scans - fit.factor * pair.by_wheels);
    fit.without += Bounded(pair.by_scans);
    fit.as_told += Bounded(pair.by_scans - pair.by_wheels);
  }
  const double count = std::max<double>(1.0, static_cast<double>(pairs.size()));
  fit.left /= count;
  fit.without /= count;
  fit.as_told /= count;
  return fit;
}

double Turning(const std::vector<TurnPair>& pairs) {
  double turning = 0.0;
  for (const TurnPair& pair : pairs) {
    if (std::abs(pair.by_scans) >= DegToRad(kTurns)) turning += std::abs(pair.by_scans);
  }
  return turning;
}

Estimated FineFactor(const std::vector<TurnPair>& pairs, double factor) {
  Estimated fine{factor, 0.0};
  for (int iteration = 0; iteration < 10; ++iteration) {
    const WeightedSums sums = SumsAt(pairs, fine.value, DegToRad(kTurnSigmaDeg));
    if (!(sums.squares > 1e-9)) break;
    fine = {sums.products / sums.squares, std::sqrt(sums.residuals) / sums.squares};
  }
  return fine;
}

}  // namespace masked_mapper
