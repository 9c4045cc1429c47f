// SPDX-License-Identifier: BSD-3-Clause
// The place of a robot that is sure of it: carried along by its motion, matched where the mask says
// that it pays, and doubted where what is seen contradicts the map.
#pragma once

#include "evidence.hpp"
#include "known_map.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/motion/motion_estimator.hpp"
#include "pose_tracker.hpp"

namespace masked_mapper {

struct HeldPlaceOptions {
  double min_edge_length_m = 1.5;  ///< of way between two matches by the mask, at the least
  double max_edge_length_m = 9.0;  ///< of way after which a match is due whatever the mask says
};

class HeldPlace {
 public:
  HeldPlace(const KnownMap& map, const LoopClosureOptions& closures,
            const EvidenceOptions& evidence, const HeldPlaceOptions& options)
      : map_(map), evidence_(evidence), options_(options), tracker_(map, closures) {}

  FloorId floor() const { return floor_; }
  /// Changes the floor alone; the pose in world stays.
  void SetFloor(FloorId floor) { floor_ = floor; }
  /// A match is due with the next scan, whatever the mask says.
  void WantMatch() { match_is_due_ = true; }

  /// Where motion puts the robot now.
  UncertainPose2 Robot(const MotionEstimator& motion) const {
    return T_world_matched_ * motion.T_node_robot();
  }
  Pose2 WorldFromOdom(const MotionEstimator& motion) const {
    return Robot(motion).mean * Inverse(motion.T_odom_robot());
  }

  /// The robot is there; `motion` counts from here on.
  void Take(FloorId floor, const UncertainPose2& T_world_robot, MotionEstimator& motion);

  /// Matches the scan if that is due.
  void Track(const LaserScan& scan, Mask& mask, MotionEstimator& motion);

  /// Holds a scan against the map. False: it is of another place.
  bool Agrees(const LaserScan& scan, Mask& mask, MotionEstimator& motion);

  /// Way since the last match that fitted, m.
  double SinceMatch() const { return travelled_m_ - matched_at_m_; }
  void Travel(double way_m) { travelled_m_ += way_m; }

  /// Scans held against a node of the map.
  int matches() const { return tracker_.matches(); }

 private:
  bool Match(const LaserScan& scan, const UncertainPose2& guess, Mask& mask,
             MotionEstimator& motion);
  double DoubtBy(const LaserScan& scan, const MotionEstimator& motion) const;

  const KnownMap& map_;
  EvidenceOptions evidence_;
  HeldPlaceOptions options_;
  PoseTracker tracker_;

  FloorId floor_ = 0;
  UncertainPose2 T_world_matched_;  ///< where motion counts from
  double travelled_m_ = 0.0;
  double matched_at_m_ = 0.0;
  double tried_at_m_ = 0.0;
  bool match_is_due_ = false;
  double doubt_nats_ = 0.0;
};

}  // namespace masked_mapper
