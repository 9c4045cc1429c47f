// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/laser_scan.hpp"

#include <cmath>

#include "masked_mapper/sensor/beam_sweep.hpp"

namespace masked_mapper {
namespace {

pcl::PointXY AsPoint(const Eigen::Vector2d& point) {
  pcl::PointXY plain;
  plain.x = static_cast<float>(point.x());
  plain.y = static_cast<float>(point.y());
  return plain;
}

}  // namespace

bool LaserScan::IsFullCircle() const {
  if (ranges.size() < 3) return false;
  // One step short of a turn, as 360 beams at 1 degree are; half a step of slack for rounded steps.
  const double span = std::abs(angle_step) * static_cast<double>(ranges.size());
  return span > 2.0 * kPi - 0.5 * std::abs(angle_step);
}

ScanPoints::ConstPtr PointsInRobot(const LaserScan& scan) {
  ScanPoints::Ptr points(new ScanPoints);
  points->reserve(scan.size());
  auto direction = BeamSweep::InRobot(scan);
  for (std::size_t beam = 0; beam < scan.size(); ++beam, direction.Advance()) {
    if (!scan.IsHit(beam)) continue;
    const Eigen::Vector2d point_in_robot =
        scan.T_robot_laser.Translation() + scan.ranges[beam] * direction.Current();
    points->push_back(AsPoint(point_in_robot));
  }
  return points;
}

void AppendTransformed(const ScanPoints& points_in_b, const Pose2& T_a_b, double max_range_m,
                       ScanPoints& points_in_a) {
  for (const pcl::PointXY& point : points_in_b) {
    const Eigen::Vector2d in_b(point.x, point.y);
    if (in_b.norm() <= max_range_m) points_in_a.push_back(AsPoint(T_a_b * in_b));
  }
}

ScanPoints::Ptr Transformed(const ScanPoints& points_in_b, const Pose2& T_a_b) {
  ScanPoints::Ptr points_in_a(new ScanPoints);
  AppendTransformed(points_in_b, T_a_b, std::numeric_limits<double>::infinity(), *points_in_a);
  return points_in_a;
}

ScanPoints::Ptr AsScanPoints(const std::vector<Eigen::Vector2d>& points) {
  ScanPoints::Ptr cloud(new ScanPoints);
  for (const Eigen::Vector2d& point : points) cloud->push_back(AsPoint(point));
  return cloud;
}

}  // namespace masked_mapper
