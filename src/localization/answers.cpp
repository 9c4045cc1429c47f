// SPDX-License-Identifier: BSD-3-Clause
#include "answers.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kSureSigma = 0.3;  // m; a robot that knows no better is not sure of its pose

}  // namespace

UncertainPose2 Found(const Pose2& T_world_robot) {
  return Widened({T_world_robot, Eigen::Matrix3d::Zero()}, kPlaceM / 3.0, kPlaceDeg / 3.0);
}

void Answers::Add(const LaserScan& scan, const Pose2& T_odom_robot) {
  LocatedScan located;
  located.stamp = scan.stamp;
  located.log_stamp = scan.log_stamp;
  located.T_odom_robot = T_odom_robot;
  result_.scans.push_back(located);
}

void Answers::Place(FloorId floor, const UncertainPose2& T_world_robot, double travelled_m) {
  LocatedScan& now = result_.scans.back();
  now.placed = true;
  now.floor = floor;
  now.T_world_robot = T_world_robot;
  now.sure = SigmaM(T_world_robot) <= kSureSigma;
  if (!now.sure || result_.found) return;
  result_.found = true;
  result_.found_after_m = travelled_m;
}

void Answers::Close(const std::string& why_not) {
  const LocatedScan& now = result_.scans.back();
  if (now.sure) return;
  const bool is_new = result_.scans.size() == 1 || result_.scans[result_.scans.size() - 2].sure;
  if (is_new) result_.unsure_spans.push_back({now.stamp, now.stamp, why_not});
  result_.unsure_spans.back().t_b = now.stamp;
}

void Answers::PlaceInHindsight(const Hypothesis& found) {
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    const std::size_t end =
        i + 1 < found.anchors.size() ? found.anchors[i + 1].scan : result_.scans.size();
    for (std::size_t k = found.anchors[i].scan; k < end; ++k) {
      LocatedScan& scan = result_.scans[k];
      scan.placed = true;
      scan.floor = found.anchors[i].floor;
      scan.T_world_robot = Found(found.anchors[i].T_world_odom * scan.T_odom_robot);
    }
  }
}

}  // namespace masked_mapper
