// SPDX-License-Identifier: BSD-3-Clause
// The openings mask (Section III-D, 4): fires where the robot could turn off its course, and where
// it turned back. openings.hpp says how no-return beams and scanners below 360 degrees are treated.
//
// Directions are followed in the frame of odometry, which does not turn with the robot.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "openings.hpp"

namespace masked_mapper {

/// The robot's direction of travel in the odometry frame.
class Course {
 public:
  explicit Course(double distance_m) : distance_m_(distance_m) {}

  void Observe(const Pose2& T_odom_robot);
  /// rad. At rest, and while the robot turns on the spot, the last course stands; before the first
  /// motion it is the heading (ours).
  double Direction() const { return direction_; }

 private:
  double distance_m_;
  std::deque<Eigen::Vector2d> path_in_odom_;  ///< about the last `distance_m_`, thinned
  double path_length_ = 0.0;
  bool has_moved_ = false;
  double direction_ = 0.0;
};

/// Whether the robot turned back since a node.
class DeadEnd {
 public:
  void Observe(const Pose2& T_odom_robot);
  /// The node stands where the robot was observed last.
  void OnNode() {
    T_odom_node_ = T_odom_robot_;
    forward_ = 0.0;
  }
  /// rad between the heading and the direction of travel since the node; 0 within `min_distance_m`.
  double Turned(double min_distance_m) const;

 private:
  std::optional<Pose2> T_odom_node_;  ///< the first observation until there is a node
  std::optional<Pose2> T_odom_robot_;
  double forward_ = 0.0;  ///< m driven along the heading since the node; negative when reversing
};

/// Directions of openings over a short horizon of views.
class DirectionTracks {
 public:
  explicit DirectionTracks(const OpeningsMaskOptions& options) : options_(options) {}

  /// A view after `path_length` metres of path.
  void Observe(double path_length, const std::vector<double>& directions_in_odom);
  /// The directions seen often enough and steadily enough, rad in the odometry frame.
  std::vector<double> Kept() const;

 private:
  struct Sighting {
    std::size_t view;
    double direction;  ///< rad, unwrapped along its track
  };
  using Track = std::deque<Sighting>;

  void Forget();

  OpeningsMaskOptions options_;
  std::deque<double> path_lengths_;  ///< m, of the views within the horizon
  std::size_t next_view_ = 0;        ///< counts up; that in front of `path_lengths_` is next - size
  std::vector<Track> tracks_;
};

class OpeningsMask : public Mask {
 public:
  explicit OpeningsMask(const OpeningsMaskOptions& options);

  void Observe(const MaskObservation& observation) override;
  bool Fires() const override { return fires_; }
  void OnNode() override { dead_end_.OnNode(); }
  void Restart() override;

 private:
  bool IsNewView(const Pose2& T_odom_robot) const;

  OpeningsMaskOptions options_;
  DirectionTracks tracks_;
  Course course_;
  DeadEnd dead_end_;
  std::optional<Pose2> T_odom_view_;  ///< where the robot looked last
  double path_length_ = 0.0;          ///< m, from view to view
  bool fires_ = false;
};

}  // namespace masked_mapper
