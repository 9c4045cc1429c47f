// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_lidar.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "masked_mapper/sensor/beam_sweep.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kFewestBeams = 30;
constexpr std::size_t kMostKeyScans = 60;

/// Beams on either side of the direction to a point in the laser frame: [first, end).
struct BeamSpan {
  std::size_t first = 0;
  std::size_t end = 0;
};
std::optional<BeamSpan> BeamsTowards(const LaserScan& scan, const Eigen::Vector2d& point_in_laser,
                                     double half_angle) {
  const double angle = std::atan2(point_in_laser.y(), point_in_laser.x());
  const double sign = scan.angle_step < 0.0 ? -1.0 : 1.0;
  double from_first = sign * WrapAngle(angle - scan.first_angle);
  const double step = std::abs(scan.angle_step);
  if (from_first < -0.5 * step) from_first += 2.0 * kPi;
  const double low = std::ceil((from_first - half_angle) / step);
  const double high = std::floor((from_first + half_angle) / step);
  if (!(low >= 0.0 && high < static_cast<double>(scan.size()) && low <= high)) return std::nullopt;
  return BeamSpan{static_cast<std::size_t>(low), static_cast<std::size_t>(high) + 1};
}

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
  std::vector<Pose2> T_laser_odom;
  for (const PlacedScan& view : views) {
    T_laser_odom.push_back(Inverse(view.T_odom_robot * view.scan.T_robot_laser));
  }
  for (const PlacedScan& wall : walls) {
    BeamSweep direction = BeamSweep::InRobot(wall.scan);
    for (std::size_t i = 0; i < wall.scan.size(); ++i, direction.Advance()) {
      if (!wall.scan.IsHit(i)) continue;
      const Eigen::Vector2d point_in_robot =
          wall.scan.T_robot_laser.Translation() +
          static_cast<double>(wall.scan.ranges[i]) * direction.Current();
      const Eigen::Vector2d point_in_odom = wall.T_odom_robot * point_in_robot;
      const double distance = (point_in_odom - cab_in_odom).norm();
      if (distance < options.door_distance_m || distance > options.scene_radius_m) continue;
      View best = View::kNone;
      for (std::size_t k = 0; k < views.size() && best != View::kAgrees; ++k) {
        const View view = ViewOf(views[k].scan, T_laser_odom[k] * point_in_odom, options.agree_m);
        if (view != View::kNone) best = view;
      }
      counts.alike += best == View::kAgrees;
      counts.different += best == View::kContradicts;
    }
  }
  return counts;
}

/// Whether the robot saw a wall where it then drove straight in.
bool CameThroughWall(const std::deque<PlacedScan>& way_in, const Eigen::Vector2d& cab_in_odom,
                     const FloorLidarOptions& options) {
  constexpr double kStraight = 0.3;  // m beside the line
  for (std::size_t i = way_in.size(); i-- > 0;) {
    const Eigen::Vector2d view = way_in[i].T_odom_robot.Translation();
    const Eigen::Vector2d way = cab_in_odom - view;
    if (way.norm() > 2.0 * options.door_distance_m) return false;
    for (std::size_t k = i + 1; k < way_in.size(); ++k) {
      const Eigen::Vector2d between = way_in[k].T_odom_robot.Translation() - view;
      const double aside = std::abs(way.x() * between.y() - way.y() * between.x());
      if (aside > kStraight * way.norm()) return false;
    }
    if (way.norm() > 1.0 && SeesWallBefore(way_in[i], cab_in_odom)) return true;
  }
  return false;
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

bool SeesWallBefore(const PlacedScan& view, const Eigen::Vector2d& point_in_odom) {
  constexpr double kBefore = 0.4;     // m
  constexpr double kMostLeaks = 0.1;  // of the beams
  const double half_angle = DegToRad(6.0);
  const Eigen::Vector2d point_in_laser =
      Inverse(view.T_odom_robot * view.scan.T_robot_laser) * point_in_odom;
  const std::optional<BeamSpan> beams = BeamsTowards(view.scan, point_in_laser, half_angle);
  if (!beams) return false;
  const double nearest = point_in_laser.norm() - kBefore;
  double leaks = 0.0;
  for (std::size_t i = beams->first; i < beams->end; ++i) {
    leaks += !(static_cast<double>(view.scan.ranges[i]) < nearest);
  }
  return leaks <= kMostLeaks * static_cast<double>(beams->end - beams->first);
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
  const bool came = CameThroughWall(way_in_, cab_in_odom, options_);
  const auto outside = std::find_if(way_.begin(), way_.end(), [&](const PlacedScan& placed) {
    return Distance(placed.T_odom_robot, T_odom_cab) > options_.door_distance_m;
  });
  if (outside == way_.end()) return came;
  const Eigen::Vector2d outside_in_odom = outside->T_odom_robot.Translation();
  const bool left = std::any_of(walls_.begin(), walls_.end(), [&](const PlacedScan& view) {
    return SeesWallBefore(view, outside_in_odom);
  });
  const std::optional<double> agreement = SceneAgreement(way_in_, way_, T_odom_cab, options_);
  return came || left || (agreement && *agreement <= options_.other_scene_share);
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
