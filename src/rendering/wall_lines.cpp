// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/wall_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// Sums over points that tell their line of least squared distances.
class LineSums {
 public:
  void Add(const Eigen::Vector2d& point) {
    if (count_ == 0) reference_ = point;
    const Eigen::Vector2d off = point - reference_;
    ++count_;
    sum_ += off;
    squares_ += off * off.transpose();
  }

  std::size_t count() const { return count_; }
  Eigen::Vector2d Centre() const { return reference_ + sum_ / static_cast<double>(count_); }

  /// Angle of the line, and how much longer than wide the points lie (0: round, 1: on a line).
  std::pair<double, double> Direction() const {
    const auto n = static_cast<double>(count_);
    const Eigen::Matrix2d covariance = squares_ / n - sum_ * sum_.transpose() / (n * n);
    const double difference = covariance(0, 0) - covariance(1, 1);
    const double spread = std::hypot(difference, 2.0 * covariance(0, 1));
    const double trace = covariance.trace();
    return {0.5 * std::atan2(2.0 * covariance(0, 1), difference),
            trace > 0.0 ? spread / trace : 0.0};
  }

 private:
  std::size_t count_ = 0;
  Eigen::Vector2d reference_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares_ = Eigen::Matrix2d::Zero();
};

/// Of two lines without a sense of direction, 0 to pi/2.
double AngleBetween(double a, double b) { return std::abs(std::remainder(a - b, M_PI)); }

Eigen::Vector2d AlongOf(double angle) { return {std::cos(angle), std::sin(angle)}; }
Eigen::Vector2d AcrossOf(double angle) { return {-std::sin(angle), std::cos(angle)}; }

class LineFitter {
 public:
  LineFitter(const WallCells& walls, const WallLineOptions& options)
      : walls_(walls), options_(options) {
    points_.reserve(walls.points.size());
    for (const WallPoint& point : walls.points) points_.emplace_back(point.x, point.y);
    is_used_.assign(points_.size(), 0);
    std::size_t wall = 0;
    for (int row = 0; row <= walls.height; ++row) {
      while (wall < walls.cells.size() && walls.cells[wall] < CellAt(0, row)) ++wall;
      row_begins_.push_back(wall);
    }
  }

  std::vector<WallLine> Fit() {
    TellDirections();
    std::vector<std::size_t> seeds(points_.size());
    std::iota(seeds.begin(), seeds.end(), 0);
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
      return straightness_[a] > straightness_[b];
    });
    for (const std::size_t seed : seeds) {
      if (is_used_[seed] == 0 && straightness_[seed] > 0.0) Grow(seed);
    }
    MeetAtCorners();
    return std::move(lines_);
  }

 private:
  std::size_t CellAt(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(walls_.width) +
           static_cast<std::size_t>(column);
  }

  /// Row by row.
  template <typename Visit>
  void ForEachNear(std::size_t wall, double reach_m, const Visit& visit) const {
    const int reach = static_cast<int>(std::ceil(reach_m / walls_.resolution_m));
    const auto width = static_cast<std::size_t>(walls_.width);
    const int column = static_cast<int>(walls_.cells[wall] % width);
    const int row = static_cast<int>(walls_.cells[wall] / width);
    const int first_column = std::max(0, column - reach);
    const int last_column = std::min(walls_.width - 1, column + reach);
    for (int r = std::max(0, row - reach); r <= std::min(walls_.height - 1, row + reach); ++r) {
      const auto at = [&](std::size_t index) {
        return walls_.cells.begin() + static_cast<std::ptrdiff_t>(index);
      };
      const auto end = at(row_begins_[static_cast<std::size_t>(r) + 1]);
      const std::size_t last = CellAt(last_column, r);
      for (auto near = std::lower_bound(at(row_begins_[static_cast<std::size_t>(r)]), end,
                                        CellAt(first_column, r));
           near != end && *near <= last; ++near) {
        const auto other = static_cast<std::size_t>(near - walls_.cells.begin());
        if ((points_[other] - points_[wall]).norm() <= reach_m) visit(other);
      }
    }
  }

  void TellDirections() {
    angle_.resize(points_.size());
    straightness_.resize(points_.size());
    const double reach = std::max(options_.neighbourhood_m, 2.0 * walls_.resolution_m);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      LineSums sums;
      ForEachNear(i, reach, [&](std::size_t other) { sums.Add(points_[other]); });
      std::tie(angle_[i], straightness_[i]) = sums.Direction();
      if (sums.count() < 3) straightness_[i] = 0.0;
    }
  }

  /// From a seed along its line, which is fitted anew as it grows.
  void Grow(std::size_t seed) {
    constexpr double kSameWall = 0.35;  // rad: directions of single points are rough
    LineSums sums;
    double angle = angle_[seed];
    std::vector<std::size_t> region = {seed};
    is_used_[seed] = 1;
    sums.Add(points_[seed]);
    const double reach = std::max(0.15, 2.9 * walls_.resolution_m);
    for (std::size_t i = 0; i < region.size(); ++i) {
      ForEachNear(region[i], reach, [&](std::size_t other) {
        if (is_used_[other] != 0 || AngleBetween(angle_[other], angle) > kSameWall) return;
        const double off = AcrossOf(angle).dot(points_[other] - sums.Centre());
        if (std::abs(off) > options_.tolerance_m) return;
        is_used_[other] = 1;
        region.push_back(other);
        sums.Add(points_[other]);
        // A few points say less of the direction than the neighbourhood of the seed did.
        if (sums.count() >= 8) angle = sums.Direction().first;
      });
    }
    if (region.size() < 3) return;
    Split(region, sums, angle);
  }

  void Split(const std::vector<std::size_t>& region, const LineSums& sums, double angle) {
    const Eigen::Vector2d along = AlongOf(angle);
    const Eigen::Vector2d centre = sums.Centre();
    std::vector<std::pair<double, std::size_t>> order;
    for (const std::size_t i : region) order.emplace_back(along.dot(points_[i] - centre), i);
    std::sort(order.begin(), order.end());
    const double largest_gap = std::max(options_.largest_gap_m, 2.5 * walls_.resolution_m);
    for (std::size_t first = 0; first < order.size();) {
      std::size_t end = first + 1;
      while (end < order.size() && order[end].first - order[end - 1].first <= largest_gap) ++end;
      const double from = order[first].first;
      const double to = order[end - 1].first;
      if (end - first >= 3 && to - from >= options_.shortest_m) {
        lines_.push_back({centre + from * along, centre + to * along});
        for (std::size_t i = first; i < end; ++i) Absorb(order[i].second, lines_.back(), angle);
      }
      first = end;
    }
  }

  /// What stands beside a line within its noise is no other wall.
  void Absorb(std::size_t wall, const WallLine& line, double angle) {
    ForEachNear(wall, 2.0 * options_.absorbed_m, [&](std::size_t other) {
      if (is_used_[other] != 0) return;
      const double off = AcrossOf(angle).dot(points_[other] - line.a);
      const double at = AlongOf(angle).dot(points_[other] - line.a);
      const bool is_beside = at >= 0.0 && at <= (line.b - line.a).norm();
      if (is_beside && std::abs(off) <= options_.absorbed_m) is_used_[other] = 1;
    });
  }

  /// Ends that all but meet do. Held against the lines as they were fitted, so that the order of
  /// lines does not matter.
  void MeetAtCorners() {
    const std::vector<WallLine> fitted = lines_;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      const Eigen::Vector2d along = (fitted[i].b - fitted[i].a).normalized();
      for (Eigen::Vector2d WallLine::*end : {&WallLine::a, &WallLine::b}) {
        double nearest = options_.corner_m;
        for (const WallLine& other : fitted) {
          const Eigen::Vector2d other_way = other.b - other.a;
          const Eigen::Vector2d other_along = other_way.normalized();
          const double cross = along.x() * other_along.y() - along.y() * other_along.x();
          if (std::abs(cross) < 0.35) continue;
          const Eigen::Vector2d off = other.a - fitted[i].*end;
          const double move = (off.x() * other_along.y() - off.y() * other_along.x()) / cross;
          if (std::abs(move) >= nearest) continue;
          const Eigen::Vector2d corner = fitted[i].*end + move * along;
          const double at = other_along.dot(corner - other.a);
          if (at < -options_.corner_m || at > other_way.norm() + options_.corner_m) continue;
          nearest = std::abs(move);
          lines_[i].*end = corner;
        }
      }
    }
  }

  const WallCells& walls_;
  const WallLineOptions& options_;
  std::vector<std::size_t> row_begins_;  ///< of each row and of the end: its first wall point
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> angle_;         ///< of the wall around a point
  std::vector<double> straightness_;  ///< 0 to 1; 0: nothing to tell it by
  std::vector<std::uint8_t> is_used_;
  std::vector<WallLine> lines_;
};

constexpr double kQuarter = M_PI / 2.0;
constexpr double kSameDirectionDeg = 1.5;  // more than the width of a bin

/// A long wall tells its direction better, by the square of its length and more of it.
double WeightOf(const WallLine& line) { return (line.b - line.a).squaredNorm(); }

double AngleOf(const WallLine& line) {
  const Eigen::Vector2d way = line.b - line.a;
  return std::atan2(way.y(), way.x());
}

/// Of directions within a quarter turn, the bin that has most.
std::optional<double> PeakOf(const std::vector<WallLine>& lines) {
  constexpr std::size_t kBins = 180;
  std::array<double, kBins> bins{};
  for (const WallLine& line : lines) {
    const double turned = std::remainder(AngleOf(line), kQuarter) / kQuarter + 0.5;
    bins[std::min(kBins - 1, static_cast<std::size_t>(turned * kBins))] += WeightOf(line);
  }
  std::size_t best = 0;
  const auto around = [&](std::size_t bin) {
    return bins[(bin + kBins - 1) % kBins] + bins[bin] + bins[(bin + 1) % kBins];
  };
  for (std::size_t bin = 1; bin < kBins; ++bin) {
    if (around(bin) > around(best)) best = bin;
  }
  if (around(best) <= 0.0) return std::nullopt;
  return ((static_cast<double>(best) + 0.5) / kBins - 0.5) * kQuarter;
}

/// A wall of about the direction that most have.
struct ParallelWall {
  double off = 0.0;  ///< rad
  double weight = 0.0;
};

/// In order of `off`.
std::vector<ParallelWall> ParallelWalls(const std::vector<WallLine>& lines, double angle) {
  std::vector<ParallelWall> walls;
  for (const WallLine& line : lines) {
    const double off = std::remainder(AngleOf(line) - angle, kQuarter);
    if (std::abs(off) > DegToRad(kSameDirectionDeg)) continue;
    walls.push_back({off, WeightOf(line)});
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const ParallelWall& a, const ParallelWall& b) { return a.off < b.off; });
  return walls;
}

double WeightOfAll(const std::vector<ParallelWall>& walls) {
  return std::accumulate(walls.begin(), walls.end(), 0.0,
                         [](double sum, const ParallelWall& wall) { return sum + wall.weight; });
}

/// That of the walls in order, below which this share of their weight lies.
double Quantile(const std::vector<ParallelWall>& walls, double share) {
  double left = share * WeightOfAll(walls);
  for (const ParallelWall& wall : walls) {
    left -= wall.weight;
    if (left <= 0.0) return wall.off;
  }
  return walls.back().off;
}

/// Of their median, as of normally distributed ones whose middle half is as wide.
double SigmaOfMedian(const std::vector<ParallelWall>& walls) {
  constexpr double kFewest = 3.0;  // walls of one weight
  double squares = 0.0;
  for (const ParallelWall& wall : walls) squares += wall.weight * wall.weight;
  const double count = std::pow(WeightOfAll(walls), 2) / squares;
  if (count < kFewest) return std::numeric_limits<double>::infinity();
  const double sigma = (Quantile(walls, 0.75) - Quantile(walls, 0.25)) / 1.349;
  return 1.2533 * sigma / std::sqrt(count);
}

}  // namespace

WallCells WallCellsOf(const OccupancyGrid& grid) {
  WallCells walls{grid.resolution_m, grid.width, grid.height, {}, grid.walls};
  walls.cells.reserve(grid.walls.size());
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    if (grid.cells[cell] == Cell::kOccupied) walls.cells.push_back(cell);
  }
  return walls;
}

std::vector<WallLine> FitWallLines(const WallCells& walls, const WallLineOptions& options) {
  return LineFitter(walls, options).Fit();
}

std::vector<WallLine> FitWallLines(const OccupancyGrid& grid, const WallLineOptions& options) {
  return FitWallLines(WallCellsOf(grid), options);
}

std::optional<WallDirection> DirectionOf(const std::vector<WallLine>& lines) {
  const std::optional<double> peak = PeakOf(lines);
  return peak ? DirectionNear(*peak, lines) : std::nullopt;
}

std::optional<WallDirection> DirectionNear(double angle, const std::vector<WallLine>& lines) {
  const std::vector<ParallelWall> walls = ParallelWalls(lines, angle);
  if (walls.empty()) return std::nullopt;
  WallDirection direction{std::remainder(angle + Quantile(walls, 0.5), kQuarter),
                          SigmaOfMedian(walls)};
  if (direction.angle <= -kQuarter / 2.0) direction.angle += kQuarter;
  return direction;
}

}  // namespace masked_mapper
