// SPDX-License-Identifier: BSD-3-Clause
#include "report_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "report_columns.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxScanPoints = 500000;
constexpr std::size_t kMaxTrajectoryPoses = 30000;

// Whether a scan is the first of a drive after the first.
bool BeginsDrive(const BuildingMap& result, std::size_t pose) {
  return std::any_of(result.drives.begin(), result.drives.end(),
                     [&](const Drive& drive) { return pose > 0 && drive.first_pose == pose; });
}

// The poses to draw: where floors change or drives begin and end, and otherwise after `step` metres
// or some turning.
std::vector<std::size_t> DrawnPoses(const BuildingMap& result, double step) {
  const std::vector<TrajectoryPose>& trajectory = result.trajectory;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryPose& pose = trajectory[i];
    const bool is_end = BeginsDrive(result, i) || BeginsDrive(result, i + 1);
    if (!drawn.empty() && i + 1 < trajectory.size() && !is_end) {
      const TrajectoryPose& last = trajectory[drawn.back()];
      const bool same_place = pose.floor == last.floor && pose.in_transit == last.in_transit;
      if (same_place && Distance(last.T_odom_robot, pose.T_odom_robot) < step &&
          Distance(last.T_world_robot, pose.T_world_robot) < step) {
        continue;
      }
    }
    drawn.push_back(i);
  }
  return drawn;
}

}  // namespace

Pose2 WorldFromOdometry(const BuildingMap& result) {
  if (!result.graph.nodes().empty()) {
    const Node& first = result.graph.nodes().front();
    return first.T_world_robot * Inverse(first.T_odom_robot);
  }
  if (result.trajectory.empty()) return {};
  const TrajectoryPose& first = result.trajectory.front();
  return first.T_world_robot * Inverse(first.T_odom_robot);
}

Json ScansJson(const BuildingMap& result, const Pose2& T_world_odom, double max_range_m) {
  std::size_t hits = 0;
  for (const KeptScan& kept : result.kept_scans) hits += kept.scan.size();
  const std::size_t stride = std::max<std::size_t>(1, (hits + kMaxScanPoints - 1) / kMaxScanPoints);
  const double step = std::max(max_range_m, 1.0) * 1.1 / 32767.0;  // the scanner is off centre

  PoseColumns poses;
  std::vector<std::uint16_t> floors;
  std::vector<std::uint32_t> counts;
  std::vector<std::int16_t> xy;
  std::size_t place = 0;
  for (const KeptScan& kept : result.kept_scans) {
    const TrajectoryPose& pose = result.trajectory.at(kept.trajectory_index);
    if (pose.in_transit) continue;
    std::uint32_t count = 0;
    BeamSweep direction = BeamSweep::InRobot(kept.scan);
    for (std::size_t beam = 0; beam < kept.scan.size(); ++beam, direction.Advance()) {
      if (place++ % stride != 0 || !kept.scan.IsHit(beam)) continue;
      const auto range = static_cast<double>(kept.scan.ranges[beam]);
      if (range > max_range_m) continue;
      const Eigen::Vector2d point_in_robot =
          kept.scan.T_robot_laser.Translation() + range * direction.Current();
      xy.push_back(QuantisedSigned(point_in_robot.x(), step));
      xy.push_back(QuantisedSigned(point_in_robot.y(), step));
      ++count;
    }
    if (count == 0) continue;
    poses.Add(T_world_odom * pose.T_odom_robot, pose.T_world_robot);
    floors.push_back(static_cast<std::uint16_t>(pose.floor));
    counts.push_back(count);
  }
  Json json = {{"count", counts.size()},
               {"step_m", step},
               {"floor_u16", Base64(floors)},
               {"points_u32", Base64(counts)},
               {"xy_i16", Base64(xy)}};
  poses.WriteTo(json);
  return json;
}

Json TrajectoryJson(const BuildingMap& result, const Pose2& T_world_odom) {
  const std::vector<TrajectoryPose>& trajectory = result.trajectory;
  double step = 0.1;
  std::vector<std::size_t> drawn = DrawnPoses(result, step);
  while (drawn.size() > kMaxTrajectoryPoses && step < 10.0) {
    step *= 1.5;
    drawn = DrawnPoses(result, step);
  }
  PoseColumns poses;
  std::vector<double> stamps;
  std::vector<std::uint16_t> floors;
  std::vector<std::uint8_t> in_transit;
  std::vector<std::size_t> breaks;  // no way leads here from the one before
  for (const std::size_t i : drawn) {
    const TrajectoryPose& pose = trajectory[i];
    if (BeginsDrive(result, i)) breaks.push_back(stamps.size());
    stamps.push_back(pose.stamp);
    floors.push_back(static_cast<std::uint16_t>(pose.floor));
    in_transit.push_back(pose.in_transit ? 1 : 0);
    poses.Add(T_world_odom * pose.T_odom_robot, pose.T_world_robot);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (BeginsDrive(result, i)) continue;
    length += Distance(trajectory[i - 1].T_world_robot, trajectory[i].T_world_robot);
  }
  Json json = {{"count", drawn.size()},
               {"length_m", length},
               {"stamp_f64", Base64(stamps)},
               {"floor_u16", Base64(floors)},
               {"in_transit_u8", Base64(in_transit)}};
  if (!breaks.empty()) json["breaks"] = breaks;
  poses.WriteTo(json);
  return json;
}

}  // namespace masked_mapper
