// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/pose2.hpp"

#include <cmath>

namespace masked_mapper {

Pose2 AlignRigidly(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& a_and_b) {
  if (a_and_b.empty()) return {};
  Eigen::Vector2d a_centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d b_centre = Eigen::Vector2d::Zero();
  for (const auto& [a, b] : a_and_b) {
    a_centre += a;
    b_centre += b;
  }
  a_centre /= static_cast<double>(a_and_b.size());
  b_centre /= static_cast<double>(a_and_b.size());
  double along = 0.0;
  double across = 0.0;
  for (const auto& [a, b] : a_and_b) {
    const Eigen::Vector2d in_a = a - a_centre;
    const Eigen::Vector2d in_b = b - b_centre;
    along += in_b.dot(in_a);
    across += in_b.x() * in_a.y() - in_b.y() * in_a.x();
  }
  const Pose2 rotation{0.0, 0.0, std::atan2(across, along)};
  const Eigen::Vector2d shift = a_centre - rotation * b_centre;
  return {shift.x(), shift.y(), rotation.theta};
}

}  // namespace masked_mapper
