// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/laser_scan.hpp"

#include <cmath>

#include "masked_mapper/sensor/beam_sweep.hpp"

namespace masked_mapper {

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
    pcl::PointXY point;
    point.x = static_cast<float>(point_in_robot.x());
    point.y = static_cast<float>(point_in_robot.y());
    points->push_back(point);
  }
  return points;
}

}  // namespace masked_mapper
