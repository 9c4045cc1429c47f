// SPDX-License-Identifier: BSD-3-Clause
#include "report_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud_poses.hpp"
#include "masked_mapper/export/space_export.hpp"
#include "report_columns.hpp"
#include "voxel_cloud.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 700000;
constexpr double kFinestVoxel = 0.1;  // m
constexpr double kCoarser = 1.25;     // from one size of voxels to the next
constexpr double kFarthest = 20.0;    // m; farther, a lidar's rings are metres apart
// Heights above the floor of what is a building's; the rest is seen through windows and shafts.
constexpr double kLowest = -0.5;  // m
constexpr double kHighest = 6.0;  // m
// Of the points in all clouds: a building is seen a hundred times, and a few times are enough here.
constexpr std::size_t kMostLookedAt = 4000000;
constexpr double kBytesPerPoint = 1.5;  // of packed clouds, about
constexpr double kFinestStep = 0.01;    // m, of coordinates in the page
constexpr std::uint32_t kLeastHits = 2;

/// One of so many is looked at.
struct Strides {
  std::size_t clouds = 1;
  std::size_t points = 1;  ///< of such a cloud
};

Strides StridesOf(const BuildingMap& map) {
  std::size_t bytes = 0;
  for (const KeptCloud& kept : map.kept_clouds) bytes += kept.packed->size();
  const double too_many =
      static_cast<double>(bytes) / kBytesPerPoint / static_cast<double>(kMostLookedAt);
  if (too_many <= 1.0) return {};
  // Most of the work is to unpack: rather few clouds than few points of each.
  const double of_clouds = std::ceil(std::sqrt(2.0 * too_many));
  return {static_cast<std::size_t>(of_clouds),
          static_cast<std::size_t>(std::ceil(too_many / of_clouds))};
}

/// z above the point's floor.
VoxelCloud PointsOf(const BuildingMap& map) {
  VoxelCloud voxels(kFinestVoxel);
  CloudPoses poses(map, kSpacingOfKept, {});
  const Strides strides = StridesOf(map);
  std::size_t next = 0;  // of the points, on from cloud to cloud
  ForEachKeptCloud(map, strides.clouds,
                   [&](const LevelledCloud& cloud, std::size_t trajectory_index) {
                     const TrajectoryPose* const pose = poses.TakeAt(trajectory_index);
                     if (pose == nullptr) return;
                     Eigen::Isometry3d T_floor_level = poses.T_world_level(*pose);
                     T_floor_level.translation().z() = 0.0;
                     SpacePoint point;
                     point.label = static_cast<std::uint32_t>(pose->floor);
                     const Eigen::Vector3f lidar = cloud.lidar.cast<float>();
                     for (; next < cloud.points.size(); next += strides.points) {
                       const Eigen::Vector3f& seen = cloud.points[next].position;
                       if ((seen - lidar).norm() > static_cast<float>(kFarthest)) continue;
                       point.position = T_floor_level * seen.cast<double>();
                       if (point.position.z() < kLowest || point.position.z() > kHighest) continue;
                       voxels.Add(point);
                     }
                     next -= cloud.points.size();
                   });
  return voxels;
}

/// The same in voxels so large that they are few enough; `voxel_m` becomes their side.
std::vector<SpacePoint> Thinned(std::vector<SpacePoint> points, double* voxel_m) {
  while (points.size() > kMostPoints) {
    *voxel_m *= kCoarser;
    VoxelCloud coarser(*voxel_m);
    for (const SpacePoint& point : points) coarser.Add(point);
    points = coarser.Points(1);
  }
  return points;
}

Json FloorJson(const std::vector<SpacePoint>& points, std::uint32_t floor) {
  std::vector<const SpacePoint*> own;
  Eigen::AlignedBox3d extent;
  for (const SpacePoint& point : points) {
    if (point.label != floor) continue;
    extent.extend(point.position);
    own.push_back(&point);
  }
  const Eigen::Vector3d origin = own.empty() ? Eigen::Vector3d::Zero().eval() : extent.min();
  const double step =
      own.empty() ? kFinestStep : std::max(kFinestStep, extent.sizes().maxCoeff() / 65535.0);
  std::vector<std::uint16_t> xyz;
  xyz.reserve(3 * own.size());
  for (const SpacePoint* const point : own) {
    for (int axis = 0; axis < 3; ++axis) {
      xyz.push_back(Quantised(point->position(axis) - origin(axis), step));
    }
  }
  return {{"count", own.size()},
          {"origin", {origin.x(), origin.y(), origin.z()}},
          {"step_m", step},
          {"xyz_u16", Base64(xyz)}};
}

}  // namespace

Json SpaceJson(const BuildingMap& map) {
  double voxel_m = kFinestVoxel;
  const std::vector<SpacePoint> points = Thinned(PointsOf(map).Points(kLeastHits), &voxel_m);
  Json floors = Json::array();
  for (std::size_t floor = 0; floor < map.graph.floors().size(); ++floor) {
    floors.push_back(FloorJson(points, static_cast<std::uint32_t>(floor)));
  }
  return {{"voxel_m", voxel_m}, {"floors", std::move(floors)}};
}

}  // namespace masked_mapper
