// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/lidar_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::size_t kStepsOfSweep = 64;

}  // namespace

void Move(const Eigen::Isometry3d& T_a_b, CloudPoints* points) {
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  for (CloudPoint& point : *points) point.position = T * point.position;
}

void Straighten(const std::function<Pose2(double)>& motion, CloudPoints* points_in_robot) {
  if (points_in_robot->empty()) return;
  const auto [first, last] =
      std::minmax_element(points_in_robot->begin(), points_in_robot->end(),
                          [](const auto& a, const auto& b) { return a.time < b.time; });
  const double begin = first->time;
  const double span = static_cast<double>(last->time) - begin;
  if (!(span > 0.0)) return;
  // A sweep in steps of a few milliseconds: nothing turns a tenth of a degree in one of them.
  std::vector<Pose2> steps;
  for (std::size_t i = 0; i <= kStepsOfSweep; ++i) {
    steps.push_back(motion(begin + span * static_cast<double>(i) / kStepsOfSweep));
  }
  std::vector<Eigen::Matrix2f> rotations;
  for (const Pose2& step : steps) {
    rotations.push_back(Eigen::Rotation2Df(static_cast<float>(step.theta)).toRotationMatrix());
  }
  for (CloudPoint& point : *points_in_robot) {
    const double share = (static_cast<double>(point.time) - begin) / span;
    const auto i = static_cast<std::size_t>(std::lround(share * kStepsOfSweep));
    const Eigen::Vector2f moved =
        rotations[i] * point.position.head<2>() + steps[i].Translation().cast<float>();
    point.position.head<2>() = moved;
  }
}

}  // namespace masked_mapper
