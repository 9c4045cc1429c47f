// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/sensor/laser_scan.hpp"

#include <cmath>
#include <cstdint>
#include <unordered_map>

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
  points->resize(scan.size());
  std::size_t hits = 0;
  auto direction = BeamSweep::InRobot(scan);
  for (std::size_t beam = 0; beam < scan.size(); ++beam, direction.Advance()) {
    if (!scan.IsHit(beam)) continue;
    const Eigen::Vector2d point_in_robot =
        scan.T_robot_laser.Translation() + scan.ranges[beam] * direction.Current();
    (*points)[hits++] = AsPoint(point_in_robot);
  }
  points->resize(hits);
  return points;
}

void AppendTransformed(const ScanPoints& points_in_b, const Pose2& T_a_b, double max_range_m,
                       ScanPoints& points_in_a) {
  const PointTransform to_a(T_a_b);
  for (const pcl::PointXY& point : points_in_b) {
    const Eigen::Vector2d in_b(point.x, point.y);
    if (in_b.norm() <= max_range_m) points_in_a.push_back(AsPoint(to_a * in_b));
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

std::vector<Eigen::Vector2d> ThinPoints(const ScanPoints& points, double spacing_m,
                                        double max_range_m) {
  std::vector<Eigen::Vector2d> thinned;
  std::vector<double> counts;
  std::unordered_map<std::int64_t, std::size_t> index_of_cell;  // looked up only, never walked
  index_of_cell.reserve(points.size());
  for (const pcl::PointXY& point : points) {
    const Eigen::Vector2d position(point.x, point.y);
    if (!(position.norm() <= max_range_m)) continue;
    if (!(spacing_m > 0.0)) {
      thinned.push_back(position);
      counts.push_back(1.0);
      continue;
    }
    const auto x = static_cast<std::int64_t>(std::floor(position.x() / spacing_m));
    const auto y = static_cast<std::int64_t>(std::floor(position.y() / spacing_m));
    const auto [cell, is_new] =
        index_of_cell.try_emplace(x * (std::int64_t{1} << 32) + y, thinned.size());
    if (is_new) {
      thinned.push_back(position);
      counts.push_back(1.0);
    } else {
      thinned[cell->second] += position;
      counts[cell->second] += 1.0;
    }
  }
  for (std::size_t i = 0; i < thinned.size(); ++i) thinned[i] /= counts[i];
  return thinned;
}

}  // namespace masked_mapper
