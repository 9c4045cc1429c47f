// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// x of the line through a and b at a height between theirs.
double CrossingAt(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
  return a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y());
}

}  // namespace

bool IsInsidePolygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& point) {
  bool is_inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < CrossingAt(a, b, point.y())) is_inside = !is_inside;
  }
  return is_inside;
}

void ForEachCellInside(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& origin,
                       double resolution_m, int width, int height,
                       const std::function<void(std::size_t)>& visit) {
  // Of each row the sides that its middle crosses: between the first and the second is inside.
  std::vector<double> crossings;
  for (int row = 0; row < height; ++row) {
    const double y = origin.y() + (row + 0.5) * resolution_m;
    crossings.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d& a = corners[i];
      const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
      if ((a.y() > y) != (b.y() > y)) crossings.push_back(CrossingAt(a, b, y));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto first_from = [&](double x) {
        const double column = std::ceil((x - origin.x()) / resolution_m - 0.5);
        return static_cast<int>(std::clamp(column, 0.0, static_cast<double>(width)));
      };
      const int end = first_from(crossings[i + 1]);
      for (int column = first_from(crossings[i]); column < end; ++column) {
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(column));
      }
    }
  }
}

}  // namespace masked_mapper
