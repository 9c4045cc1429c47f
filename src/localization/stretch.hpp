// SPDX-License-Identifier: BSD-3-Clause
// What the robot saw over the last metres of its way, in the frame of its motion: to be looked for
// on whole floors, and, bit by bit and each bit once, to be held against places where it may be.
#pragma once

#include <cstdint>
#include <deque>
#include <unordered_set>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// What was seen for the first time of a square metre: points on something, or points through which
/// beams went.
struct Patch {
  std::vector<Eigen::Vector2d> points_in_odom;
  bool is_free = false;
};

/// What one scan hits, by square metres.
std::vector<Patch> HitsOf(const LaserScan& scan, const Pose2& T_odom_robot);

class Stretch {
 public:
  void Restart();

  /// Scans with their poses along the motion path, in order; those that bring next to nothing are
  /// left out.
  void Add(const LaserScan& scan, const Pose2& T_odom_robot);

  /// Of all that was added since the last call.
  std::vector<Patch> TakePatches();

  /// Travel since the beginning, m.
  double length_m() const { return length_m_; }
  /// Where the robot was at the last scan that was taken in.
  const Pose2& T_odom_robot() const { return T_odom_robot_; }
  /// Points of the last `travel_m` of the way, in the frame of T_odom_robot().
  ScanPoints::Ptr Points(double travel_m) const;

 private:
  struct View {
    Pose2 T_odom_robot;
    double at_m = 0.0;
    ScanPoints::ConstPtr points_in_robot;
  };
  bool IsAtSomething(const Eigen::Vector2d& point_in_odom) const;
  void SeeFree(const LaserScan& scan, const Pose2& T_odom_robot);

  std::deque<View> views_;
  Pose2 T_odom_robot_;
  Pose2 T_odom_last_;
  double length_m_ = 0.0;
  // Cells of a lattice in odom, looked up only, never walked.
  std::unordered_set<std::int64_t> hit_cells_;
  std::unordered_set<std::int64_t> free_cells_;
  std::vector<Eigen::Vector2d> new_hits_in_odom_;
  std::vector<Eigen::Vector2d> new_free_in_odom_;
};

}  // namespace masked_mapper
