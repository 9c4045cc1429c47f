// SPDX-License-Identifier: BSD-3-Clause
#include "loop_evidence.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

// A closure farther off is false; the evaluation counts by the same.
constexpr double kWrongM = 0.5;
constexpr double kWrongDeg = 5.0;

constexpr double kLeastChance = 1e-300;  // still a number

// m^2 searched to one wrong match. Where six corridors look alike it was one in 250 to 390 by
// wheels alone, in other simulated buildings one in 10000.
constexpr double kSearchedPerWrong = 250.0;

// Walls are parallel and corridors meet at right angles: where a wrong match lies, it is turned as
// the right one is, but for this share, which may be turned anyhow.
constexpr double kShareTurned = 0.1;

// Of matches at the right place, these lie beside it by more than they say, along a wall by up to
// 0.5 m: one in 100 in simulated buildings, where doors and pillars stand in rows.
constexpr double kShareThatSlips = 0.02;

// Sigmas are as sure as if each were learnt from so many tries: errors have the tails of Student's
// distribution.
constexpr double kTries = 30.0;

// Student's density; `off` in sigmas.
double LogStudent(double off, double determinant, double dimensions) {
  return std::lgamma(0.5 * (kTries + dimensions)) - std::lgamma(0.5 * kTries) -
         0.5 * dimensions * std::log(kTries * kPi) -
         0.5 * std::log(std::max(determinant, kLeastChance)) -
         0.5 * (kTries + dimensions) * std::log1p(off * off / kTries);
}

double LogDensity(const UncertainPose2& error) {
  return LogStudent(MahalanobisFromIdentity(error), error.covariance.determinant(), 3.0);
}

double LogDensityOfTurn(const UncertainPose2& error) {
  const double variance = std::max(error.covariance(2, 2), 1e-12);
  return LogStudent(std::abs(error.mean.theta) / std::sqrt(variance), variance, 1.0);
}

double LogSum(double one, double other) {
  const double more = std::max(one, other);
  return more + std::log1p(std::exp(std::min(one, other) - more));
}

double LogChanceToBeWrong(const UncertainPose2& known) {
  const Eigen::Matrix3d& covariance = known.covariance;
  const double variance_m2 = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                 covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly)
                                 .eigenvalues()
                                 .maxCoeff();
  const double room_m = std::max(0.0, kWrongM - known.mean.Translation().norm());
  const double room_rad = std::max(0.0, DegToRad(kWrongDeg) - std::abs(known.mean.theta));
  const double by_place = std::exp(-room_m * room_m / (2.0 * std::max(variance_m2, 1e-12)));
  const double by_heading =
      std::erfc(room_rad / std::sqrt(2.0 * std::max(covariance(2, 2), 1e-12)));
  return std::log(std::clamp(by_place + by_heading, kLeastChance, 1.0));
}

}  // namespace

double LoopEvidence(const UncertainPose2& loop) {
  // Along the line on which it would have slipped, evenly; across it and in heading as right ones.
  UncertainPose2 slipped = loop;
  const Eigen::Vector2d off = loop.mean.Translation();
  const Eigen::Vector2d along =
      off.norm() > 0.0 ? Eigen::Vector2d(off.normalized() * kWrongM) : Eigen::Vector2d::Zero();
  slipped.covariance.topLeftCorner<2, 2>() += along * along.transpose() / 3.0;
  const double turned = LogSum(std::log(1.0 - kShareTurned) + LogDensityOfTurn(loop),
                               std::log(kShareTurned / (2.0 * kPi)));
  const double elsewhere = LogChanceToBeWrong(loop) + turned - std::log(kSearchedPerWrong);
  const double beside = LogDensity(slipped) + std::log(kShareThatSlips);
  return LogDensity(loop) - LogSum(elsewhere, beside);
}

double ChanceToBeWrong(const UncertainPose2& known) { return std::exp(LogChanceToBeWrong(known)); }

double MostEvidenceOfWitness(double apart_m) {
  constexpr double kRepeatsOver = 8.0;  // m
  return std::log(4.0) * std::min(1.0, apart_m / kRepeatsOver);
}

}  // namespace masked_mapper
