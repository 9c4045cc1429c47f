// SPDX-License-Identifier: BSD-3-Clause
// One match attempt and its parts, on two scans of a real building 2 m apart, in a window of +-3 m
// and
// +-20 deg around a guess that is off by 1 m and 8 deg.
#include <benchmark/benchmark.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"
#include "scan_matching/correlative_search.hpp"
#include "scan_matching/refine_match.hpp"

namespace masked_mapper {
namespace {

std::optional<MatchPair> ReadPair() {
  MatchPair pair;
  std::optional<Pose2> T_odom_reference;
  const std::unique_ptr<LogReader> log =
      OpenLog(MASKED_MAPPER_REAL_LOGS "/data/aces.clf.gz", LogOptions());
  for (int scans = 0; std::optional<Observation> observation = log->Next();) {
    const LaserScan* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr || !scan->T_odom_robot || ++scans < 500) continue;
    if (!T_odom_reference) {
      T_odom_reference = scan->T_odom_robot;
      pair.points_in_reference = PointsInRobot(*scan);
    } else if (Distance(*T_odom_reference, *scan->T_odom_robot) > 2.0) {
      pair.points_in_query = PointsInRobot(*scan);
      const Pose2 error{0.8, -0.6, DegToRad(8.0)};
      pair.T_reference_query_guess.mean = Between(*T_odom_reference, *scan->T_odom_robot) * error;
      const double sigma_rad = DegToRad(20.0 / 3.0);
      pair.T_reference_query_guess.covariance.diagonal() << 1.0, 1.0, sigma_rad * sigma_rad;
      return pair;
    }
  }
  return std::nullopt;
}

// Null, and the benchmark skipped, where the log is not there.
const MatchPair* RealPair(benchmark::State* state) {
  static const std::optional<MatchPair> pair = []() -> std::optional<MatchPair> {
    try {
      return ReadPair();
    } catch (const std::runtime_error&) {
      return std::nullopt;
    }
  }();
  if (!pair) state->SkipWithError("no real log to take scans from");
  return pair ? &*pair : nullptr;
}

struct Prepared {
  explicit Prepared(const MatchPair& pair)
      : table(*pair.points_in_reference, options.table),
        points(
            ThinPoints(*pair.points_in_query, options.point_spacing_m, options.table.max_range_m)) {
    problem.table = &table;
    problem.points_in_query = &points;
    problem.grid = SearchGridFor(pair.T_reference_query_guess, options);
    problem.prior_root = PriorRoot(pair.T_reference_query_guess.covariance, problem.grid);
    problem.prior_weight = options.prior_weight;
    problem.min_score = options.min_score;
  }

  MatcherOptions options;
  LookupTable table;
  std::vector<Eigen::Vector2d> points;
  SearchProblem problem;
};

void BuildTable(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  const LookupTableOptions options;
  const BlurKernels kernels(options);
  for (auto _ : state) {
    LookupTable table(*pair->points_in_reference, options, kernels);
    benchmark::DoNotOptimize(table);
  }
}
BENCHMARK(BuildTable)->Unit(benchmark::kMicrosecond);

void MatchAttempt(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  JointMatcher matcher{MatcherOptions()};
  for (auto _ : state) benchmark::DoNotOptimize(matcher.Match({*pair}));
}
BENCHMARK(MatchAttempt)->Unit(benchmark::kMicrosecond);

void MatchAttemptWithNewTable(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  MatcherOptions options;
  options.table_memory_mib = 0;
  JointMatcher matcher(options);
  for (auto _ : state) benchmark::DoNotOptimize(matcher.Match({*pair}));
}
BENCHMARK(MatchAttemptWithNewTable)->Unit(benchmark::kMicrosecond);

void SearchBestFirst(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  if (pair == nullptr) return;
  const Prepared prepared(*pair);
  for (auto _ : state) benchmark::DoNotOptimize(SearchJointly({prepared.problem}));
}
BENCHMARK(SearchBestFirst)->Unit(benchmark::kMicrosecond);

void SearchByBruteForce(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  if (pair == nullptr) return;
  const Prepared prepared(*pair);
  for (auto _ : state) benchmark::DoNotOptimize(SearchExhaustively(prepared.problem));
}
BENCHMARK(SearchByBruteForce)->Unit(benchmark::kMicrosecond);

void RefineOneMatch(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  if (pair == nullptr) return;
  const Prepared prepared(*pair);
  const SearchResult found = SearchJointly({prepared.problem})[0];
  const Pose2 start = PoseOf(prepared.problem.grid, found.best);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        RefineMatch(prepared.table, prepared.points, start, prepared.options.refine));
  }
}
BENCHMARK(RefineOneMatch)->Unit(benchmark::kMicrosecond);

void CovarianceOfOneMatch(benchmark::State& state) {
  const MatchPair* pair = RealPair(&state);
  if (pair == nullptr) return;
  const Prepared prepared(*pair);
  const SearchResult found = SearchJointly({prepared.problem})[0];
  const Pose2 pose = PoseOf(prepared.problem.grid, found.best);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ResponseCovariance(prepared.table, prepared.points, pose, prepared.options.refine));
  }
}
BENCHMARK(CovarianceOfOneMatch)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace masked_mapper
