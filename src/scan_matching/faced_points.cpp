// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/local_map.hpp"

#include <cmath>
#include <cstdint>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kMostNeighbours = 8;  // to each side: beams close by tell no more
constexpr float kReach = 0.15F;             // m, and
constexpr float kReachPerMetre = 0.04F;     // of range: far beams lie apart
constexpr float kLeastBase = 0.04F;         // m, below which noise turns the line

/// How many neighbours of each point on one side, without a gap, lie on its surface. One distance
/// to the neighbour after another for all points at once, which compilers make vectors of. `step`
/// is 1 for the points behind it, -1 for those before it.
std::vector<std::int32_t> NeighboursOn(const FacedPoints& points,
                                       const std::vector<float>& reach_squared, int step) {
  const std::size_t size = points.size();
  std::vector<std::int32_t> count(size, 0);
  std::vector<std::int32_t> goes_on(size, 1);
  for (std::size_t away = 1; away <= kMostNeighbours && away < size; ++away) {
    const std::size_t pairs = size - away;
    // Of the pair (i, i + away), the one that is asked and the other.
    const std::size_t asked = step > 0 ? 0 : away;
    const float* x = points.x.data();
    const float* y = points.y.data();
    const float* reach = reach_squared.data() + asked;
    std::int32_t* counted = count.data() + asked;
    std::int32_t* going = goes_on.data() + asked;
    for (std::size_t i = 0; i < pairs; ++i) {
      const float dx = x[i + away] - x[i];
      const float dy = y[i + away] - y[i];
      going[i] &= dx * dx + dy * dy <= reach[i] ? 1 : 0;
      counted[i] += going[i];
    }
    // Beyond the first or the last point there is no neighbour.
    for (std::size_t i = pairs; i < size; ++i) goes_on[step > 0 ? i : i - pairs] = 0;
  }
  return count;
}

}  // namespace

FacedPoints::FacedPoints(const ScanPoints& points_in_robot) {
  const std::size_t size = points_in_robot.size();
  x.reserve(size);
  y.reserve(size);
  std::vector<float> reach_squared;
  reach_squared.reserve(size);
  for (const pcl::PointXY& point : points_in_robot) {
    x.push_back(point.x);
    y.push_back(point.y);
    const float reach = kReach + kReachPerMetre * std::sqrt(point.x * point.x + point.y * point.y);
    reach_squared.push_back(reach * reach);
  }
  const std::vector<std::int32_t> before = NeighboursOn(*this, reach_squared, -1);
  const std::vector<std::int32_t> behind = NeighboursOn(*this, reach_squared, 1);
  normal_x.reserve(size);
  normal_y.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t first = i - static_cast<std::size_t>(before[i]);
    const std::size_t last = i + static_cast<std::size_t>(behind[i]);
    const float along_x = x[last] - x[first];
    const float along_y = y[last] - y[first];
    float across_x = -x[i];
    float across_y = -y[i];
    if (along_x * along_x + along_y * along_y > kLeastBase * kLeastBase) {
      const bool faces_robot = -along_y * x[i] + along_x * y[i] <= 0.0F;
      across_x = faces_robot ? -along_y : along_y;
      across_y = faces_robot ? along_x : -along_x;
    }
    normal_x.push_back(across_x);
    normal_y.push_back(across_y);
  }
}

double FrontOf(const FacedPoints& points, double theta) {
  double c = 0.0;
  double s = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double angle = 4.0 * (std::atan2(points.normal_y[i], points.normal_x[i]) + theta);
    if (!std::isfinite(angle)) continue;
    c += std::cos(angle);
    s += std::sin(angle);
  }
  return 0.25 * (std::atan2(s, c) + kPi);
}

}  // namespace masked_mapper
