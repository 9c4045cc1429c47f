// SPDX-License-Identifier: BSD-3-Clause
#include "held_place.hpp"

#include <algorithm>
#include <cmath>

#include "stretch.hpp"

namespace masked_mapper {
namespace {

constexpr double kOpenSigma = 0.15;  // m, from which on a match is due whatever the mask says
constexpr double kRetry = 0.5;       // m of way after a match that did not fit

}  // namespace

void HeldPlace::Take(FloorId floor, const UncertainPose2& T_world_robot, MotionEstimator& motion) {
  floor_ = floor;
  T_world_matched_ = T_world_robot;
  matched_at_m_ = tried_at_m_ = travelled_m_;
  doubt_nats_ = 0.0;
  motion.StartNode();
}

void HeldPlace::Track(const LaserScan& scan, Mask& mask, MotionEstimator& motion) {
  const UncertainPose2 here = Robot(motion);
  const bool is_open = SigmaM(here) > kOpenSigma || SinceMatch() > options_.max_edge_length_m;
  const bool by_mask = SinceMatch() > options_.min_edge_length_m && mask.Fires();
  const bool may_retry = travelled_m_ - tried_at_m_ >= kRetry;
  if (match_is_due_ || ((by_mask || is_open) && may_retry)) Match(scan, here, mask, motion);
}

bool HeldPlace::Match(const LaserScan& scan, const UncertainPose2& guess, Mask& mask,
                      MotionEstimator& motion) {
  match_is_due_ = false;
  tried_at_m_ = travelled_m_;
  const std::optional<UncertainPose2> match = tracker_.Match(scan, floor_, guess);
  if (!match) return false;
  T_world_matched_ = *match;
  matched_at_m_ = travelled_m_;
  motion.StartNode();
  mask.OnNode();
  return true;
}

double HeldPlace::DoubtBy(const LaserScan& scan, const MotionEstimator& motion) const {
  Tally tally;
  const Pose2 T_world_odom = WorldFromOdom(motion);
  for (const Patch& patch : HitsOf(scan, motion.T_odom_robot())) {
    tally.Add(FitOf(patch, *map_.FloorAt(floor_), T_world_odom));
  }
  // Where it would be instead is likely to look alike: else it were not held here.
  return -NatsOf(tally, evidence_.agrees_elsewhere, evidence_);
}

// The sum of all evidence against the place since it last spoke for it. Whole scans are asked: of
// what is new a person who walks ahead would be all.
bool HeldPlace::Agrees(const LaserScan& scan, Mask& mask, MotionEstimator& motion) {
  doubt_nats_ = std::max(0.0, doubt_nats_ + DoubtBy(scan, motion));
  if (doubt_nats_ < evidence_.believed_nats) return true;
  // It may be the pose that is off, not the place: then the scan fits where a match puts it.
  constexpr double kLookAround = 0.3;  // m
  constexpr double kLookAroundDeg = 3.0;
  if (!Match(scan, Widened(Robot(motion), kLookAround, kLookAroundDeg), mask, motion)) return false;
  doubt_nats_ = 0.0;
  return DoubtBy(scan, motion) <= 0.0;
}

}  // namespace masked_mapper
