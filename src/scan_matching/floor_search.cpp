// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/floor_search.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/scan_matching/correlative_search.hpp"
#include "masked_mapper/scan_matching/refine_match.hpp"

namespace masked_mapper {
namespace {

constexpr double kFarthest = 1e4;     // m from the origin
constexpr double kLargestArea = 2e6;  // m^2, of the table
constexpr double kMostCells = 2e8;    // a byte each
// Blocks of 32 cells at the top: measured, fewer roots do not pay for the looser bounds.
constexpr int kLevels = 6;

std::int32_t Steps(double length, double step) {
  return static_cast<std::int32_t>(std::ceil(length / step - 1e-9));
}

}  // namespace

FloorSearch::FloorSearch(const ScanPoints& points_in_world, const FloorSearchOptions& options)
    : options_(options) {
  LookupTableOptions table;
  table.resolution_m = options.resolution_m;
  table.sigma_m = options.sigma_m;
  table.max_range_m = 2.0 * kFarthest;
  table.join_gap_m = 0.0;  // the points of a floor have no order
  table.levels = kLevels;
  Eigen::Array2d low = Eigen::Array2d::Constant(kFarthest);
  Eigen::Array2d high = -low;
  for (const pcl::PointXY& point : points_in_world) {
    const Eigen::Array2d position(point.x, point.y);
    low = low.min(position);
    high = high.max(position);
  }
  const Eigen::Array2d size = high - low;
  const double area = (size.x() + 1.0) * (size.y() + 1.0);
  const bool is_sane = !points_in_world.empty() && (low >= -kFarthest).all() &&
                       (high <= kFarthest).all() && area <= kLargestArea &&
                       area <= kMostCells * options.resolution_m * options.resolution_m;
  if (is_sane) table_ = std::make_unique<LookupTable>(points_in_world, table);
}

std::vector<Eigen::Vector2d> FloorSearch::Thinned(const ScanPoints& points_in_place) const {
  return ThinPoints(points_in_place, options_.point_spacing_m, options_.max_range_m);
}

std::optional<PlaceFit> FloorSearch::Find(
    const std::vector<Eigen::Vector2d>& points_in_place) const {
  if (!table_ || points_in_place.empty()) return std::nullopt;
  const LookupTable::Level& cells = table_->level(0);
  const double resolution = options_.resolution_m;
  SearchProblem problem;
  problem.table = table_.get();
  problem.points_in_query = &points_in_place;
  problem.grid.resolution_m = resolution;
  const auto middle_x = cells.x0 + cells.width / 2;
  const auto middle_y = cells.y0 + cells.height / 2;
  problem.grid.T_reference_query_guess = {resolution * middle_x, resolution * middle_y, 0.0};
  problem.grid.half_x = cells.width / 2 + 1;
  problem.grid.half_y = cells.height / 2 + 1;
  problem.grid.angle_step = DegToRad(options_.angle_step_deg);
  problem.grid.half_angle = Steps(180.0, options_.angle_step_deg);
  problem.min_score = options_.min_score;
  const SearchResult best = SearchJointly({problem}).front();
  if (!best.found) return std::nullopt;
  return PlaceFit{PoseOf(problem.grid, best.best), best.score};
}

std::vector<PlaceFit> FloorSearch::FindAll(const std::vector<Eigen::Vector2d>& points_in_place,
                                           double min_score, double apart_m,
                                           double apart_deg) const {
  if (!table_ || points_in_place.empty()) return {};
  // The best of every small box of poses; a slope that a box cuts off lies near a better one.
  constexpr double kBoxDeg = 45.0;
  const double box_m = std::max(4.0 * apart_m, 8.0 * options_.resolution_m);
  const LookupTable::Level& cells = table_->level(0);
  const std::int32_t half = Steps(0.5 * box_m, options_.resolution_m);
  std::vector<SearchProblem> problems;
  for (std::int32_t y = -1; y <= cells.height + half; y += 2 * half + 1) {
    for (std::int32_t x = -1; x <= cells.width + half; x += 2 * half + 1) {
      for (double deg = 0.0; deg < 360.0; deg += kBoxDeg) {
        SearchProblem problem;
        problem.table = table_.get();
        problem.points_in_query = &points_in_place;
        problem.grid.resolution_m = options_.resolution_m;
        problem.grid.T_reference_query_guess = {options_.resolution_m * (cells.x0 + x),
                                                options_.resolution_m * (cells.y0 + y),
                                                DegToRad(deg)};
        problem.grid.half_x = problem.grid.half_y = half;
        problem.grid.angle_step = DegToRad(options_.angle_step_deg);
        problem.grid.half_angle = Steps(0.5 * kBoxDeg, options_.angle_step_deg);
        problem.min_score = min_score;
        problems.push_back(problem);
      }
    }
  }
  std::vector<PlaceFit> fits;
  const std::vector<SearchResult> results = SearchJointly(problems);
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].found) {
      fits.push_back({PoseOf(problems[i].grid, results[i].best), results[i].score});
    }
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PlaceFit& a, const PlaceFit& b) { return a.score > b.score; });
  std::vector<PlaceFit> apart;
  for (const PlaceFit& fit : fits) {
    const bool is_near = std::any_of(apart.begin(), apart.end(), [&](const PlaceFit& better) {
      return Distance(better.T_world_place, fit.T_world_place) < apart_m &&
             std::abs(WrapAngle(better.T_world_place.theta - fit.T_world_place.theta)) <
                 DegToRad(apart_deg);
    });
    if (!is_near) apart.push_back(fit);
  }
  return apart;
}

PlaceFit FloorSearch::Climb(const std::vector<Eigen::Vector2d>& points_in_place,
                            const Pose2& T_world_place) const {
  if (!table_ || points_in_place.empty()) return {T_world_place, 0.0};
  const RefinedMatch refined = RefineMatch(*table_, points_in_place, T_world_place, {});
  return {refined.T_reference_query.mean, refined.score};
}

double FloorSearch::ValueAt(const Eigen::Vector2d& point_in_world) const {
  if (!table_) return 0.0;
  return table_->Value(0, table_->CellAt(point_in_world.x(), point_in_world.y())) / 255.0;
}

PlaceFit FloorSearch::FindNear(const std::vector<Eigen::Vector2d>& points_in_place,
                               const Pose2& T_world_place_guess, double within_m,
                               double within_deg) const {
  if (!table_ || points_in_place.empty()) return {T_world_place_guess, 0.0};
  SearchProblem problem;
  problem.table = table_.get();
  problem.points_in_query = &points_in_place;
  problem.grid.resolution_m = options_.resolution_m;
  problem.grid.T_reference_query_guess = T_world_place_guess;
  problem.grid.half_x = problem.grid.half_y = Steps(within_m, options_.resolution_m);
  problem.grid.angle_step = DegToRad(options_.angle_step_deg);
  problem.grid.half_angle = Steps(within_deg, options_.angle_step_deg);
  const SearchResult best = SearchJointly({problem}).front();
  if (!best.found) return {T_world_place_guess, 0.0};
  return {PoseOf(problem.grid, best.best), best.score};
}

}  // namespace masked_mapper
