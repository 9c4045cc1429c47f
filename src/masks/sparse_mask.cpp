// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_mask.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// Path between two views that are remembered, m.
constexpr double kPathStep = 0.5;

}  // namespace

void SparseMask::Observe(const MaskObservation& observation) {
  CombinedMask::Observe(observation);
  if (!path_.empty()) {
    now_.path_length += Distance(now_.T_odom_robot, observation.T_odom_robot);
  }
  now_.T_odom_robot = observation.T_odom_robot;
  sees_all_around_ = observation.scan.IsFullCircle();
  if (path_.empty() || now_.path_length - path_.back().path_length >= kPathStep) {
    path_.push_back(now_);
  }
  const auto is_of_this_pass = [&](const View& node) {
    return now_.path_length - node.path_length < options_.pass_m;
  };
  nodes_.erase(nodes_.begin(), std::find_if(nodes_.begin(), nodes_.end(), is_of_this_pass));
  fires_ = parts().front()->Fires() && (IsApart() || IsRevisit());
}

void SparseMask::OnNode() {
  CombinedMask::OnNode();
  if (!path_.empty()) nodes_.push_back(now_);
}

void SparseMask::Restart() {
  CombinedMask::Restart();
  now_ = {};
  nodes_.clear();
  path_.clear();
  fires_ = false;
}

bool SparseMask::SeesTheSame(const View& earlier) const {
  return sees_all_around_ ||
         std::abs(WrapAngle(earlier.T_odom_robot.theta - now_.T_odom_robot.theta)) <=
             DegToRad(options_.turn_deg);
}

bool SparseMask::IsApart() const {
  return std::none_of(nodes_.begin(), nodes_.end(), [&](const View& node) {
    return Distance(node.T_odom_robot, now_.T_odom_robot) < options_.place_m && SeesTheSame(node);
  });
}

// No view can be nearer than its distance along the path allows: one that is far off takes those
// after it along, and a long drive costs little more than a short one.
bool SparseMask::IsRevisit() const {
  auto view = path_.begin();
  while (view != path_.end()) {
    const double since = now_.path_length - view->path_length;
    if (since < options_.pass_m) break;
    const double reach = options_.place_m + options_.drift_share * since;
    const double beyond = Distance(view->T_odom_robot, now_.T_odom_robot) - reach;
    if (beyond <= 0.0) {
      if (SeesTheSame(*view)) return true;
      ++view;
    } else {
      // The reach shrinks from view to view.
      const double next = view->path_length + beyond;
      view = std::lower_bound(view + 1, path_.end(), next, [](const View& other, double length) {
        return other.path_length < length;
      });
    }
  }
  return false;
}

}  // namespace masked_mapper
