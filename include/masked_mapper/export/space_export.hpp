// SPDX-License-Identifier: BSD-3-Clause
// What a 3D lidar saw, as points in space at the map's optimised poses and its floors' elevations.
// The clouds are those of the log, read once more: the map holds the poses, the log the points.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "masked_mapper/export/cloud_poses.hpp"
#include "masked_mapper/export/space_occupancy.hpp"
#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/octree.hpp"
#include "masked_mapper/rendering/voxel_cloud.hpp"

namespace masked_mapper {

struct SpaceExportOptions {
  double voxel_m = 0.05;      ///< of each voxel one point, the mean of what was seen in it
  double max_range_m = 30.0;  ///< farther returns are left out
  CloudSpacing spacing;
  std::uint32_t least_hits = 2;  ///< a voxel with fewer is a stray
  std::optional<FloorId> floor;  ///< empty: all
  HeightBand heights;            ///< in world; what lies outside is left out
};

enum class SpaceFormat { kPcd, kPly, kLas };

class SpaceExport {
 public:
  /// The map must outlive it.
  SpaceExport(const BuildingMap& map, const SpaceExportOptions& options);

  /// Clouds of the map's log in its order. One of a stamp that the map has no pose of, or that was
  /// taken between floors, is left out.
  void Add(const LevelledCloud& cloud);

  const CloudPoses& poses() const { return poses_; }
  std::size_t voxels() const { return voxels_.size(); }
  /// Without the points in which `seen_through` (unless null) saw nothing but free space: those of
  /// who walked by. The number of points in the file. Throws std::runtime_error when it cannot be
  /// written.
  std::size_t Write(SpaceFormat format, const std::filesystem::path& path,
                    const SpaceOccupancy* seen_through) const;

 private:
  const BuildingMap& map_;
  SpaceExportOptions options_;
  CloudPoses poses_;
  VoxelCloud voxels_;
};

}  // namespace masked_mapper
