// SPDX-License-Identifier: BSD-3-Clause
#include "stamped_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "masked_mapper/text/input_error.hpp"
#include "number_lines.hpp"

namespace masked_mapper {
namespace {

double YawOf(double qx, double qy, double qz, double qw, const FileLine& line) {
  if (std::abs(std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw) - 1.0) > 1e-2) {
    line.Fail("the quaternion is not of unit length");
  }
  return std::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
}

}  // namespace

std::vector<StampedPose> ReadTrajectoryInFileOrder(const std::string& path) {
  std::vector<StampedPose> trajectory;
  ForEachLine(path, [&](std::string_view text, const FileLine& line) {
    const std::vector<std::string_view> words = WordsOf(text);
    if (words.empty() || words.front().front() == '#') return;
    if (words.size() != 8 && words.size() != 4) {
      line.Fail("expected `t x y z qx qy qz qw` or `t x y theta`, found " +
                std::to_string(words.size()) + " words");
    }
    std::vector<double> v;
    for (const std::string_view word : words) v.push_back(NumberIn(word, line));
    const bool flat = v.size() == 4;
    const double theta = flat ? WrapAngle(v[3]) : YawOf(v[4], v[5], v[6], v[7], line);
    trajectory.push_back({v[0], {v[1], v[2], theta}, flat ? 0.0 : v[3]});
  });
  if (trajectory.empty()) throw InputError(path + ": holds no pose");
  return trajectory;
}

std::vector<StampedPose> ReadTrajectory(const std::string& path) {
  std::vector<StampedPose> trajectory = ReadTrajectoryInFileOrder(path);
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return trajectory;
}

std::optional<StampedPose> PoseAt(const std::vector<StampedPose>& trajectory, double stamp,
                                  double slack_s) {
  const auto after =
      std::upper_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](double value, const StampedPose& pose) { return value < pose.stamp; });
  if (trajectory.empty()) return std::nullopt;
  if (after == trajectory.begin() || after == trajectory.end()) {
    const StampedPose& end = after == trajectory.begin() ? trajectory.front() : trajectory.back();
    if (std::abs(end.stamp - stamp) > slack_s) return std::nullopt;
    return end;
  }
  const StampedPose& a = *std::prev(after);
  const StampedPose& b = *after;
  const double fraction = (stamp - a.stamp) / (b.stamp - a.stamp);
  return StampedPose{stamp, Interpolate(a.T_world_robot, b.T_world_robot, fraction),
                     a.z + fraction * (b.z - a.z)};
}

}  // namespace masked_mapper
