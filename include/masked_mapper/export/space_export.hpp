// SPDX-License-Identifier: BSD-3-Clause
// What a 3D lidar saw, in space, at the map's optimised poses and its floors' elevations: as
// points, and as what is free and what is not. The clouds are those of the log, read once more, or
// those that the map keeps, which are fewer and thinned.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/octree.hpp"
#include "masked_mapper/rendering/space_votes.hpp"
#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

/// Of clouds taken while the robot hardly moves one is enough.
struct CloudSpacing {
  double distance_m = 0.15;  ///< travel from one cloud that is taken to the next
  double angle_deg = 10.0;   ///< or turn, whichever comes first
};

/// Those that a map keeps were chosen by the way between them already, as the wheels told it: none
/// is too near.
constexpr CloudSpacing kSpacingOfKept{0.15, 10.0};

/// The clouds that a map keeps: `take(cloud, trajectory_index)` of one of `stride`, in order.
/// Throws InputError at one that is damaged.
void ForEachKeptCloud(const BuildingMap& map, std::size_t stride,
                      const std::function<void(const LevelledCloud&, std::size_t)>& take);

/// Of the clouds of a log.
struct CloudCounts {
  std::size_t taken = 0;
  std::size_t unknown = 0;  ///< of stamps that the map does not have
};

/// Of what is free and what is not.
struct SpaceOccupancyOptions {
  SpaceVoteOptions votes;
  double max_range_m = 30.0;  ///< farther returns are left out
  CloudSpacing spacing{0.3, 20.0};
  std::optional<FloorId> floor;  ///< empty: all
  HeightBand heights;            ///< of the octree, in world
  double memory_mib = 1280.0;    ///< of votes; floors for which it is too little wait
};

/// Above the floor, m: what stands there is in a robot's way.
struct RobotHeights {
  double low_m = 0.1;   ///< lower is a threshold that it drives over, or the floor
  double high_m = 1.0;  ///< higher it passes below
};

/// What is free and what is not in the building, in space: an octree of all floors, and grids of
/// each as a robot of some height meets it.
class SpaceOccupancy {
 public:
  /// The map must outlive it.
  SpaceOccupancy(const BuildingMap& map, const SpaceOccupancyOptions& options);
  ~SpaceOccupancy();

  /// Clouds of the map's log in its order. Throws InputError when one floor alone needs more memory
  /// than there may be.
  void Add(const LevelledCloud& cloud);
  /// One of those that the map keeps, in their order.
  void Add(const LevelledCloud& cloud, std::size_t trajectory_index);
  /// After the last cloud of the log: true when floors wait for it to be read once more.
  bool Finish();

  /// What the votes of a floor say of a place in world, once all is seen.
  Cell At(FloorId floor, const Eigen::Vector3d& place_in_world) const;

  CloudCounts clouds() const;  ///< of this pass of the log
  double peak_mib() const;     ///< of votes and what was made of them

  /// Of all floors. Throw std::runtime_error when a file cannot be written.
  void WriteOctree(const std::filesystem::path& path) const;
  /// `stem`.pgm and `stem`.yaml.
  void WriteGrid(FloorId floor, const RobotHeights& heights,
                 const std::filesystem::path& stem) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Of points.
struct SpaceExportOptions {
  double voxel_m = 0.05;      ///< of each voxel one point, the mean of what was seen in it
  double max_range_m = 30.0;  ///< farther returns are left out
  CloudSpacing spacing;
  std::uint32_t least_hits = 2;  ///< a voxel with fewer is a stray
  std::optional<FloorId> floor;  ///< empty: all
  HeightBand heights;            ///< in world; what lies outside is left out
};

enum class SpaceFormat { kPcd, kPly, kLas };

/// What was seen, as points.
class SpaceExport {
 public:
  /// The map must outlive it.
  SpaceExport(const BuildingMap& map, const SpaceExportOptions& options);
  ~SpaceExport();

  /// Clouds of the map's log in its order. One of a stamp that the map has no pose of, or that was
  /// taken between floors, is left out.
  void Add(const LevelledCloud& cloud);
  /// One of those that the map keeps, in their order.
  void Add(const LevelledCloud& cloud, std::size_t trajectory_index);

  CloudCounts clouds() const;
  std::size_t voxels() const;
  /// Without the points in which `seen_through` (unless null) saw nothing but free space: those of
  /// who walked by. The number of points in the file. Throws std::runtime_error when it cannot be
  /// written.
  std::size_t Write(SpaceFormat format, const std::filesystem::path& path,
                    const SpaceOccupancy* seen_through) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
