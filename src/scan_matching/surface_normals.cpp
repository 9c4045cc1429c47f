// SPDX-License-Identifier: BSD-3-Clause
#include "surface_normals.hpp"

#include <cmath>
#include <cstddef>

#include "masked_mapper/geometry/angle.hpp"

namespace masked_mapper {

std::vector<Eigen::Vector2f> NormalsOf(const ScanPoints& points) {
  constexpr std::ptrdiff_t kMostNeighbours = 8;  // to each side: beams close by tell no more
  constexpr float kReach = 0.15F;                // m, and
  constexpr float kReachPerMetre = 0.04F;        // of range: far beams lie apart
  constexpr float kLeastBase = 0.04F;            // m, below which noise turns the line
  const auto size = static_cast<std::ptrdiff_t>(points.size());
  const auto at = [&](std::ptrdiff_t i) {
    const pcl::PointXY& point = points[static_cast<std::size_t>(i)];
    return Eigen::Vector2f(point.x, point.y);
  };
  std::vector<Eigen::Vector2f> normals;
  normals.reserve(points.size());
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const Eigen::Vector2f point = at(i);
    const float reach = kReach + kReachPerMetre * point.norm();
    const auto is_near = [&](std::ptrdiff_t other) {
      return other >= 0 && other < size && std::abs(other - i) <= kMostNeighbours &&
             (at(other) - point).squaredNorm() <= reach * reach;
    };
    std::ptrdiff_t first = i;
    std::ptrdiff_t last = i;
    while (is_near(first - 1)) --first;
    while (is_near(last + 1)) ++last;
    const Eigen::Vector2f along = at(last) - at(first);
    Eigen::Vector2f normal = -point;
    if (along.squaredNorm() > kLeastBase * kLeastBase) {
      normal = {-along.y(), along.x()};
      if (normal.dot(point) > 0.0F) normal = -normal;
    }
    normals.push_back(normal);
  }
  return normals;
}

double FrontOf(const std::vector<Eigen::Vector2f>& normals_in_robot, double theta) {
  double c = 0.0;
  double s = 0.0;
  for (const Eigen::Vector2f& normal : normals_in_robot) {
    const double angle = 4.0 * (std::atan2(normal.y(), normal.x()) + theta);
    if (!std::isfinite(angle)) continue;
    c += std::cos(angle);
    s += std::sin(angle);
  }
  return 0.25 * (std::atan2(s, c) + kPi);
}

}  // namespace masked_mapper
