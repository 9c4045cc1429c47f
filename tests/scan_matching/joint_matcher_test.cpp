// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/joint_matcher.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "scan_matching/drawn_room.hpp"

namespace masked_mapper {
namespace {

Eigen::Matrix3d Covariance(double sigma_m, double sigma_deg) {
  const double sigma_rad = DegToRad(sigma_deg);
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

MatchPair DrawPair(const Room& room, const Pose2& T_room_reference, const Pose2& T_room_query,
                   const ScannerModel& scanner, std::mt19937* random) {
  MatchPair pair;
  pair.points_in_reference = LookAround(room, T_room_reference, scanner, random);
  pair.points_in_query = LookAround(room, T_room_query, scanner, random);
  pair.T_reference_query_guess.mean = Between(T_room_reference, T_room_query);
  return pair;
}

void ExpectSameResults(const std::vector<MatchResult>& a, const std::vector<MatchResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].outcome, b[i].outcome);
    EXPECT_EQ(a[i].score, b[i].score);
    EXPECT_EQ(a[i].T_reference_query.mean.AsVector(), b[i].T_reference_query.mean.AsVector());
    EXPECT_EQ(a[i].T_reference_query.covariance, b[i].T_reference_query.covariance);
  }
}

std::vector<MatchPair> DrawOfficePairs(int count, unsigned seed) {
  std::mt19937 random(seed);
  const Room room = DrawOffice();
  const ScannerModel scanner;
  std::vector<MatchPair> pairs;
  for (int i = 0; i < count; ++i) {
    const Pose2 T_room_a{Uniform(-1, 1, &random), Uniform(-2, 2, &random), Uniform(-3, 3, &random)};
    const Pose2 T_a_b{Uniform(-1, 1, &random), Uniform(-1, 1, &random),
                      Uniform(-0.5, 0.5, &random)};
    pairs.push_back(DrawPair(room, T_room_a, T_room_a * T_a_b, scanner, &random));
    MatchPair& pair = pairs.back();
    pair.reference_key = i;
    const Pose2 error{Uniform(-0.8, 0.8, &random), Uniform(-0.8, 0.8, &random),
                      DegToRad(Uniform(-10, 10, &random))};
    pair.T_reference_query_guess.mean = T_a_b * error;
    pair.T_reference_query_guess.covariance = Covariance(0.5, 6.0);
  }
  return pairs;
}

TEST(JointMatcher, RecoversKnownPoses) {
  std::mt19937 random(11);
  const Room room = DrawOffice();
  ScannerModel scanner;
  JointMatcher matcher{MatcherOptions()};
  double sum_m = 0.0;
  double sum_deg = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Pose2 T_room_a{Uniform(-1, 1, &random), Uniform(-2, 2, &random), Uniform(-3, 3, &random)};
    const Pose2 T_a_b{Uniform(-0.7, 0.7, &random), Uniform(-0.7, 0.7, &random),
                      Uniform(-0.5, 0.5, &random)};
    MatchPair pair = DrawPair(room, T_room_a, T_room_a * T_a_b, scanner, &random);
    pair.reference_key = i;
    const Pose2 error{Uniform(-1, 1, &random), Uniform(-1, 1, &random),
                      DegToRad(Uniform(-15, 15, &random))};
    pair.T_reference_query_guess = {T_a_b * error, Covariance(0.7, 10.0)};
    const MatchResult result = matcher.Match({pair})[0];
    ASSERT_EQ(result.outcome, MatchOutcome::kMatched) << i;
    const Pose2 difference = Between(T_a_b, result.T_reference_query.mean);
    const double error_m = std::hypot(difference.x, difference.y);
    const double error_deg = RadToDeg(std::abs(difference.theta));
    EXPECT_LT(error_m, 0.05) << "case " << i << ": metres";
    EXPECT_LT(error_deg, 0.6) << "case " << i << ": degrees";
    sum_m += error_m;
    sum_deg += error_deg;
  }
  RecordProperty("mean_error_mm", static_cast<int>(1e3 * sum_m / 50));
  RecordProperty("mean_error_mdeg", static_cast<int>(1e3 * sum_deg / 50));
  EXPECT_LT(sum_m / 50, 0.015);
  EXPECT_LT(sum_deg / 50, 0.2);
}

TEST(JointMatcher, SameResultsAtAnyNumberOfThreadsAndAnyCacheSize) {
  const std::vector<MatchPair> pairs = DrawOfficePairs(7, 12);
  MatcherOptions options;
  JointMatcher one(options);
  const std::vector<MatchResult> expected = one.Match(pairs);
  ExpectSameResults(one.Match(pairs), expected);  // from cached tables
  one.Forget();
  ExpectSameResults(one.Match(pairs), expected);
  options.threads = 2;
  ExpectSameResults(JointMatcher(options).Match(pairs), expected);
  options.threads = 16;
  options.table_memory_mib = 0;
  JointMatcher many(options);
  ExpectSameResults(many.Match(pairs), expected);
  ExpectSameResults(many.Match(pairs), expected);
}

TEST(JointMatcher, JointResultsEqualSingleOnes) {
  std::vector<MatchPair> pairs = DrawOfficePairs(6, 13);
  pairs.push_back(pairs[2]);
  JointMatcher matcher{MatcherOptions()};
  const std::vector<MatchResult> joint = matcher.Match(pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ExpectSameResults(JointMatcher{MatcherOptions()}.Match({pairs[i]}), {joint[i]});
  }
}

TEST(JointMatcher, NeedsNoPointsOfAReferenceThatItHas) {
  std::vector<MatchPair> pairs = DrawOfficePairs(2, 17);
  JointMatcher matcher{MatcherOptions()};
  EXPECT_FALSE(matcher.Has(pairs[0].reference_key));
  const std::vector<MatchResult> with_points = matcher.Match(pairs);
  for (MatchPair& pair : pairs) {
    EXPECT_TRUE(matcher.Has(pair.reference_key));
    pair.points_in_reference = nullptr;
  }
  ExpectSameResults(matcher.Match(pairs), with_points);
  matcher.Forget();
  EXPECT_FALSE(matcher.Has(pairs[0].reference_key));
}

TEST(JointMatcher, AnotherRoomDoesNotMatch) {
  std::mt19937 random(14);
  const ScannerModel scanner;
  MatchPair pair;
  pair.points_in_reference = LookAround(DrawOffice(), {0, 0, 0}, scanner, &random);
  Room hut;
  AddLoop({{-0.4, -0.4}, {0.9, -0.6}, {1.2, 0.5}, {0.1, 0.9}}, &hut);
  pair.points_in_query = LookAround(hut, {0, 0, 0}, scanner, &random);
  pair.T_reference_query_guess = {{0.5, 0.0, 0.0}, Covariance(0.3, 5.0)};
  const MatchResult result = JointMatcher{MatcherOptions()}.Match({pair})[0];
  EXPECT_EQ(result.outcome, MatchOutcome::kBelowMinScore);
  EXPECT_LT(result.score, 0.425);
  EXPECT_EQ(result.T_reference_query.mean.x, 0.5);
}

TEST(JointMatcher, CorridorGivesAnElongatedCovariance) {
  std::mt19937 random(15);
  ScannerModel scanner;
  scanner.field_of_view = 2.0 * kPi;
  scanner.beams = 360;
  MatchPair pair = DrawPair(DrawCorridor(), {0, 0.2, 0.3}, {0.5, -0.1, 0.2}, scanner, &random);
  const Pose2 truth = pair.T_reference_query_guess.mean;
  pair.T_reference_query_guess.covariance = Covariance(0.4, 5.0);
  const MatchResult result = JointMatcher{MatcherOptions()}.Match({pair})[0];
  ASSERT_EQ(result.outcome, MatchOutcome::kMatched);
  const Eigen::Matrix2d covariance = result.T_reference_query.covariance.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const double along_m = std::sqrt(axes.eigenvalues()(1));
  const double across_m = std::sqrt(axes.eigenvalues()(0));
  EXPECT_GT(along_m, 5.0 * across_m);
  EXPECT_GT(along_m, 0.15);
  EXPECT_LT(across_m, 0.05);
  // The corridor lies at -0.3 rad in the reference frame.
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  EXPECT_GT(std::abs(along.dot(Eigen::Vector2d(std::cos(0.3), -std::sin(0.3)))), 0.99);
  // Across the corridor and in angle the match is right.
  const Eigen::Vector2d error = result.T_reference_query.mean.Translation() - truth.Translation();
  EXPECT_LT(std::abs(error.dot(axes.eigenvectors().col(0))), 0.03);
  EXPECT_LT(RadToDeg(std::abs(result.T_reference_query.mean.theta - truth.theta)), 0.5);
}

// Errors of repeated noisy matches against the covariances reported for them, in the reference
// frame.
struct Spread {
  Eigen::Vector3d rms_error;
  Eigen::Vector3d sigma;
  double mean_mahalanobis2 = 0.0;  // 3 for a covariance that is exactly right
};

Spread MatchManyTimes(const Room& room, double field_of_view, int beams) {
  std::mt19937 random(17);
  ScannerModel scanner;
  scanner.field_of_view = field_of_view;
  scanner.beams = beams;
  scanner.range_sigma = 0.02;
  JointMatcher matcher{MatcherOptions()};
  const int count = 60;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  Spread spread;
  for (int i = 0; i < count; ++i) {
    const Pose2 T_room_a{Uniform(-0.3, 0.3, &random), 0.2, Uniform(-0.02, 0.02, &random)};
    const Pose2 T_a_b{Uniform(0.2, 0.8, &random), -0.2, Uniform(-0.2, 0.2, &random)};
    MatchPair pair = DrawPair(room, T_room_a, T_room_a * T_a_b, scanner, &random);
    pair.reference_key = i;
    const Pose2 error{Uniform(-0.5, 0.5, &random), Uniform(-0.5, 0.5, &random),
                      Uniform(-0.1, 0.1, &random)};
    pair.T_reference_query_guess = {T_a_b * error, Covariance(0.4, 4.0)};
    const UncertainPose2 match = matcher.Match({pair})[0].T_reference_query;
    Eigen::Vector3d difference = match.mean.AsVector() - T_a_b.AsVector();
    difference.z() = WrapAngle(difference.z());
    squares += difference.cwiseAbs2() / count;
    variances += match.covariance.diagonal() / count;
    spread.mean_mahalanobis2 += difference.dot(match.covariance.ldlt().solve(difference)) / count;
  }
  spread.rms_error = squares.cwiseSqrt();
  spread.sigma = variances.cwiseSqrt();
  return spread;
}

TEST(JointMatcher, CovarianceIsHonestInARoom) {
  const Spread spread = MatchManyTimes(DrawOffice(), kPi, 180);
  EXPECT_LT(spread.rms_error.x(), spread.sigma.x()) << "metres";
  EXPECT_LT(spread.rms_error.y(), spread.sigma.y()) << "metres";
  EXPECT_LT(spread.rms_error.z(), spread.sigma.z()) << "radians";
  EXPECT_LT(spread.sigma.x(), 0.06);
  EXPECT_LT(spread.sigma.y(), 0.06);
  EXPECT_LT(RadToDeg(spread.sigma.z()), 1.0);
}

TEST(JointMatcher, CovarianceIsHonestInACorridor) {
  for (const double field_of_view : {kPi, 2.0 * kPi}) {
    const Spread spread =
        MatchManyTimes(DrawCorridor(), field_of_view, field_of_view > 4.0 ? 360 : 180);
    // Along the corridor nothing but the window bounds the error, and the covariance says so.
    EXPECT_GT(spread.sigma.x(), 0.8 * spread.rms_error.x()) << "metres";
    EXPECT_LT(spread.sigma.x(), 4.0 * spread.rms_error.x()) << "metres";
    EXPECT_GT(spread.sigma.x(), 8.0 * spread.sigma.y()) << "metres";
    EXPECT_LT(spread.mean_mahalanobis2, 3.5);
  }
}

TEST(JointMatcher, FindsTheSecondPlace) {
  // Two like niches 2.2 m apart: seen from in front of one, the other fits nearly as well.
  std::mt19937 random(18);
  Room room;
  AddLoop({{-6, -2},
           {6, -2},
           {6, 2},
           {1.6, 2},
           {1.6, 2.8},
           {0.6, 2.8},
           {0.6, 2},
           {-0.6, 2},
           {-0.6, 2.8},
           {-1.6, 2.8},
           {-1.6, 2},
           {-6, 2}},
          &room);
  ScannerModel scanner;
  scanner.max_range = 4.0;  // the ends of the room are out of sight
  MatchPair pair = DrawPair(room, {0, 0, kPi / 2}, {-1.1, 0, kPi / 2}, scanner, &random);
  pair.T_reference_query_guess.covariance = Covariance(1.0, 3.0);
  MatcherOptions options;
  EXPECT_FALSE(JointMatcher(options).Match({pair})[0].elsewhere);
  options.look_elsewhere = true;
  const MatchResult result = JointMatcher(options).Match({pair})[0];
  ASSERT_EQ(result.outcome, MatchOutcome::kMatched);
  EXPECT_NEAR(result.T_reference_query.mean.y, 1.1, 0.1);
  ASSERT_TRUE(result.elsewhere);
  EXPECT_GT(result.elsewhere->score, 0.7 * result.score);
  EXPECT_GT(Distance(result.elsewhere->T_reference_query, result.T_reference_query.mean), 0.5);

  // In a room without symmetry there is none.
  pair = DrawPair(DrawOffice(), {0, 0, 0}, {0.5, 0.5, 0.2}, ScannerModel(), &random);
  pair.T_reference_query_guess.covariance = Covariance(0.5, 5.0);
  EXPECT_FALSE(JointMatcher(options).Match({pair})[0].elsewhere);
}

TEST(JointMatcher, EmptyScansDoNotMatch) {
  MatchPair pair;
  pair.points_in_reference = ScanPoints::ConstPtr(new ScanPoints);
  pair.points_in_query = pair.points_in_reference;
  pair.T_reference_query_guess.covariance = Covariance(0.3, 5.0);
  MatchPair half = pair;
  half.reference_key = 1;
  half.points_in_query = ScanPoints::ConstPtr(new ScanPoints(Points({{1, 1}, {2, 1}})));
  JointMatcher matcher{MatcherOptions()};
  for (const MatchResult& result : matcher.Match({pair, half})) {
    EXPECT_EQ(result.outcome, MatchOutcome::kBelowMinScore);
    EXPECT_EQ(result.score, 0.0);
  }
  EXPECT_TRUE(matcher.Match({}).empty());
}

}  // namespace
}  // namespace masked_mapper
