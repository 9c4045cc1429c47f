// SPDX-License-Identifier: BSD-3-Clause
#include "segment_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

constexpr double kCell = 1.0;       // m, about a door
constexpr double kMaxCells = 4e6;   // the cell grows rather than the memory
constexpr double kBoxSlack = 1e-6;  // m, so that rounding never loses a segment between cells

/// Whether a segment passes through the square of half-width `half` around `centre`.
bool Touches(const Segment& segment, const Eigen::Vector2d& centre, double half) {
  const Eigen::Vector2d a = segment.a - centre;
  const Eigen::Vector2d b = segment.b - centre;
  if (std::min(a.x(), b.x()) > half || std::max(a.x(), b.x()) < -half) return false;
  if (std::min(a.y(), b.y()) > half || std::max(a.y(), b.y()) < -half) return false;
  // Separating axis: the segment's normal.
  const Eigen::Vector2d normal(a.y() - b.y(), b.x() - a.x());
  return std::abs(normal.dot(a)) <= half * (std::abs(normal.x()) + std::abs(normal.y())) + 1e-12;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double DistanceBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Segment& other) {
  const double side_a = Cross(other.b - other.a, a - other.a);
  const double side_b = Cross(other.b - other.a, b - other.a);
  const double side_c = Cross(b - a, other.a - a);
  const double side_d = Cross(b - a, other.b - a);
  if (side_a * side_b < 0.0 && side_c * side_d < 0.0) return 0.0;
  return std::min({DistanceToSegment(a, other.a, other.b), DistanceToSegment(b, other.a, other.b),
                   DistanceToSegment(other.a, a, b), DistanceToSegment(other.b, a, b)});
}

}  // namespace

SegmentIndex::SegmentIndex(std::vector<Segment> segments) : segments_(std::move(segments)) {
  if (segments_.empty()) {
    cell_begin_ = {0, 0};
    return;
  }
  Eigen::Vector2d high = segments_.front().a;
  low_ = high;
  for (const Segment& segment : segments_) {
    low_ = low_.cwiseMin(segment.a).cwiseMin(segment.b);
    high = high.cwiseMax(segment.a).cwiseMax(segment.b);
  }
  const Eigen::Vector2d size = high - low_;
  cell_ = std::max({kCell, std::sqrt(size.x() * size.y() / kMaxCells),
                    std::max(size.x(), size.y()) / kMaxCells});
  columns_ = static_cast<std::size_t>(size.x() / cell_) + 1;
  rows_ = static_cast<std::size_t>(size.y() / cell_) + 1;

  const auto for_each_cell = [&](std::size_t index, auto&& action) {
    const Segment& segment = segments_[index];
    const std::size_t first_column = Column(std::min(segment.a.x(), segment.b.x()) - kBoxSlack);
    const std::size_t last_column = Column(std::max(segment.a.x(), segment.b.x()) + kBoxSlack);
    const std::size_t first_row = Row(std::min(segment.a.y(), segment.b.y()) - kBoxSlack);
    const std::size_t last_row = Row(std::max(segment.a.y(), segment.b.y()) + kBoxSlack);
    for (std::size_t row = first_row; row <= last_row; ++row) {
      for (std::size_t column = first_column; column <= last_column; ++column) {
        const Eigen::Vector2d centre =
            low_ + cell_ * Eigen::Vector2d(static_cast<double>(column) + 0.5,
                                           static_cast<double>(row) + 0.5);
        if (Touches(segment, centre, 0.5 * cell_ + kBoxSlack)) action(row * columns_ + column);
      }
    }
  };
  cell_begin_.assign(columns_ * rows_ + 1, 0);
  for (std::size_t index = 0; index < segments_.size(); ++index) {
    for_each_cell(index, [&](std::size_t cell) { ++cell_begin_[cell + 1]; });
  }
  for (std::size_t cell = 1; cell < cell_begin_.size(); ++cell) {
    cell_begin_[cell] += cell_begin_[cell - 1];
  }
  cell_segments_.resize(cell_begin_.back());
  std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (std::size_t index = 0; index < segments_.size(); ++index) {
    for_each_cell(index, [&](std::size_t cell) {
      cell_segments_[next[cell]++] = static_cast<std::uint32_t>(index);
    });
  }
}

std::size_t SegmentIndex::Column(double x) const {
  const double column = std::floor((x - low_.x()) / cell_);
  return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t SegmentIndex::Row(double y) const {
  const double row = std::floor((y - low_.y()) / cell_);
  return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows_ - 1)));
}

bool SegmentIndex::ClipToGrid(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                              double& enter, double& leave) const {
  const double extent[2] = {cell_ * static_cast<double>(columns_),
                            cell_ * static_cast<double>(rows_)};
  for (int axis = 0; axis < 2; ++axis) {
    const double offset = low_[axis] - origin[axis];
    if (direction[axis] == 0.0) {
      if (offset > kBoxSlack || offset + extent[axis] < -kBoxSlack) return false;
      continue;
    }
    const double t0 = (offset - kBoxSlack) / direction[axis];
    const double t1 = (offset + extent[axis] + kBoxSlack) / direction[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave;
}

bool SegmentIndex::NearestInCell(std::size_t cell, const Eigen::Vector2d& origin,
                                 const Eigen::Vector2d& direction, double min_range, bool found,
                                 Hit& best) const {
  for (std::uint32_t k = cell_begin_[cell]; k < cell_begin_[cell + 1]; ++k) {
    const std::uint32_t index = cell_segments_[k];
    const std::optional<double> range = RayRange(origin, direction, segments_[index], min_range);
    if (!range) continue;
    if (*range < best.range || (found && *range == best.range && index < best.segment)) {
      best = {*range, index};
      found = true;
    }
  }
  return found;
}

std::optional<SegmentIndex::Hit> SegmentIndex::Cast(const Eigen::Vector2d& origin,
                                                    const Eigen::Vector2d& direction,
                                                    double min_range, double max_range) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // The part of the ray that lies over the grid.
  double enter = min_range;
  double leave = max_range;
  if (!ClipToGrid(origin, direction, enter, leave)) return std::nullopt;

  const Eigen::Vector2d start = origin + enter * direction;
  auto column = static_cast<std::ptrdiff_t>(Column(start.x()));
  auto row = static_cast<std::ptrdiff_t>(Row(start.y()));
  const auto next_border = [&](int axis, std::ptrdiff_t index) {
    if (direction[axis] == 0.0) return kInfinity;
    const double border =
        low_[axis] + cell_ * static_cast<double>(direction[axis] > 0.0 ? index + 1 : index);
    return (border - origin[axis]) / direction[axis];
  };
  double border_x = next_border(0, column);
  double border_y = next_border(1, row);

  Hit best{max_range, 0};
  bool found = false;
  while (true) {
    const std::size_t cell =
        static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
    found = NearestInCell(cell, origin, direction, min_range, found, best);
    const double border = std::min(border_x, border_y);
    if (found && best.range <= border) break;
    if (border >= leave) break;
    if (border_x < border_y) {
      column += direction.x() > 0.0 ? 1 : -1;
      if (column < 0 || column >= static_cast<std::ptrdiff_t>(columns_)) break;
      border_x = next_border(0, column);
    } else {
      row += direction.y() > 0.0 ? 1 : -1;
      if (row < 0 || row >= static_cast<std::ptrdiff_t>(rows_)) break;
      border_y = next_border(1, row);
    }
  }
  if (!found) return std::nullopt;
  return best;
}

double SegmentIndex::Clearance(const Eigen::Vector2d& point, double limit) const {
  return Clearance(point, point, limit);
}

double SegmentIndex::Clearance(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                               double limit) const {
  double clearance = limit;
  const std::size_t first_column = Column(std::min(a.x(), b.x()) - limit);
  const std::size_t last_column = Column(std::max(a.x(), b.x()) + limit);
  const std::size_t first_row = Row(std::min(a.y(), b.y()) - limit);
  const std::size_t last_row = Row(std::max(a.y(), b.y()) + limit);
  const Segment way{a, b, Surface::kWall};
  for (std::size_t row = first_row; row <= last_row; ++row) {
    for (std::size_t column = first_column; column <= last_column; ++column) {
      const Eigen::Vector2d centre =
          low_ + cell_ * Eigen::Vector2d(static_cast<double>(column) + 0.5,
                                         static_cast<double>(row) + 0.5);
      if (!Touches(way, centre, 0.5 * cell_ + limit)) continue;
      const std::size_t cell = row * columns_ + column;
      for (std::uint32_t k = cell_begin_[cell]; k < cell_begin_[cell + 1]; ++k) {
        clearance = std::min(clearance, DistanceBetween(a, b, segments_[cell_segments_[k]]));
      }
    }
  }
  return clearance;
}

}  // namespace masked_mapper
