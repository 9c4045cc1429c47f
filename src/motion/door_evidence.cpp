// SPDX-License-Identifier: BSD-3-Clause
#include "door_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// Whether the robot drove straight from one position to another, by those between.
template <class Iterator>
bool IsStraight(Iterator between, Iterator end, const Eigen::Vector2d& from,
                const Eigen::Vector2d& to) {
  constexpr double kStraight = 0.15;  // m beside the line: less than half of a robot's width
  const Eigen::Vector2d way = to - from;
  return std::all_of(between, end, [&](const PlacedScan& placed) {
    const Eigen::Vector2d on_the_way = placed.T_odom_robot.Translation() - from;
    return std::abs(way.x() * on_the_way.y() - way.y() * on_the_way.x()) <= kStraight * way.norm();
  });
}

/// The farthest and the nearest that a scan saw about a direction; empty where it says nothing.
struct RangeSpan {
  double nearest = 0.0;
  double farthest = 0.0;
};
std::optional<RangeSpan> RangesAbout(const LaserScan& scan, double angle_in_laser) {
  const Eigen::Vector2d direction(std::cos(angle_in_laser), std::sin(angle_in_laser));
  const std::optional<BeamSpan> beams = BeamsTowards(scan, direction, DegToRad(2.0));
  if (!beams) return std::nullopt;
  RangeSpan span{scan.ranges[beams->first], scan.ranges[beams->first]};
  for (std::size_t i = beams->first; i < beams->end; ++i) {
    if (std::isnan(scan.ranges[i])) return std::nullopt;
    span.nearest = std::min(span.nearest, static_cast<double>(scan.ranges[i]));
    span.farthest = std::max(span.farthest, static_cast<double>(scan.ranges[i]));
  }
  return span;
}

/// Whether one of two scans from one place sees far where the other sees a wall, over the width of
/// a door: it moved, or all is another place.
bool SeesDoorOpen(const PlacedScan& open, const PlacedScan& closed) {
  constexpr double kSamePlace = 0.1;  // m
  constexpr double kThrough = 0.5;    // m beyond the wall
  const double least_width = DegToRad(20.0);
  if (Distance(open.T_odom_robot, closed.T_odom_robot) > kSamePlace) return false;
  const Pose2 T_closed_open = Between(closed.T_odom_robot * closed.scan.T_robot_laser,
                                      open.T_odom_robot * open.scan.T_robot_laser);
  double width = 0.0;
  for (std::size_t i = 0; i < open.scan.size(); ++i) {
    const double angle = open.scan.Angle(i);
    const std::optional<RangeSpan> through = RangesAbout(open.scan, angle);
    const std::optional<RangeSpan> wall = RangesAbout(closed.scan, angle + T_closed_open.theta);
    const bool is_open = through && wall && through->nearest > wall->farthest + kThrough;
    width = is_open ? width + std::abs(open.scan.angle_step) : 0.0;
    if (width >= least_width) return true;
  }
  return false;
}

}  // namespace

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

bool CameThroughWall(const std::deque<PlacedScan>& way_in, const Eigen::Vector2d& cab_in_odom,
                     double door_distance_m) {
  for (auto view = way_in.rbegin(); view != way_in.rend(); ++view) {
    const Eigen::Vector2d position = view->T_odom_robot.Translation();
    const double distance = (cab_in_odom - position).norm();
    if (distance > 2.0 * door_distance_m) return false;
    if (!IsStraight(way_in.rbegin(), view, position, cab_in_odom)) return false;
    if (distance > 1.0 && SeesWallBefore(*view, cab_in_odom)) return true;
  }
  return false;
}

bool LeftThroughWall(const std::deque<PlacedScan>& walls, const std::deque<PlacedScan>& way_out,
                     const Eigen::Vector2d& cab_in_odom, double door_distance_m) {
  for (auto outside = way_out.begin(); outside != way_out.end(); ++outside) {
    const Eigen::Vector2d position = outside->T_odom_robot.Translation();
    const double distance = (position - cab_in_odom).norm();
    if (distance > 2.0 * door_distance_m) return false;
    if (!IsStraight(way_out.begin(), outside, cab_in_odom, position)) return false;
    if (distance > 1.0 && std::any_of(walls.begin(), walls.end(), [&](const PlacedScan& view) {
          return SeesWallBefore(view, position);
        })) {
      return true;
    }
  }
  return false;
}

bool SawDoorMove(const std::deque<PlacedScan>& walls, const std::deque<PlacedScan>& way) {
  return std::any_of(walls.begin(), walls.end(), [&](const PlacedScan& closed) {
    return std::any_of(way.begin(), way.end(),
                       [&](const PlacedScan& open) { return SeesDoorOpen(open, closed); });
  });
}

}  // namespace masked_mapper
