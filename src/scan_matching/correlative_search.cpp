// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/correlative_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <queue>
#include <unordered_map>

namespace masked_mapper {
namespace {

constexpr int kBlock = 8;  // children of a block, per direction, are at most this many
constexpr std::uint32_t kMaxCount = 128;   // of points merged in one coarse cell
constexpr std::uint32_t kMaxWeight = 257;  // of points whose bytes add up within 16 bits
constexpr double kUnset = -1e300;

// Points that fall into one cell of a level, relative to the table's first cell there.
struct BinnedPoint {
  std::int32_t x;
  std::int32_t y;
  std::uint32_t count;
};

using Sums = std::array<std::array<std::uint32_t, kBlock>, kBlock>;  // [y][x]

// A function of its own, never inlined: both searches must round alike.
__attribute__((noinline)) double Chi2(const SearchProblem& problem, const GridPose& pose) {
  const Eigen::Matrix3d& u = problem.prior_root;
  const double x = pose.x * problem.grid.resolution_m;
  const double y = pose.y * problem.grid.resolution_m;
  const double a = pose.angle * problem.grid.angle_step;
  const double r0 = u(0, 0) * x + u(0, 1) * y + u(0, 2) * a;
  const double r1 = u(1, 1) * y + u(1, 2) * a;
  const double r2 = u(2, 2) * a;
  return r0 * r0 + r1 * r1 + r2 * r2;
}

double Score(std::uint32_t sum, std::size_t points) {
  return sum / (255.0 * static_cast<double>(points));
}

// The smallest chi^2 over the box [x0, x1] x [y0, y1] at one angle, in steps; less what rounding
// could make of it, so that it never exceeds Chi2 of a pose in the box.
double SmallestChi2(const SearchProblem& problem, std::int32_t angle, std::int32_t x0,
                    std::int32_t x1, std::int32_t y0, std::int32_t y1) {
  const Eigen::Matrix3d& u = problem.prior_root;
  const double resolution = problem.grid.resolution_m;
  const double a = angle * problem.grid.angle_step;
  const double low_x = x0 * resolution;
  const double high_x = x1 * resolution;
  const double low_y = y0 * resolution;
  const double high_y = y1 * resolution;
  const auto residual0 = [&](double x, double y) {
    return u(0, 0) * x + u(0, 1) * y + u(0, 2) * a;
  };
  const auto residual1 = [&](double y) { return u(1, 1) * y + u(1, 2) * a; };

  // Where |residual1| is smallest; there residual0 vanishes for some x of the box, or it does not
  // and the minimum lies on the nearer of the box's two edges in x.
  double y = u(1, 1) > 0.0 ? std::clamp(-u(1, 2) * a / u(1, 1), low_y, high_y) : low_y;
  double r0 = 0.0;
  const double at_low = residual0(low_x, y);
  const double at_high = residual0(high_x, y);  // not less than at_low, since U00 >= 0
  if (at_low > 0.0 || at_high < 0.0) {
    const double x = at_low > 0.0 ? low_x : high_x;
    const double norm2 = u(0, 1) * u(0, 1) + u(1, 1) * u(1, 1);
    if (norm2 > 0.0) {
      const double best = -(u(0, 1) * (u(0, 0) * x + u(0, 2) * a) + u(1, 1) * u(1, 2) * a) / norm2;
      y = std::clamp(best, low_y, high_y);
    }
    r0 = residual0(x, y);
  }
  const double r1 = residual1(y);
  const double r2 = u(2, 2) * a;
  const double chi2 = r0 * r0 + r1 * r1 + r2 * r2;
  // Residuals are sums of three products: relative to the largest terms their rounding is below
  // 1e-15, that of the position of the minimum enters squared.
  const double size_x = std::max(std::abs(low_x), std::abs(high_x));
  const double size_y = std::max(std::abs(low_y), std::abs(high_y));
  const double terms0 =
      std::abs(u(0, 0)) * size_x + std::abs(u(0, 1)) * size_y + std::abs(u(0, 2) * a);
  const double terms1 = std::abs(u(1, 1)) * size_y + std::abs(u(1, 2) * a);
  const double slack = 1e-13 * (terms0 * terms0 + terms1 * terms1 + r2 * r2);
  return std::max(0.0, chi2 - slack);
}

// The points of a problem rotated by each angle of its grid, and binned at each level when first
// asked for.
class RotatedPoints {
 public:
  explicit RotatedPoints(const SearchProblem& problem)
      : problem_(problem),
        levels_(static_cast<std::size_t>(problem.table->levels())),
        binned_((static_cast<std::size_t>(problem.grid.half_angle) * 2 + 1) * levels_) {}

  const std::vector<BinnedPoint>& At(std::int32_t angle, int level) {
    const std::size_t slice = static_cast<std::size_t>(angle + problem_.grid.half_angle) * levels_;
    std::vector<BinnedPoint>& binned = binned_[slice + static_cast<std::size_t>(level)];
    if (binned.empty()) {
      std::vector<BinnedPoint>& finest = binned_[slice];
      if (finest.empty()) Rotate(angle, &finest);
      if (level > 0) Bin(finest, level, &binned);
    }
    return binned;
  }

 private:
  void Rotate(std::int32_t angle, std::vector<BinnedPoint>* cells) const {
    const LookupTable& table = *problem_.table;
    const Pose2 pose = problem_.grid.At({angle, 0, 0});
    const double c = std::cos(pose.theta);
    const double s = std::sin(pose.theta);
    const LookupTable::Level& level = table.level(0);
    cells->reserve(problem_.points_in_query->size());
    for (const Eigen::Vector2d& point : *problem_.points_in_query) {
      const TableCell cell = table.CellAt(pose.x + c * point.x() - s * point.y(),
                                          pose.y + s * point.x() + c * point.y());
      cells->push_back({cell.x - level.x0, cell.y - level.y0, 1});
    }
  }

  // Level 0 begins on a cell of every level, so positions relative to it may be shifted.
  static void Bin(const std::vector<BinnedPoint>& cells, int level,
                  std::vector<BinnedPoint>* binned) {
    binned->reserve(cells.size());
    for (const BinnedPoint& cell : cells) {
      const std::int32_t x = cell.x >> level;
      const std::int32_t y = cell.y >> level;
      // Points come in the order of beams, so those of one cell mostly follow each other.
      if (!binned->empty() && binned->back().x == x && binned->back().y == y &&
          binned->back().count < kMaxCount) {
        ++binned->back().count;
      } else {
        binned->push_back({x, y, 1});
      }
    }
  }

  const SearchProblem& problem_;
  std::size_t levels_;
  std::vector<std::vector<BinnedPoint>> binned_;
};

// Sums of the table over the points, for the kBlock x kBlock offsets from (x, y) on, at one level.
Sums SumBlock(const LookupTable::Level& level, const std::vector<BinnedPoint>& points,
              std::int32_t x, std::int32_t y) {
  static_assert(LookupTable::kPadding >= kBlock, "blocks are read past the table's end");
  Sums sums{};
  std::array<std::array<std::uint16_t, kBlock>, kBlock> part{};
  std::uint32_t weight = 0;
  const auto flush = [&] {
    for (int row = 0; row < kBlock; ++row) {
      for (int column = 0; column < kBlock; ++column) {
        sums[row][column] += part[row][column];
        part[row][column] = 0;
      }
    }
    weight = 0;
  };
  const auto end_x = static_cast<std::uint32_t>(level.width + kBlock);
  const auto end_y = static_cast<std::uint32_t>(level.height + kBlock);
  for (const BinnedPoint& point : points) {
    const std::int32_t left = point.x + x;
    const std::int32_t bottom = point.y + y;
    if (static_cast<std::uint32_t>(left + kBlock) >= end_x) continue;
    if (static_cast<std::uint32_t>(bottom + kBlock) >= end_y) continue;
    if (weight + point.count > kMaxWeight) flush();
    weight += point.count;
    const auto count = static_cast<std::uint16_t>(point.count);
    const std::uint8_t* from = level.data + bottom * level.stride + left;
    for (int row = 0; row < kBlock; ++row, from += level.stride) {
      for (int column = 0; column < kBlock; ++column) {
        part[row][column] = static_cast<std::uint16_t>(part[row][column] + count * from[column]);
      }
    }
  }
  flush();
  return sums;
}

// Offsets [x 2^level, (x + 1) 2^level) x the same for y, at one angle of one problem.
struct Block {
  double bound;
  std::int32_t problem;
  std::int32_t level;
  GridPose pose;
};

struct IsWorse {
  bool operator()(const Block& a, const Block& b) const {
    if (a.bound != b.bound) return a.bound < b.bound;
    if (a.problem != b.problem) return a.problem > b.problem;
    if (a.level != b.level) return a.level > b.level;
    if (a.pose.angle != b.pose.angle) return a.pose.angle > b.pose.angle;
    if (a.pose.x != b.pose.x) return a.pose.x > b.pose.x;
    return a.pose.y > b.pose.y;
  }
};

bool IsBefore(const GridPose& a, const GridPose& b) {
  if (a.angle != b.angle) return a.angle < b.angle;
  if (a.x != b.x) return a.x < b.x;
  return a.y < b.y;
}

void Offer(const SearchProblem& problem, const GridPose& pose, double score, SearchResult* result) {
  const double objective = score - problem.prior_weight * Chi2(problem, pose);
  if (result->found && (objective < result->objective ||
                        (objective == result->objective && !IsBefore(pose, result->best)))) {
    return;
  }
  *result = {true, pose, score, objective};
}

using Queue = std::priority_queue<Block, std::vector<Block>, IsWorse>;

class Search {
 public:
  Search(const SearchProblem& problem, std::int32_t index)
      : problem_(problem), index_(index), points_(problem) {
    result_.objective = kUnset;
  }

  void PushRoots(Queue* queue) {
    if (problem_.points_in_query->empty()) return;
    const SearchGrid& grid = problem_.grid;
    const int level = problem_.table->levels() - 1;
    for (std::int32_t angle = -grid.half_angle; angle <= grid.half_angle; ++angle) {
      for (std::int32_t y = -grid.half_y >> level; y <= grid.half_y >> level; y += kBlock) {
        for (std::int32_t x = -grid.half_x >> level; x <= grid.half_x >> level; x += kBlock) {
          Evaluate(level, {angle, x, y}, kBlock, queue);
        }
      }
    }
  }

  void Expand(const Block& block, Queue* queue) {
    if (block.bound < result_.objective) return;
    Evaluate(block.level - 1, {block.pose.angle, 2 * block.pose.x, 2 * block.pose.y}, 2, queue);
  }

  SearchResult Result() const {
    SearchResult result = result_;
    if (!result.found) {
      result.objective = 0.0;
      result.score = best_dropped_;
    }
    return result;
  }

 private:
  // Sums up the `size` x `size` blocks of a level from `first` on; those that may hold the answer
  // go to the queue, or at level 0 become the answer so far.
  void Evaluate(int level, const GridPose& first, int size, Queue* queue) {
    const SearchGrid& grid = problem_.grid;
    const std::size_t count = problem_.points_in_query->size();
    const Sums sums =
        SumBlock(problem_.table->level(level), points_.At(first.angle, level), first.x, first.y);
    const std::int32_t span = 1 << level;
    for (int row = 0; row < size; ++row) {
      const std::int32_t y0 = std::max((first.y + row) * span, -grid.half_y);
      const std::int32_t y1 = std::min((first.y + row) * span + span - 1, grid.half_y);
      if (y0 > y1) continue;
      for (int column = 0; column < size; ++column) {
        const std::int32_t x0 = std::max((first.x + column) * span, -grid.half_x);
        const std::int32_t x1 = std::min((first.x + column) * span + span - 1, grid.half_x);
        if (x0 > x1) continue;
        const double score = Score(sums[row][column], count);
        if (score < problem_.min_score) {
          best_dropped_ = std::max(best_dropped_, score);
          continue;
        }
        if (score < result_.objective) continue;
        const GridPose pose{first.angle, first.x + column, first.y + row};
        if (level == 0) {
          Offer(problem_, pose, score, &result_);
          continue;
        }
        const double chi2 = SmallestChi2(problem_, first.angle, x0, x1, y0, y1);
        const double bound = score - problem_.prior_weight * chi2;
        if (bound >= result_.objective) queue->push({bound, index_, level, pose});
      }
    }
  }

  const SearchProblem& problem_;
  std::int32_t index_;
  RotatedPoints points_;
  SearchResult result_;
  double best_dropped_ = 0.0;
};

}  // namespace

std::vector<SearchResult> SearchJointly(const std::vector<SearchProblem>& problems) {
  std::vector<std::unique_ptr<Search>> searches;
  Queue queue;
  for (const SearchProblem& problem : problems) {
    searches.push_back(
        std::make_unique<Search>(problem, static_cast<std::int32_t>(searches.size())));
    searches.back()->PushRoots(&queue);
  }
  while (!queue.empty()) {
    const Block block = queue.top();
    queue.pop();
    searches[static_cast<std::size_t>(block.problem)]->Expand(block, &queue);
  }
  std::vector<SearchResult> results;
  for (const std::unique_ptr<Search>& search : searches) results.push_back(search->Result());
  return results;
}

SearchResult SearchExhaustively(const SearchProblem& problem) {
  SearchResult result;
  const SearchGrid& grid = problem.grid;
  const LookupTable& table = *problem.table;
  const std::size_t count = problem.points_in_query->size();
  if (count == 0) return result;
  double best_dropped = 0.0;
  for (std::int32_t angle = -grid.half_angle; angle <= grid.half_angle; ++angle) {
    const Pose2 pose = grid.At({angle, 0, 0});
    const double c = std::cos(pose.theta);
    const double s = std::sin(pose.theta);
    std::vector<TableCell> cells;
    for (const Eigen::Vector2d& point : *problem.points_in_query) {
      cells.push_back(table.CellAt(pose.x + c * point.x() - s * point.y(),
                                   pose.y + s * point.x() + c * point.y()));
    }
    for (std::int32_t x = -grid.half_x; x <= grid.half_x; ++x) {
      for (std::int32_t y = -grid.half_y; y <= grid.half_y; ++y) {
        std::uint32_t sum = 0;
        for (const TableCell& cell : cells) sum += table.Value(0, {cell.x + x, cell.y + y});
        const double score = Score(sum, count);
        if (score < problem.min_score) {
          best_dropped = std::max(best_dropped, score);
        } else {
          Offer(problem, {angle, x, y}, score, &result);
        }
      }
    }
  }
  if (!result.found) result.score = best_dropped;
  return result;
}

Eigen::Matrix3d PriorRoot(const Eigen::Matrix3d& covariance, const SearchGrid& grid) {
  if (!covariance.allFinite()) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d widened = 0.5 * (covariance + covariance.transpose());
  const double cell = grid.resolution_m * grid.resolution_m / 12.0;
  const double angle = grid.angle_step * grid.angle_step / 12.0;
  widened.diagonal() += Eigen::Vector3d(cell, cell, angle);
  // chi^2 = d^T Sigma^-1 d with Sigma = V V^T, V upper triangular: then U = V^-1 is upper
  // triangular too. V comes from the Cholesky factor of Sigma with its axes reversed.
  const Eigen::Matrix3d reversed = widened.colwise().reverse().rowwise().reverse();
  const Eigen::LLT<Eigen::Matrix3d> factor(reversed);
  if (factor.info() != Eigen::Success) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d inverse =
      factor.matrixL().solve(Eigen::Matrix3d::Identity());  // lower triangular
  const Eigen::Matrix3d root = inverse.colwise().reverse().rowwise().reverse();
  return root.allFinite() ? root : Eigen::Matrix3d::Zero();
}

std::vector<Eigen::Vector2d> ThinPoints(const ScanPoints& points, double spacing_m,
                                        double max_range_m) {
  std::vector<Eigen::Vector2d> thinned;
  std::vector<double> counts;
  std::unordered_map<std::int64_t, std::size_t> index_of_cell;  // looked up only, never walked
  index_of_cell.reserve(points.size());
  for (const pcl::PointXY& point : points) {
    const Eigen::Vector2d position(point.x, point.y);
    if (!(position.norm() <= max_range_m)) continue;
    if (!(spacing_m > 0.0)) {
      thinned.push_back(position);
      counts.push_back(1.0);
      continue;
    }
    const auto x = static_cast<std::int64_t>(std::floor(position.x() / spacing_m));
    const auto y = static_cast<std::int64_t>(std::floor(position.y() / spacing_m));
    const auto [cell, is_new] =
        index_of_cell.try_emplace(x * (std::int64_t{1} << 32) + y, thinned.size());
    if (is_new) {
      thinned.push_back(position);
      counts.push_back(1.0);
    } else {
      thinned[cell->second] += position;
      counts[cell->second] += 1.0;
    }
  }
  for (std::size_t i = 0; i < thinned.size(); ++i) thinned[i] /= counts[i];
  return thinned;
}

}  // namespace masked_mapper
