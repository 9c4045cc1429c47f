// SPDX-License-Identifier: BSD-3-Clause
#include "floor_lidar.hpp"

#include <algorithm>
#include <cmath>

#include "door_evidence.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kFewestBeams = 30;
constexpr std::size_t kMostKeyScans = 60;

/// What one scan says about a wall at a point.
enum class View { kNone, kAgrees, kContradicts };

/// Beams a little beside the point's direction count too: headings are not that exact.
View ViewOf(const LaserScan& scan, const Eigen::Vector2d& point_in_laser, double agree_m) {
  const double distance = point_in_laser.norm();
  if (distance > scan.max_range) return View::kNone;
  const std::optional<BeamSpan> beams = BeamsTowards(scan, point_in_laser, DegToRad(2.0));
  if (!beams) return View::kNone;
  const double tolerance = agree_m + 0.03 * distance;
  bool sees_through = true;
  for (std::size_t i = beams->first; i < beams->end; ++i) {
    const auto range = static_cast<double>(scan.ranges[i]);
    if (std::abs(range - distance) <= tolerance) return View::kAgrees;
    sees_through &= range > distance;  // an invalid beam does not
  }
  return sees_through ? View::kContradicts : View::kNone;
}

struct Counts {
  int alike = 0;
  int different = 0;
};

/// Walls of the scans of one way as the other way saw them.
Counts Compare(const std::deque<PlacedScan>& walls, const std::deque<PlacedScan>& views,
               const Eigen::Vector2d& cab_in_odom, const FloorLidarOptions& options) {
  Counts counts;
  std::vector<PointTransform> to_laser;
  for (const PlacedScan& view : views) {
    to_laser.emplace_back(Inverse(view.T_odom_robot * view.scan.T_robot_laser));
  }
  for (const PlacedScan& wall : walls) {
    const PointTransform to_odom(wall.T_odom_robot);
    BeamSweep direction = BeamSweep::InRobot(wall.scan);
    for (std::size_t i = 0; i < wall.scan.size(); ++i, direction.Advance()) {
      if (!wall.scan.IsHit(i)) continue;
      const Eigen::Vector2d point_in_robot =
          wall.scan.T_robot_laser.Translation() +
          static_cast<double>(wall.scan.ranges[i]) * direction.Current();
      const Eigen::Vector2d point_in_odom = to_odom * point_in_robot;
      const double distance = (point_in_odom - cab_in_odom).norm();
      if (distance < options.door_distance_m || distance > options.scene_radius_m) continue;
      View best = View::kNone;
      for (std::size_t k = 0; k < views.size() && best != View::kAgrees; ++k) {
        const View view = ViewOf(views[k].scan, to_laser[k] * point_in_odom, options.agree_m);
        if (view != View::kNone) best = view;
      }
      counts.alike += best == View::kAgrees;
      counts.different += best == View::kContradicts;
    }
  }
  return counts;
}

}  // namespace

bool IsClosedBox(const LaserScan& scan, const FloorLidarOptions& options) {
  std::size_t beams = 0;
  std::size_t leaks = 0;
  double area = 0.0;
  for (const float range : scan.ranges) {
    if (std::isnan(range)) continue;
    ++beams;
    if (static_cast<double>(range) > options.wall_distance_m) {
      ++leaks;
    } else {
      area += 0.5 * static_cast<double>(range) * static_cast<double>(range);
    }
  }
  const auto count = static_cast<double>(beams);
  if (beams < kFewestBeams || static_cast<double>(leaks) > options.leak_share * count) return false;
  return area * 2.0 * kPi / count <= options.max_area_m2;
}

std::optional<double> SceneAgreement(const std::deque<PlacedScan>& way_in,
                                     const std::deque<PlacedScan>& way_out, const Pose2& T_odom_cab,
                                     const FloorLidarOptions& options) {
  constexpr int kFewest = 50;
  const Counts in = Compare(way_in, way_out, T_odom_cab.Translation(), options);
  const Counts out = Compare(way_out, way_in, T_odom_cab.Translation(), options);
  const int alike = in.alike + out.alike;
  const int all = alike + in.different + out.different;
  if (all < kFewest) return std::nullopt;
  return static_cast<double>(alike) / static_cast<double>(all);
}

void LidarTrack::Observe(const LaserScan& scan) {
  if (scan.ranges.empty()) return;
  has_ranges_ = true;
  if (scan.T_odom_robot) T_odom_robot_ = *scan.T_odom_robot;
  const bool is_closed = IsClosedBox(scan, options_);
  if (closure_) {
    ObserveInClosure(scan, is_closed);
  } else if (is_closed) {
    closure_ = Closure{scan.stamp, scan.stamp, 0.0, T_odom_robot_, true, false};
    way_in_.swap(way_);
    way_.clear();
    Keep(scan, walls_);
  } else {
    Keep(scan, way_);
    ForgetFarWay();
  }
}

void LidarTrack::ObserveInClosure(const LaserScan& scan, bool is_closed) {
  const double moved = Distance(closure_->T_odom_robot, T_odom_robot_);
  if (is_closed && moved <= options_.cab_radius) {
    if (closure_->is_closed) closure_->closed += scan.stamp - closure_->end;
    closure_->end = scan.stamp;
    closure_->is_closed = true;
    way_.clear();
    Keep(scan, walls_);
    return;
  }
  closure_->is_closed = false;
  if (!is_closed) Keep(scan, way_);
  if (moved <= options_.cab_radius) return;
  if (closure_->closed < options_.closed_s) {
    // Just a narrow place on the way.
    way_in_.insert(way_in_.end(), way_.begin(), way_.end());
    way_.swap(way_in_);
    way_in_.clear();
    walls_.clear();
    closure_.reset();
    ForgetFarWay();
  } else if (moved > options_.way_m || is_closed) {
    EndClosure();
  }
}

void LidarTrack::Keep(const LaserScan& scan, std::deque<PlacedScan>& kept) const {
  if (!kept.empty()) {
    const Pose2 T_last_now = Between(kept.back().T_odom_robot, T_odom_robot_);
    if (T_last_now.Translation().norm() < options_.key_distance_m &&
        std::abs(T_last_now.theta) < DegToRad(options_.key_angle_deg)) {
      return;
    }
  }
  kept.push_back({T_odom_robot_, scan});
  if (kept.size() > kMostKeyScans) kept.pop_front();
}

void LidarTrack::ForgetFarWay() {
  while (!way_.empty() && Distance(way_.front().T_odom_robot, T_odom_robot_) > options_.way_m) {
    way_.pop_front();
  }
}

bool LidarTrack::IsRide() const {
  const Pose2& T_odom_cab = closure_->T_odom_robot;
  const Eigen::Vector2d cab_in_odom = T_odom_cab.Translation();
  if (CameThroughWall(way_in_, cab_in_odom, options_.door_distance_m) ||
      LeftThroughWall(walls_, way_, cab_in_odom, options_.door_distance_m) ||
      SawDoorMove(walls_, way_in_) || SawDoorMove(walls_, way_)) {
    return true;
  }
  const std::optional<double> agreement = SceneAgreement(way_in_, way_, T_odom_cab, options_);
  return agreement && *agreement <= options_.other_scene_share;
}

void LidarTrack::EndClosure() {
  if (closure_ && closure_->closed >= options_.closed_s) {
    closure_->is_ride = IsRide();
    closures_.push_back(*closure_);
  }
  closure_.reset();
  way_in_.clear();
  walls_.clear();
}

std::vector<FloorTransit> LidarTrack::FindRides(const WheelTrack& track) {
  EndClosure();
  std::vector<FloorTransit> rides;
  for (const Closure& closure : closures_) {
    if (!closure.is_ride) continue;
    FloorTransit ride;
    ride.middle = 0.5 * (closure.start + closure.end);
    ride.start = closure.start;
    ride.end = closure.end;
    if (track.Travels()) {
      const TimeSpan stay = track.StayAround(ride.middle, options_.cab_radius);
      ride.start = std::min(ride.start, stay.start);
      ride.end = std::max(ride.end, stay.end);
    }
    if (!rides.empty() && ride.start <= rides.back().end) {
      rides.back().end = std::max(rides.back().end, ride.end);
    } else {
      rides.push_back(ride);
    }
  }
  return rides;
}

}  // namespace masked_mapper
