// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <cmath>

#include "las_file.hpp"
#include "masked_mapper/geometry/angle.hpp"
#include "point_cloud_file.hpp"

namespace masked_mapper {
namespace {

/// As stamps are written in bags of ours, and finer than sweeps follow each other.
std::int64_t Microseconds(double stamp) { return std::llround(stamp * 1e6); }

}  // namespace

SpaceExport::SpaceExport(const BuildingMap& map, const SpaceExportOptions& options)
    : map_(map), options_(options), voxels_(options.voxel_m) {
  for (std::size_t i = 0; i < map.trajectory.size(); ++i) {
    poses_.emplace(Microseconds(map.trajectory[i].log_stamp), i);
  }
}

void SpaceExport::Add(const LevelledCloud& cloud) {
  const auto known = poses_.find(Microseconds(cloud.log_stamp));
  if (known == poses_.end()) {
    ++unknown_;
    return;
  }
  const TrajectoryPose& pose = map_.trajectory[known->second];
  if (pose.in_transit || (options_.floor && *options_.floor != pose.floor)) return;
  if (last_) {
    const TrajectoryPose& before = map_.trajectory[*last_];
    const double turned = WrapAngle(pose.T_world_robot.theta - before.T_world_robot.theta);
    if (before.floor == pose.floor &&
        Distance(before.T_world_robot, pose.T_world_robot) < options_.distance_m &&
        std::abs(turned) < DegToRad(options_.angle_deg)) {
      return;
    }
  }
  last_ = known->second;
  ++clouds_;
  const double elevation = map_.graph.floors()[static_cast<std::size_t>(pose.floor)].elevation;
  const double cosine = std::cos(pose.T_world_robot.theta);
  const double sine = std::sin(pose.T_world_robot.theta);
  const Eigen::Vector3f lidar = cloud.lidar.cast<float>();
  SpacePoint point;
  point.stamp = cloud.log_stamp;
  point.label = static_cast<std::uint32_t>(pose.floor);
  for (const CloudPoint& seen : cloud.points) {
    if ((seen.position - lidar).norm() > static_cast<float>(options_.max_range_m)) continue;
    const Eigen::Vector3d p = seen.position.cast<double>();
    point.position = {pose.T_world_robot.x + cosine * p.x() - sine * p.y(),
                      pose.T_world_robot.y + sine * p.x() + cosine * p.y(), elevation + p.z()};
    if (point.position.z() < options_.heights.low_m ||
        point.position.z() > options_.heights.high_m) {
      continue;
    }
    point.intensity = seen.intensity;
    voxels_.Add(point);
  }
}

void SpaceExport::Write(SpaceFormat format, const std::filesystem::path& path) const {
  const std::vector<SpacePoint> points = voxels_.Points(options_.least_hits);
  const std::vector<Colour> colours = FloorColours(map_.graph.floors());
  switch (format) {
    case SpaceFormat::kPcd:
      WriteSpacePcd(points, colours, path);
      break;
    case SpaceFormat::kPly:
      WriteSpacePly(points, colours, path);
      break;
    case SpaceFormat::kLas:
      WriteLas(points, colours, path);
      break;
  }
}

}  // namespace masked_mapper
