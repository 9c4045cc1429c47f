// SPDX-License-Identifier: BSD-3-Clause
// Rides by lidar and odometry alone: walls of a few square metres close around a robot that does
// not travel, and then it leaves. This tells that the floor was changed, but never to which: every
// ride opens a level that may be one of the others.
//
// Two things tell a cab from a narrow corner. A cab has a door: the robot leaves, or came in, where
// it saw a wall before, or sees the door move. And when the door opens there may be another scene
// than on the way in; but floors often look alike in front of a shaft, so a scene that is the same
// proves nothing. Where neither is seen the robot stood in a nook.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// Whether the scan sees nothing but walls close around it.
bool IsClosedBox(const LaserScan& scan, const FloorLidarOptions& options);

/// A scan and where it was taken.
struct PlacedScan {
  Pose2 T_odom_robot;
  LaserScan scan;
};

/// Of what both ways saw of the walls outside the cab, the share that
/// they saw alike. Empty when they have too little in common to tell.
std::optional<double> SceneAgreement(const std::deque<PlacedScan>& way_in,
                                     const std::deque<PlacedScan>& way_out, const Pose2& T_odom_cab,
                                     const FloorLidarOptions& options);

/// Whether the scan saw a wall nearer than a point, in its direction and on either side of it.
bool SeesWallBefore(const PlacedScan& view, const Eigen::Vector2d& point_in_odom);

class LidarTrack {
 public:
  explicit LidarTrack(const FloorLidarOptions& options) : options_(options) {}

  /// In order of stamps.
  void Observe(const OdometryReading& reading) { T_odom_robot_ = reading.T_odom_robot; }
  /// Scans without beams tell nothing.
  void Observe(const LaserScan& scan);

  bool HasRanges() const { return has_ranges_; }
  /// Rides in order, their climbs unknown. The log is over; `track` is that of the same log.
  std::vector<FloorTransit> FindRides(const WheelTrack& track);

 private:
  /// Walls closed around the robot, once or several times before it travelled on.
  struct Closure {
    double start = 0.0;   ///< s
    double end = 0.0;     ///< s
    double closed = 0.0;  ///< s, of scans that saw it so
    Pose2 T_odom_robot;
    bool is_closed = true;
    bool is_ride = false;
  };

  void ObserveInClosure(const LaserScan& scan, bool is_closed);
  void Keep(const LaserScan& scan, std::deque<PlacedScan>& kept) const;
  void ForgetFarWay();
  void EndClosure();
  bool IsRide() const;

  FloorLidarOptions options_;
  Pose2 T_odom_robot_;
  bool has_ranges_ = false;
  std::deque<PlacedScan> way_;     ///< of the last metres; in a closure: since it opened last
  std::deque<PlacedScan> way_in_;  ///< as it was when the closure began
  std::deque<PlacedScan> walls_;   ///< what was seen in the closure
  std::optional<Closure> closure_;
  std::vector<Closure> closures_;  ///< those long enough for a ride
};

}  // namespace masked_mapper
