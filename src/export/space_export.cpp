// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <algorithm>
#include <vector>

#include "cloud_poses.hpp"
#include "las_file.hpp"
#include "point_cloud_file.hpp"
#include "voxel_cloud.hpp"

namespace masked_mapper {

class SpaceExport::Impl {
 public:
  Impl(const BuildingMap& map, const SpaceExportOptions& options);

  CloudPoses& poses() { return poses_; }
  /// At a pose of `poses()`; null: nowhere.
  void Add(const LevelledCloud& cloud, const TrajectoryPose* pose);
  CloudCounts clouds() const { return poses_.counts(); }
  std::size_t voxels() const { return voxels_.size(); }
  std::size_t Write(SpaceFormat format, const std::filesystem::path& path,
                    const SpaceOccupancy* seen_through) const;

 private:
  const BuildingMap& map_;
  SpaceExportOptions options_;
  CloudPoses poses_;
  VoxelCloud voxels_;
};

SpaceExport::Impl::Impl(const BuildingMap& map, const SpaceExportOptions& options)
    : map_(map),
      options_(options),
      poses_(map, options.spacing, options.floor),
      voxels_(options.voxel_m) {}

void SpaceExport::Impl::Add(const LevelledCloud& cloud, const TrajectoryPose* pose) {
  if (pose == nullptr) return;
  const Eigen::Isometry3d T_world_level = poses_.T_world_level(*pose);
  const Eigen::Vector3f lidar = cloud.lidar.cast<float>();
  SpacePoint point;
  point.stamp = cloud.log_stamp;
  point.label = static_cast<std::uint32_t>(pose->floor);
  for (const CloudPoint& seen : cloud.points) {
    if ((seen.position - lidar).norm() > static_cast<float>(options_.max_range_m)) continue;
    point.position = T_world_level * seen.position.cast<double>();
    if (point.position.z() < options_.heights.low_m ||
        point.position.z() > options_.heights.high_m) {
      continue;
    }
    point.intensity = seen.intensity;
    voxels_.Add(point);
  }
}

std::size_t SpaceExport::Impl::Write(SpaceFormat format, const std::filesystem::path& path,
                                     const SpaceOccupancy* seen_through) const {
  std::vector<SpacePoint> points = voxels_.Points(options_.least_hits);
  if (seen_through != nullptr) {
    const auto is_free = [seen_through](const SpacePoint& point) {
      return seen_through->At(static_cast<FloorId>(point.label), point.position) == Cell::kFree;
    };
    points.erase(std::remove_if(points.begin(), points.end(), is_free), points.end());
  }
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
  return points.size();
}

SpaceExport::SpaceExport(const BuildingMap& map, const SpaceExportOptions& options)
    : impl_(std::make_unique<Impl>(map, options)) {}
SpaceExport::~SpaceExport() = default;

void SpaceExport::Add(const LevelledCloud& cloud) {
  impl_->Add(cloud, impl_->poses().Take(cloud.log_stamp));
}
void SpaceExport::Add(const LevelledCloud& cloud, std::size_t trajectory_index) {
  impl_->Add(cloud, impl_->poses().TakeAt(trajectory_index));
}
CloudCounts SpaceExport::clouds() const { return impl_->clouds(); }
std::size_t SpaceExport::voxels() const { return impl_->voxels(); }
std::size_t SpaceExport::Write(SpaceFormat format, const std::filesystem::path& path,
                               const SpaceOccupancy* seen_through) const {
  return impl_->Write(format, path, seen_through);
}

}  // namespace masked_mapper
