// SPDX-License-Identifier: BSD-3-Clause
// Where in a map the clouds of its log stand, and which of them are worth taking.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

class CloudPoses {
 public:
  /// `floor`: the only one that is wanted; empty: all. The map must outlive it.
  CloudPoses(const BuildingMap& map, const CloudSpacing& spacing, std::optional<FloorId> floor);

  /// For clouds in the log's order, by LevelledCloud::log_stamp. Null: the map has no such scan, it
  /// was taken between floors, or too near the last.
  const TrajectoryPose* Take(double log_stamp);
  /// The same for clouds that the map keeps, by their place in the trajectory.
  const TrajectoryPose* TakeAt(std::size_t trajectory_index);
  /// World from the level frame of a cloud; z from the elevation of the pose's floor.
  Eigen::Isometry3d T_world_level(const TrajectoryPose& pose) const;

  const CloudCounts& counts() const { return counts_; }

 private:
  const TrajectoryPose* TakeIfApart(const TrajectoryPose& pose);

  const BuildingMap& map_;
  CloudSpacing spacing_;
  std::optional<FloorId> floor_;
  std::unordered_map<std::int64_t, std::size_t> poses_;  ///< in the trajectory, by microseconds
  const TrajectoryPose* last_ = nullptr;
  CloudCounts counts_;
};

}  // namespace masked_mapper
