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

#include "masked_mapper/motion/floor_transit.hpp"
#include "masked_mapper/motion/wheel_track.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

struct FloorLidarOptions {
  double wall_distance_m = 3.5;    ///< m, to the walls of a cab at most
  double max_area_m2 = 9.0;        ///< m^2, of a cab at most
  double leak_share = 0.03;        ///< of beams that may pass gaps of doors
  double closed_s = 4.0;           ///< s for which doors are closed for a ride at least
  double cab_radius = 0.25;        ///< m within which a robot stays while it turns round in a cab
  double door_distance_m = 2.5;    ///< m from the cab's middle: surely outside its door
  double way_m = 6.0;              ///< m of the way in and of the way out that are looked at
  double scene_radius_m = 10.0;    ///< m from the cab's middle, up to which walls are compared
  double other_scene_share = 0.4;  ///< of walls seen alike at most: another scene
  double key_distance_m = 0.4;     ///< m, or ...
  double key_angle_deg = 20.0;     ///< ... deg between the scans kept of a way
  double agree_m = 0.3;            ///< m between two views of the same wall at most
};

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
