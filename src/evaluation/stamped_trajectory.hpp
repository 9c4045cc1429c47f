// SPDX-License-Identifier: BSD-3-Clause
// A trajectory as other tools write it: `t x y z qx qy qz qw` (TUM) or `t x y theta`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

struct StampedPose {
  double stamp = 0.0;  ///< s
  Pose2 T_world_robot;
  double z = 0.0;  ///< m
};

/// In order of stamps; blank lines and lines that begin with `#` are left out. Throws InputError,
/// which names file and line, when a line is of neither form, and when no line holds a pose.
std::vector<StampedPose> ReadTrajectory(const std::string& path);

/// As above, in the order of the file: the place of a node is its number.
std::vector<StampedPose> ReadTrajectoryInFileOrder(const std::string& path);

/// The pose at a stamp, between its neighbours in time; the nearest end when the stamp lies outside
/// by at most `slack_s`.
std::optional<StampedPose> PoseAt(const std::vector<StampedPose>& trajectory, double stamp,
                                  double slack_s = 0.5);

}  // namespace masked_mapper
