// SPDX-License-Identifier: BSD-3-Clause
#include "visit_agreement.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

constexpr double kPointSpacing = 0.2;  // m between points that are asked about

enum class Word { kNothing, kMet, kThrough };

// What one scan says of a point. Beams beside the one that is asked count too: a wall's edge is met
// or missed by a degree.
Word WordOf(const LaserScan& scan, const Eigen::Vector2d& in_laser, double tolerance_m) {
  const double range = in_laser.norm();
  const double turn = WrapAngle(std::atan2(in_laser.y(), in_laser.x()) - scan.first_angle);
  const double beams = scan.angle_step < 0.0
                           ? WrapAngle(turn) / scan.angle_step
                           : (turn < 0.0 ? turn + 2.0 * kPi : turn) / scan.angle_step;
  const auto middle = static_cast<std::ptrdiff_t>(std::lround(beams));
  const auto count = static_cast<std::ptrdiff_t>(scan.size());
  if (middle < 1 || middle + 1 >= count) return Word::kNothing;
  bool through = true;
  for (std::ptrdiff_t beam = middle - 1; beam <= middle + 1; ++beam) {
    const float measured = scan.ranges[static_cast<std::size_t>(beam)];
    if (std::isnan(measured)) {
      through = false;
      continue;
    }
    if (std::abs(measured - range) <= tolerance_m) return Word::kMet;
    through = through && std::min(measured, scan.max_range) > range + tolerance_m &&
              scan.IsHit(static_cast<std::size_t>(beam));
  }
  return through ? Word::kThrough : Word::kNothing;
}

/// A visit whose scan is asked about many points.
struct Asked {
  Asked(const Visit& visit, const LaserScan& asked_scan)
      : to_robot(Inverse(visit.T_world_robot)),
        to_laser(Inverse(asked_scan.T_robot_laser)),
        scan(asked_scan) {}

  PointTransform to_robot;  ///< from world
  PointTransform to_laser;  ///< from robot
  const LaserScan& scan;
};

}  // namespace

std::vector<Visit> VisitsOf(const BuildingMap& map) {
  std::vector<double> travelled(map.trajectory.size(), 0.0);
  for (std::size_t i = 1; i < travelled.size(); ++i) {
    travelled[i] = travelled[i - 1] +
                   Distance(map.trajectory[i - 1].T_odom_robot, map.trajectory[i].T_odom_robot);
  }
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < map.kept_scans.size(); ++i) {
    const std::size_t index = map.kept_scans[i].trajectory_index;
    const TrajectoryPose& pose = map.trajectory[index];
    if (pose.in_transit) continue;
    visits.push_back(
        {i, DriveOfPose(map, index), pose.floor, pose.T_world_robot, travelled[index]});
  }
  return visits;
}

Agreement AgreementOf(const BuildingMap& map, const Visit& newer, const std::vector<Visit>& older,
                      double range_m, double tolerance_m) {
  Agreement agreement;
  const ScanPoints::ConstPtr points = PointsInRobot(map.kept_scans[newer.kept].scan);
  const PointTransform to_world(newer.T_world_robot);
  std::vector<Asked> asked;
  asked.reserve(older.size());
  for (const Visit& other : older) asked.emplace_back(other, map.kept_scans[other.kept].scan);
  Eigen::Vector2d last(1e9, 1e9);
  for (const pcl::PointXY& point : *points) {
    const Eigen::Vector2d in_newer(point.x, point.y);
    if (in_newer.norm() > range_m || (in_newer - last).norm() < kPointSpacing) continue;
    last = in_newer;
    const Eigen::Vector2d in_world = to_world * in_newer;
    Word word = Word::kNothing;
    for (const Asked& other : asked) {
      const Eigen::Vector2d in_older = other.to_robot * in_world;
      if (in_older.norm() > range_m) continue;
      const Word said = WordOf(other.scan, other.to_laser * in_older, tolerance_m);
      if (said == Word::kMet) {
        word = Word::kMet;
        break;
      }
      if (said == Word::kThrough) word = Word::kThrough;
    }
    agreement.met += word == Word::kMet ? 1 : 0;
    agreement.through += word == Word::kThrough ? 1 : 0;
  }
  return agreement;
}

}  // namespace masked_mapper
