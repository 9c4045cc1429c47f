// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/floor_search.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "block_queue.hpp"
#include "block_sums.hpp"
#include "correlative_search.hpp"
#include "lookup_table.hpp"
#include "refine_match.hpp"

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

// All positions of the table, all headings.
SearchGrid WholeGrid(const LookupTable& table, const FloorSearchOptions& options) {
  const LookupTable::Level& cells = table.level(0);
  SearchGrid grid;
  grid.resolution_m = options.resolution_m;
  const auto middle_x = cells.x0 + cells.width / 2;
  const auto middle_y = cells.y0 + cells.height / 2;
  grid.T_reference_query_guess = {grid.resolution_m * middle_x, grid.resolution_m * middle_y, 0.0};
  grid.half_x = cells.width / 2 + 1;
  grid.half_y = cells.height / 2 + 1;
  grid.angle_step = DegToRad(options.angle_step_deg);
  grid.half_angle = Steps(180.0, options.angle_step_deg);
  return grid;
}

// The best pose of every small box of poses, by one branch and bound over all of them: points are
// rotated and binned once for all boxes, not once for each.
class BoxesSearch {
 public:
  BoxesSearch(const LookupTable& table, const std::vector<Eigen::Vector2d>& points_in_place,
              const FloorSearchOptions& options, double min_score, double box_m, double box_deg)
      : grid_(WholeGrid(table, options)),
        sums_(table, points_in_place, grid_),
        full_(255.0 * static_cast<double>(points_in_place.size())),
        min_score_(min_score),
        half_box_(Steps(0.5 * box_m, options.resolution_m)),
        root_level_(RootLevel(table.levels())) {
    // Along the axes lie the headings of most buildings: they are the middle of a box.
    for (std::int32_t angle = -grid_.half_angle; angle <= grid_.half_angle; ++angle) {
      const double deg = angle * options.angle_step_deg + 180.0 + 0.5 * box_deg;
      box_of_angle_.push_back(static_cast<std::int32_t>(std::fmod(deg, 360.0) / box_deg));
    }
  }

  /// The best boxes first.
  std::vector<PlaceFit> Find() {
    AddRoots();
    std::vector<PlaceFit> fits;
    while (waiting_ > 0) {
      const GridBlock block = queue_.Pop();
      --waiting_;
      if (IsAnswered(block)) continue;
      if (block.level > 0) {
        Expand(block);
        continue;
      }
      answered_.insert(BoxAt(block.pose.angle, block.pose.x, block.pose.y));
      fits.push_back({PoseOf(grid_, block.pose), block.bound});
    }
    return fits;
  }

 private:
  using Box = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

  // Blocks as large as a box, or a little less.
  int RootLevel(int levels) const {
    int level = 0;
    while (level + 1 < levels && (1 << (level + 1)) <= 2 * half_box_ + 1) ++level;
    return level;
  }

  Box BoxAt(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    const std::int32_t side = 2 * half_box_ + 1;
    const std::int32_t place = angle + grid_.half_angle;
    return {box_of_angle_[static_cast<std::size_t>(place)], (x + grid_.half_x + half_box_) / side,
            (y + grid_.half_y + half_box_) / side};
  }

  // Whether all boxes that it reaches into are: four at most, as it is no larger than one.
  bool IsAnswered(const GridBlock& block) const {
    const std::int32_t span = (1 << block.level) - 1;
    const auto low = [&](std::int32_t at, std::int32_t half) {
      return std::max(at * (span + 1), -half);
    };
    const auto high = [&](std::int32_t at, std::int32_t half) {
      return std::min(at * (span + 1) + span, half);
    };
    for (const std::int32_t y :
         {low(block.pose.y, grid_.half_y), high(block.pose.y, grid_.half_y)}) {
      for (const std::int32_t x :
           {low(block.pose.x, grid_.half_x), high(block.pose.x, grid_.half_x)}) {
        if (answered_.count(BoxAt(block.pose.angle, x, y)) == 0) return false;
      }
    }
    return true;
  }

  void AddRoots() {
    constexpr int kSize = BlockSums::kSize;
    // The last heading is the first once more.
    for (std::int32_t angle = 1 - grid_.half_angle; angle <= grid_.half_angle; ++angle) {
      for (std::int32_t y = LowestY(root_level_); y <= HighestY(root_level_); y += kSize) {
        for (std::int32_t x = LowestX(root_level_); x <= HighestX(root_level_); x += kSize) {
          Evaluate(root_level_, {angle, x, y}, kSize);
        }
      }
    }
  }

  void Expand(const GridBlock& block) {
    constexpr int kLevelsPerStep = 2;
    const int level = std::max(block.level - kLevelsPerStep, 0);
    const int size = 1 << (block.level - level);
    Evaluate(level, {block.pose.angle, block.pose.x * size, block.pose.y * size}, size);
  }

  void Evaluate(int level, const GridPose& first, int size) {
    const BlockSums::Sums sums = sums_.At(first.angle, level, first.x, first.y, size);
    for (std::int32_t row = 0; row < size; ++row) {
      for (std::int32_t column = 0; column < size; ++column) {
        const GridPose pose{first.angle, first.x + column, first.y + row};
        const double bound =
            sums[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] / full_;
        const bool is_inside = pose.x >= LowestX(level) && pose.x <= HighestX(level) &&
                               pose.y >= LowestY(level) && pose.y <= HighestY(level);
        if (!is_inside || bound < min_score_) continue;
        queue_.Push({bound, 0, level, pose});
        ++waiting_;
      }
    }
  }

  std::int32_t LowestX(int level) const { return -grid_.half_x >> level; }
  std::int32_t HighestX(int level) const { return grid_.half_x >> level; }
  std::int32_t LowestY(int level) const { return -grid_.half_y >> level; }
  std::int32_t HighestY(int level) const { return grid_.half_y >> level; }

  SearchGrid grid_;
  BlockSums sums_;
  double full_;
  double min_score_;
  std::vector<std::int32_t> box_of_angle_;
  std::int32_t half_box_;  // cells
  int root_level_;
  BlockQueue queue_;
  std::size_t waiting_ = 0;
  std::set<Box> answered_;
};

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

FloorSearch::~FloorSearch() = default;
FloorSearch::FloorSearch(FloorSearch&&) noexcept = default;
FloorSearch& FloorSearch::operator=(FloorSearch&&) noexcept = default;

std::vector<Eigen::Vector2d> FloorSearch::Thinned(const ScanPoints& points_in_place) const {
  return ThinPoints(points_in_place, options_.point_spacing_m, options_.max_range_m);
}

std::optional<PlaceFit> FloorSearch::Find(
    const std::vector<Eigen::Vector2d>& points_in_place) const {
  if (!table_ || points_in_place.empty()) return std::nullopt;
  SearchProblem problem;
  problem.table = table_.get();
  problem.points_in_query = &points_in_place;
  problem.grid = WholeGrid(*table_, options_);
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
  std::vector<PlaceFit> fits =
      BoxesSearch(*table_, points_in_place, options_, min_score, box_m, kBoxDeg).Find();
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
