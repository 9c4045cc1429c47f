// SPDX-License-Identifier: BSD-3-Clause
// One sweep of a 2D lidar: beams as measured, and the same as points in the robot frame.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

using ScanPoints = pcl::PointCloud<pcl::PointXY>;

/// Range of a beam that met nothing within the scanner's reach: free space up to `max_range`.
constexpr float kNoReturn = std::numeric_limits<float>::infinity();
/// Range of a beam that says nothing (garbage in the log, too close to be true).
constexpr float kInvalidRange = std::numeric_limits<float>::quiet_NaN();

struct LaserScan {
  double stamp = 0.0;                 ///< s, never decreasing within a log as a reader hands it out
  double log_stamp = 0.0;             ///< s, as the log has it, which may step back
  Pose2 T_robot_laser;                ///< pose of the scanner on the robot
  double first_angle = 0.0;           ///< rad, direction of beam 0 in the laser frame
  double angle_step = 0.0;            ///< rad, counter-clockwise positive; negative when mirrored
  float max_range = 0.0F;             ///< m, beyond which nothing is returned
  std::vector<float> ranges;          ///< m; finite > 0, or kNoReturn, or kInvalidRange
  std::optional<Pose2> T_odom_robot;  ///< odometry at the scan's stamp, where the log has it
  /// s, from one beam to the next in time, the first at the stamp. Negative: the last beam is at
  /// the stamp, and they follow backwards. 0: all are, or were put where they would be then.
  double beam_time = 0.0;

  std::size_t size() const { return ranges.size(); }
  /// Direction of a beam in the laser frame, rad, not wrapped.
  double Angle(std::size_t beam) const {
    return first_angle + angle_step * static_cast<double>(beam);
  }
  /// When a beam was measured, s after the stamp.
  double TimeOf(std::size_t beam) const {
    const std::size_t before = beam_time < 0.0 ? size() - 1 - beam : beam;
    return std::abs(beam_time) * static_cast<double>(before);
  }
  /// How long the beams took, s.
  double SweepDuration() const {
    return ranges.empty() ? 0.0 : TimeOf(beam_time < 0.0 ? 0 : size() - 1);
  }
  /// Whether the beams go all round, so that the last is the neighbour of the first.
  bool IsFullCircle() const;
  /// Whether a beam hit something.
  bool IsHit(std::size_t beam) const { return ranges[beam] < max_range; }
};

/// The hits of a scan as points in the robot frame, in beam order; never null.
ScanPoints::ConstPtr PointsInRobot(const LaserScan& scan);

/// Appends the points of b, those within `max_range_m` of its origin, as points in a.
void AppendTransformed(const ScanPoints& points_in_b, const Pose2& T_a_b, double max_range_m,
                       ScanPoints& points_in_a);
/// All points of b as points in a; never null.
ScanPoints::Ptr Transformed(const ScanPoints& points_in_b, const Pose2& T_a_b);
/// Points as a cloud of the scan's point type.
ScanPoints::Ptr AsScanPoints(const std::vector<Eigen::Vector2d>& points);
/// One point per cell of `spacing_m` of the lattice at the origin: the mean of the finite points of
/// the cell within `max_range_m`, in the order of their first points.
std::vector<Eigen::Vector2d> ThinPoints(const ScanPoints& points, double spacing_m,
                                        double max_range_m);

/// Unit vectors along the beams of a scan, one after another: one rotation per beam where a sine
/// and a cosine would cost most of what is done with a beam. Off by less than 1e-11 after thousands
/// of beams.
class BeamSweep {
 public:
  /// Starts at beam 0, in the laser frame.
  static BeamSweep InLaser(const LaserScan& scan) { return {scan.first_angle, scan.angle_step}; }
  /// Starts at beam 0, in the robot frame.
  static BeamSweep InRobot(const LaserScan& scan) {
    return {scan.T_robot_laser.theta + scan.first_angle, scan.angle_step};
  }

  const Eigen::Vector2d& Current() const { return direction_; }

  void Advance() {
    direction_ = {step_.x() * direction_.x() - step_.y() * direction_.y(),
                  step_.y() * direction_.x() + step_.x() * direction_.y()};
  }

 private:
  BeamSweep(double first_angle, double angle_step)
      : direction_(std::cos(first_angle), std::sin(first_angle)),
        step_(std::cos(angle_step), std::sin(angle_step)) {}

  Eigen::Vector2d direction_;
  Eigen::Vector2d step_;
};

}  // namespace masked_mapper
