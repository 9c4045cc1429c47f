// SPDX-License-Identifier: BSD-3-Clause
// The frames of a robot as tf tells them: which frame hangs where under which. Names come without a
// leading slash.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

class FrameTree {
 public:
  /// The first transform of a frame stays: the chain between sensors and robot does not move.
  void Add(const std::string& parent, const std::string& child,
           const Eigen::Isometry3d& T_parent_child);

  /// m, the farthest that a frame was seen from where it first was under its parent.
  double Travel(const std::string& child) const;
  bool Knows(const std::string& frame) const;
  /// The frame and all above it, upwards; never endless.
  std::vector<std::string> Ancestors(const std::string& frame) const;
  /// Empty when the two do not hang together.
  std::optional<Eigen::Isometry3d> Find(const std::string& target, const std::string& source) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
    double travel = 0.0;  ///< m
  };
  std::map<std::string, Link> links_;  ///< by child
};

/// "base_link" of "robot1/base_link".
std::string LastPartOfFrame(const std::string& frame);

/// A scanner's pose seen from above. Mounted upside down, its beams run clockwise.
struct PlanarMount {
  Pose2 T_robot_laser;
  bool upside_down = false;
};
PlanarMount SeenFromAbove(const Eigen::Isometry3d& T_robot_laser);

}  // namespace masked_mapper
