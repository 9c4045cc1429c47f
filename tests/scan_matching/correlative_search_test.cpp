// SPDX-License-Identifier: BSD-3-Clause
#include "scan_matching/correlative_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "scan_matching/drawn_room.hpp"

namespace masked_mapper {
namespace {

void ExpectSame(const SearchResult& found, const SearchResult& expected, double min_score) {
  ASSERT_EQ(found.found, expected.found);
  if (!expected.found) {
    EXPECT_GE(found.score, expected.score);  // a bound
    EXPECT_LT(found.score, min_score);
    return;
  }
  EXPECT_EQ(found.best.angle, expected.best.angle);
  EXPECT_EQ(found.best.x, expected.best.x);
  EXPECT_EQ(found.best.y, expected.best.y);
  EXPECT_EQ(found.score, expected.score);
  EXPECT_EQ(found.objective, expected.objective);
}

struct RandomCase {
  LookupTable table;
  std::vector<Eigen::Vector2d> points;
  SearchProblem problem;
};

Eigen::Matrix3d RandomCovariance(std::mt19937* random) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = Uniform(-1.0, 1.0, random);
  root = Eigen::Vector3d(0.3, 0.3, 0.1).asDiagonal() * root * Uniform(0.01, 3.0, random);
  return root * root.transpose();
}

// Small on purpose: few points, so that ties are common; windows smaller and larger than the table.
std::unique_ptr<RandomCase> DrawCase(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto upto = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  LookupTableOptions options;
  options.sigma_m = Uniform(0.0, 0.15, &random);
  options.levels = 1 + upto(5);
  options.join_gap_m = upto(1) * 0.3;
  const double reach = Uniform(0.02, 2.0, &random);
  std::vector<std::pair<double, double>> reference;
  for (int i = upto(30); i >= 0; --i) {
    reference.push_back({Uniform(-reach, reach, &random), Uniform(-reach, reach, &random)});
  }
  auto drawn = std::make_unique<RandomCase>(
      RandomCase{LookupTable(Points(reference), options), {}, SearchProblem()});
  for (int i = upto(12); i >= 0; --i) {
    drawn->points.push_back({Uniform(-reach, reach, &random), Uniform(-reach, reach, &random)});
  }
  SearchProblem& problem = drawn->problem;
  problem.table = &drawn->table;
  problem.points_in_query = &drawn->points;
  problem.grid.T_reference_query_guess = {Uniform(-1, 1, &random), Uniform(-1, 1, &random),
                                          Uniform(-kPi, kPi, &random)};
  problem.grid.resolution_m = options.resolution_m;
  problem.grid.angle_step = Uniform(0.005, 0.1, &random);
  problem.grid.half_angle = upto(6);
  problem.grid.half_x = upto(25);
  problem.grid.half_y = upto(25);
  const int prior = upto(3);
  if (prior > 0) {
    problem.prior_root = PriorRoot(RandomCovariance(&random), problem.grid);
    problem.prior_weight = prior == 1 ? 0.005 : Uniform(0.0, 0.1, &random);
  }
  problem.min_score = upto(2) == 0 ? 0.0 : Uniform(0.0, 0.9, &random);
  if (upto(3) == 0) {
    problem.left_out = {
        {upto(12) - 6, upto(50) - 25, upto(50) - 25}, upto(5) - 1, upto(20), upto(20)};
  }
  return drawn;
}

TEST(CorrelativeSearch, EqualsExhaustiveSearch) {
  int found = 0;
  for (int seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto drawn = DrawCase(seed);
    const SearchResult expected = SearchExhaustively(drawn->problem);
    ExpectSame(SearchJointly({drawn->problem})[0], expected, drawn->problem.min_score);
    found += expected.found ? 1 : 0;
  }
  EXPECT_GT(found, 200);  // the cases are of both kinds
  EXPECT_LT(found, 550);
}

TEST(CorrelativeSearch, JointResultsEqualSingleOnes) {
  std::vector<std::unique_ptr<RandomCase>> cases;
  std::vector<SearchProblem> problems;
  for (int seed = 1000; seed < 1060; ++seed) {
    cases.push_back(DrawCase(seed));
    problems.push_back(cases.back()->problem);
  }
  const std::vector<SearchResult> joint = SearchJointly(problems);
  ASSERT_EQ(joint.size(), problems.size());
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const SearchResult single = SearchJointly({problems[i]})[0];
    EXPECT_EQ(joint[i].found, single.found);
    EXPECT_EQ(joint[i].score, single.score);
    EXPECT_EQ(joint[i].objective, single.objective);
    EXPECT_EQ(joint[i].best.angle, single.best.angle);
    EXPECT_EQ(joint[i].best.x, single.best.x);
    EXPECT_EQ(joint[i].best.y, single.best.y);
  }
}

TEST(CorrelativeSearch, OfEqualPosesTheFirstIsTaken) {
  // One reference point without blur and one query point: every angle reaches the same value.
  LookupTableOptions options;
  options.sigma_m = 0.0;
  const LookupTable table(Points({{0.525, 0.525}}), options);
  const std::vector<Eigen::Vector2d> points = {{0.0, 0.0}};
  SearchProblem problem;
  problem.table = &table;
  problem.points_in_query = &points;
  problem.grid = {{0.525, 0.525, 0.0}, 0.05, 0.1, 3, 10, 10};
  const SearchResult found = SearchJointly({problem})[0];
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.best.angle, -3);
  EXPECT_EQ(found.best.x, 0);
  EXPECT_EQ(found.best.y, 0);
  ExpectSame(found, SearchExhaustively(problem), 0.0);

  // Nothing fits anywhere: all poses tie at 0.
  problem.grid.T_reference_query_guess.x = 40.0;
  const SearchResult nothing = SearchJointly({problem})[0];
  EXPECT_EQ(nothing.best.angle, -3);
  EXPECT_EQ(nothing.best.x, -10);
  EXPECT_EQ(nothing.best.y, -10);
  EXPECT_EQ(nothing.score, 0.0);
}

TEST(CorrelativeSearch, ManyPointsInOneCellDoNotOverflow) {
  const LookupTable table(Points({{0.525, 0.525}}), LookupTableOptions());
  const std::vector<Eigen::Vector2d> points(3000, Eigen::Vector2d(0.01, 0.01));
  SearchProblem problem;
  problem.table = &table;
  problem.points_in_query = &points;
  problem.grid = {{0.3, 0.7, 0.0}, 0.05, 0.1, 1, 12, 12};
  const SearchResult found = SearchJointly({problem})[0];
  ExpectSame(found, SearchExhaustively(problem), 0.0);
  EXPECT_GT(found.score, 0.95);
}

TEST(CorrelativeSearch, NoPointsNoAnswer) {
  const LookupTable table(ScanPoints{}, LookupTableOptions{});
  const std::vector<Eigen::Vector2d> points;
  SearchProblem problem;
  problem.table = &table;
  problem.points_in_query = &points;
  problem.grid = {{0.0, 0.0, 0.0}, 0.05, 0.1, 3, 10, 10};
  EXPECT_FALSE(SearchJointly({problem})[0].found);
  EXPECT_FALSE(SearchExhaustively(problem).found);
  EXPECT_TRUE(SearchJointly({}).empty());
}

TEST(PriorRoot, IsTheRootOfTheInformation) {
  std::mt19937 random(7);
  SearchGrid grid;
  grid.angle_step = 0.01;
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix3d covariance = RandomCovariance(&random);
    const Eigen::Matrix3d root = PriorRoot(covariance, grid);
    covariance.diagonal() += Eigen::Vector3d(0.0025, 0.0025, 0.0001) / 12.0;
    EXPECT_TRUE((root.transpose() * root * covariance).isIdentity(1e-6)) << root;
    EXPECT_EQ(root(1, 0), 0.0);
    EXPECT_EQ(root(2, 0), 0.0);
    EXPECT_EQ(root(2, 1), 0.0);
  }
  EXPECT_TRUE(PriorRoot(Eigen::Matrix3d::Zero(), grid).allFinite());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(PriorRoot(Eigen::Matrix3d::Constant(nan), grid).isZero());
}

}  // namespace
}  // namespace masked_mapper
