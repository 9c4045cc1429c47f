// SPDX-License-Identifier: BSD-3-Clause
#include "correlative_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "block_queue.hpp"
#include "prior_chi2.hpp"

namespace masked_mapper {
namespace {

constexpr double kUnset = -1e300;
// Measured: 4 x 4 children share the reading of a point's row, and skip a level of the queue.
constexpr int kLevelsPerStep = 2;

double Score(std::uint32_t sum, std::size_t points) {
  return sum / (255.0 * static_cast<double>(points));
}

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

// Whether all offsets from (x, y) to (x + span - 1, y + span - 1) lie in the box.
bool Contains(const GridBox& box, std::int32_t angle, std::int32_t x, std::int32_t y,
              std::int32_t span) {
  return std::abs(angle - box.centre.angle) <= box.half_angle && x >= box.centre.x - box.half_x &&
         x + span - 1 <= box.centre.x + box.half_x && y >= box.centre.y - box.half_y &&
         y + span - 1 <= box.centre.y + box.half_y;
}

// The search of one problem; its blocks wait in a queue that all problems share.
class Search {
 public:
  Search(const SearchProblem& problem, std::int32_t index)
      : problem_(problem),
        index_(index),
        count_(problem.points_in_query->size()),
        sums_(*problem.table, *problem.points_in_query, problem.grid) {
    result_.objective = kUnset;
    if (count_ > 0) RaiseNeeded(problem.min_score);
  }

  void AddRoots(BlockQueue* queue) {
    if (count_ == 0) return;
    const SearchGrid& grid = problem_.grid;
    const int level = problem_.table->levels() - 1;
    for (std::int32_t angle = -grid.half_angle; angle <= grid.half_angle; ++angle) {
      for (std::int32_t y = -grid.half_y >> level; y <= grid.half_y >> level; y += kSize) {
        for (std::int32_t x = -grid.half_x >> level; x <= grid.half_x >> level; x += kSize) {
          Evaluate(level, {angle, x, y}, kSize, queue);
        }
      }
    }
  }

  // Whether the answer is known.
  bool IsDone() const { return waiting_ == 0; }

  // Replaces a block by the blocks within it that may hold the answer. Blocks come best first.
  void Expand(const GridBlock& block, BlockQueue* queue) {
    --waiting_;
    if (BlockQueue::IsBelow(block.bound, result_.objective)) waiting_ = 0;
    if (block.bound < result_.objective) return;
    const int level = std::max(block.level - kLevelsPerStep, 0);
    const int size = 1 << (block.level - level);
    Evaluate(level, {block.pose.angle, block.pose.x * size, block.pose.y * size}, size, queue);
  }

  SearchResult Result() const {
    SearchResult result = result_;
    if (!result.found) {
      result.objective = 0.0;
      result.score = count_ > 0 ? Score(largest_dropped_, count_) : 0.0;
    }
    return result;
  }

 private:
  static constexpr int kSize = BlockSums::kSize;

  // Looks at `size` x `size` blocks of a level from `first` on. Those that may hold the answer are
  // appended; at level 0 the best becomes the answer so far.
  void Evaluate(int level, const GridPose& first, int size, BlockQueue* queue) {
    const SearchGrid& grid = problem_.grid;
    const std::int32_t columns = std::min(size, (grid.half_x >> level) - first.x + 1);
    const std::int32_t rows = std::min(size, (grid.half_y >> level) - first.y + 1);
    const std::int32_t first_column = std::max(0, (-grid.half_x >> level) - first.x);
    const std::int32_t first_row = std::max(0, (-grid.half_y >> level) - first.y);
    const BlockSums::Sums sums = sums_.At(first.angle, level, first.x, first.y, size);
    for (std::int32_t row = first_row; row < rows; ++row) {
      for (std::int32_t column = first_column; column < columns; ++column) {
        const std::uint32_t sum =
            sums[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        if (sum < needed_) {
          if (!result_.found) largest_dropped_ = std::max(largest_dropped_, sum);
          continue;
        }
        Consider(level, {first.angle, first.x + column, first.y + row}, Score(sum, count_), queue);
      }
    }
  }

  void Consider(int level, const GridPose& pose, double score, BlockQueue* queue) {
    const std::int32_t span = 1 << level;
    if (Contains(problem_.left_out, pose.angle, pose.x * span, pose.y * span, span)) return;
    if (level == 0) {
      Offer(problem_, pose, score, &result_);
      RaiseNeeded(result_.objective);
      return;
    }
    const SearchGrid& grid = problem_.grid;
    const double chi2 = SmallestChi2(problem_, pose.angle, std::max(pose.x * span, -grid.half_x),
                                     std::min(pose.x * span + span - 1, grid.half_x),
                                     std::max(pose.y * span, -grid.half_y),
                                     std::min(pose.y * span + span - 1, grid.half_y));
    const double bound = score - problem_.prior_weight * chi2;
    if (bound >= result_.objective) {
      queue->Push({bound, index_, level, pose});
      ++waiting_;
    }
  }

  // From now on sums are needed whose score reaches `score`: exactly those from needed_ on.
  void RaiseNeeded(double score) {
    const double sum = std::ceil(score * 255.0 * static_cast<double>(count_));
    if (!(sum > needed_)) return;
    needed_ = static_cast<std::uint32_t>(std::min(sum, 4294967295.0));
    while (needed_ > 0 && Score(needed_ - 1, count_) >= score) --needed_;
    while (Score(needed_, count_) < score && needed_ < 4294967295U) ++needed_;
  }

  const SearchProblem& problem_;
  std::int32_t index_;
  std::size_t count_;
  BlockSums sums_;
  SearchResult result_;
  std::uint32_t needed_ = 0;
  std::uint32_t largest_dropped_ = 0;
  std::size_t waiting_ = 0;  // blocks in the queue
};

}  // namespace

std::vector<SearchResult> SearchJointly(const std::vector<SearchProblem>& problems) {
  std::vector<std::unique_ptr<Search>> searches;
  BlockQueue queue;
  std::size_t unanswered = 0;
  for (const SearchProblem& problem : problems) {
    searches.push_back(
        std::make_unique<Search>(problem, static_cast<std::int32_t>(searches.size())));
    searches.back()->AddRoots(&queue);
    unanswered += searches.back()->IsDone() ? 0U : 1U;
  }
  while (unanswered > 0) {
    const GridBlock block = queue.Pop();
    Search& search = *searches[static_cast<std::size_t>(block.problem)];
    if (search.IsDone()) continue;
    search.Expand(block, &queue);
    if (search.IsDone()) --unanswered;
  }
  std::vector<SearchResult> results;
  for (const std::unique_ptr<Search>& search : searches) results.push_back(search->Result());
  return results;
}

SearchResult SearchExhaustively(const SearchProblem& problem) {
  SearchResult result;
  const SearchGrid& grid = problem.grid;
  const LookupTable& table = *problem.table;
  const LookupTable::Level& cells = table.level(0);
  const std::size_t count = problem.points_in_query->size();
  if (count == 0) return result;
  double best_dropped = 0.0;
  std::vector<std::int32_t> cells_x(count);
  std::vector<std::int32_t> cells_y(count);
  for (std::int32_t angle = -grid.half_angle; angle <= grid.half_angle; ++angle) {
    Pose2 pose = grid.T_reference_query_guess;
    pose.theta += angle * grid.angle_step;
    CellsAtPose(table, *problem.points_in_query, pose, cells_x.data(), cells_y.data());
    for (std::int32_t x = -grid.half_x; x <= grid.half_x; ++x) {
      for (std::int32_t y = -grid.half_y; y <= grid.half_y; ++y) {
        if (Contains(problem.left_out, angle, x, y, 1)) continue;
        std::uint32_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const std::int32_t column = cells_x[i] + x;
          const std::int32_t row = cells_y[i] + y;
          if (column < 0 || row < 0 || column >= cells.width || row >= cells.height) continue;
          sum += cells.data[row * cells.stride + column];
        }
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

Pose2 PoseOf(const SearchGrid& grid, const GridPose& pose) {
  const Pose2& guess = grid.T_reference_query_guess;
  return {guess.x + pose.x * grid.resolution_m, guess.y + pose.y * grid.resolution_m,
          WrapAngle(guess.theta + pose.angle * grid.angle_step)};
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

}  // namespace masked_mapper
