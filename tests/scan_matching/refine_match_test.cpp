// SPDX-License-Identifier: BSD-3-Clause
#include "scan_matching/refine_match.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "scan_matching/correlative_search.hpp"
#include "scan_matching/drawn_room.hpp"

namespace masked_mapper {
namespace {

ScannerModel Exact() {
  ScannerModel scanner;
  scanner.beams = 360;
  scanner.range_sigma = 0.0;
  return scanner;
}

double ErrorM(const Pose2& truth, const Pose2& pose) { return Distance(truth, pose); }

double ErrorDeg(const Pose2& truth, const Pose2& pose) {
  return RadToDeg(std::abs(WrapAngle(pose.theta - truth.theta)));
}

TEST(RefineMatch, FindsThePoseBelowTheCellWithoutAStaircase) {
  // Poses all over the cells: were the refinement drawn to them, errors would reach half a cell.
  std::mt19937 random(21);
  const Room room = DrawOffice();
  const Pose2 T_room_a{0.2, -0.3, 0.4};
  const LookupTable table(*LookAround(room, T_room_a, Exact(), &random), LookupTableOptions());
  for (int i = 0; i < 40; ++i) {
    const Pose2 T_a_b{0.3 + 0.0031 * i, 0.2 - 0.0023 * i, 0.1 + 0.004 * i};
    const auto points =
        ThinPoints(*LookAround(room, T_room_a * T_a_b, Exact(), &random), 0.1, 30.0);
    const Pose2 start = T_a_b * Pose2{Uniform(-0.06, 0.06, &random), Uniform(-0.06, 0.06, &random),
                                      DegToRad(Uniform(-1.0, 1.0, &random))};
    const RefinedMatch match = RefineMatch(table, points, start, RefineOptions());
    EXPECT_TRUE(match.converged);
    EXPECT_LT(ErrorM(T_a_b, match.T_reference_query.mean), 0.01) << "case " << i << ": metres";
    EXPECT_LT(ErrorDeg(T_a_b, match.T_reference_query.mean), 0.15) << "case " << i << ": degrees";
    EXPECT_GT(match.score, 0.8);
  }
}

TEST(RefineMatch, EndsOnAMaximumOfTheScore) {
  std::mt19937 random(22);
  const Room room = DrawOffice();
  const LookupTable table(*LookAround(room, {0, 0, 0}, Exact(), &random), LookupTableOptions());
  const auto points = ThinPoints(*LookAround(room, {0.3, 0.2, 0.1}, Exact(), &random), 0.1, 30.0);
  const RefinedMatch match = RefineMatch(table, points, {0.33, 0.17, 0.11}, RefineOptions());
  RefineOptions stay;
  stay.max_iterations = 0;
  const Pose2 best = match.T_reference_query.mean;
  EXPECT_EQ(RefineMatch(table, points, best, stay).score, match.score);
  for (const double shift : {-0.01, 0.01}) {
    for (const Pose2& other :
         {Pose2{best.x + shift, best.y, best.theta}, Pose2{best.x, best.y + shift, best.theta},
          Pose2{best.x, best.y, best.theta + shift}}) {
      EXPECT_LT(RefineMatch(table, points, other, stay).score, match.score);
    }
  }
}

TEST(RefineMatch, CovarianceHasTheCurvatureOfTheScore) {
  std::mt19937 random(23);
  const Room room = DrawOffice();
  const LookupTable table(*LookAround(room, {0, 0, 0}, Exact(), &random), LookupTableOptions());
  const auto points = ThinPoints(*LookAround(room, {0.3, 0.2, 0.1}, Exact(), &random), 0.1, 30.0);
  RefineOptions options;
  options.floor_sigma_m = 0.0;
  options.floor_sigma_deg = 0.0;
  const RefinedMatch match = RefineMatch(table, points, {0.3, 0.2, 0.1}, options);
  RefineOptions stay = options;
  stay.max_iterations = 0;
  const auto score = [&](const Eigen::Vector3d& offset) {
    const Pose2& best = match.T_reference_query.mean;
    return RefineMatch(table, points,
                       {best.x + offset.x(), best.y + offset.y(), best.theta + offset.z()}, stay)
        .score;
  };
  Eigen::Matrix3d hessian;
  const double h = 1e-3;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d u = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d v = h * Eigen::Vector3d::Unit(j);
      hessian(i, j) = (score(u + v) - score(u - v) - score(v - u) + score(-u - v)) / (4.0 * h * h);
    }
  }
  const Eigen::Matrix3d expected = (-options.sharpness * hessian).inverse();
  EXPECT_TRUE(match.T_reference_query.covariance.isApprox(expected, 0.02))
      << match.T_reference_query.covariance << "\n\n"
      << expected;
}

TEST(RefineMatch, NeverLosesScoreNorLeavesItsLimits) {
  std::mt19937 random(24);
  const Room room = DrawOffice();
  const LookupTable table(*LookAround(room, {0, 0, 0}, ScannerModel(), &random),
                          LookupTableOptions());
  const auto points =
      ThinPoints(*LookAround(room, {0.3, 0.2, 0.1}, ScannerModel(), &random), 0.1, 30.0);
  const RefineOptions options;
  RefineOptions stay;
  stay.max_iterations = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose2 start{Uniform(-8, 8, &random), Uniform(-8, 8, &random), Uniform(-3, 3, &random)};
    const RefinedMatch match = RefineMatch(table, points, start, options);
    EXPECT_GE(match.score, RefineMatch(table, points, start, stay).score);
    EXPECT_LE(ErrorM(start, match.T_reference_query.mean), options.max_shift_m + 1e-9);
    EXPECT_LE(ErrorDeg(start, match.T_reference_query.mean), options.max_turn_deg + 1e-9);
    for (const Eigen::Matrix3d& covariance :
         {match.T_reference_query.covariance,
          ResponseCovariance(table, points, match.T_reference_query.mean, options)}) {
      ASSERT_TRUE(covariance.allFinite());
      EXPECT_EQ(covariance.llt().info(), Eigen::Success);
    }
  }
}

TEST(RefineMatch, WithoutPointsStaysAndKnowsNothing) {
  const LookupTable table(Points({{1, 1}}), LookupTableOptions());
  const Pose2 start{1, 2, 3};
  const RefinedMatch match = RefineMatch(table, {}, start, RefineOptions());
  EXPECT_EQ(match.T_reference_query.mean.AsVector(), start.AsVector());
  EXPECT_EQ(match.score, 0.0);
  EXPECT_GT(match.T_reference_query.covariance(0, 0), 8.0);
  EXPECT_GT(ResponseCovariance(table, {}, start, RefineOptions())(0, 0), 8.0);
  EXPECT_TRUE(RefineMatch(LookupTable(ScanPoints{}, LookupTableOptions{}), {{0.0, 0.0}}, start,
                          RefineOptions())
                  .T_reference_query.covariance.allFinite());
}

}  // namespace
}  // namespace masked_mapper
