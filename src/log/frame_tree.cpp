// SPDX-License-Identifier: BSD-3-Clause
#include "frame_tree.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::size_t kMostFrames = 10000;
constexpr std::size_t kDeepest = 100;

}  // namespace

void FrameTree::Add(const std::string& parent, const std::string& child,
                    const Eigen::Isometry3d& T_parent_child) {
  if (child.empty() || links_.size() >= kMostFrames) return;
  const auto [link, is_new] = links_.emplace(child, Link{parent, T_parent_child});
  if (is_new || link->second.parent != parent) return;
  const double travel =
      (T_parent_child.translation() - link->second.T_parent_child.translation()).norm();
  link->second.travel = std::max(link->second.travel, travel);
}

double FrameTree::Travel(const std::string& child) const {
  const auto link = links_.find(child);
  return link == links_.end() ? 0.0 : link->second.travel;
}

bool FrameTree::Knows(const std::string& frame) const { return links_.count(frame) > 0; }

std::vector<std::string> FrameTree::Ancestors(const std::string& frame) const {
  std::vector<std::string> ancestors{frame};
  for (auto link = links_.find(frame); link != links_.end() && ancestors.size() < kDeepest;
       link = links_.find(link->second.parent)) {
    ancestors.push_back(link->second.parent);
  }
  return ancestors;
}

std::optional<Eigen::Isometry3d> FrameTree::Find(const std::string& target,
                                                 const std::string& source) const {
  const std::vector<std::string> above_target = Ancestors(target);
  const std::vector<std::string> above_source = Ancestors(source);
  const auto common =
      std::find_if(above_source.begin(), above_source.end(), [&](const auto& frame) {
        return std::find(above_target.begin(), above_target.end(), frame) != above_target.end();
      });
  if (common == above_source.end()) return std::nullopt;
  const auto from_common_to = [&](const std::vector<std::string>& chain) {
    Eigen::Isometry3d T_common_frame = Eigen::Isometry3d::Identity();
    for (const std::string& frame : chain) {
      if (frame == *common) break;
      T_common_frame = links_.at(frame).T_parent_child * T_common_frame;
    }
    return T_common_frame;
  };
  return from_common_to(above_target).inverse() * from_common_to(above_source);
}

std::string LastPartOfFrame(const std::string& frame) {
  const std::size_t slash = frame.rfind('/');
  return slash == std::string::npos ? frame : frame.substr(slash + 1);
}

// Quaternion and matrix leave rounding errors in an angle that was written with a few digits; taken
// off again, a bag and a text log of one drive say the same to the last bit.
PlanarMount SeenFromAbove(const Eigen::Isometry3d& T_robot_laser) {
  const Eigen::Matrix3d rotation = T_robot_laser.linear();
  PlanarMount mount;
  mount.upside_down = rotation(2, 2) < 0.0;
  constexpr double kStepsPerRadian = 1e12;
  const double yaw = std::atan2(rotation(1, 0), rotation(0, 0));
  mount.T_robot_laser = {T_robot_laser.translation().x(), T_robot_laser.translation().y(),
                         std::round(yaw * kStepsPerRadian) / kStepsPerRadian};
  return mount;
}

}  // namespace masked_mapper
