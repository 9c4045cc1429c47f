// SPDX-License-Identifier: BSD-3-Clause
// What a finished map knows, made ready for a robot that asks where it is.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"

namespace masked_mapper {

/// Two places that are nearer, in both, are one.
constexpr double kPlaceM = 1.5;
constexpr double kPlaceDeg = 8.0;

/// With so much more doubt along each axis, independent of what there was.
UncertainPose2 Widened(UncertainPose2 T_a_b, double sigma_m, double sigma_deg);
/// Of the position, m.
double SigmaM(const UncertainPose2& T_a_b);

class KnownMap {
 public:
  /// `map` outlives this.
  KnownMap(const BuildingMap& map, const SearchableFloorOptions& options);

  const BuildingMap& map() const { return map_; }

  /// Floors on which anything can be found, in order.
  const std::vector<FloorId>& floors() const { return ids_; }
  /// Null: nothing is ever found on it.
  const SearchableFloor* FloorAt(FloorId floor) const {
    return floor < 0 ? nullptr : floors_[static_cast<std::size_t>(floor)].get();
  }
  /// Those of a floor, a few a metre.
  const std::vector<PosedScan>& ScansOf(FloorId floor) const {
    return scans_[static_cast<std::size_t>(floor)];
  }
  const Floor& Facts(FloorId floor) const { return map_.graph.floor(floor); }

  /// Nodes on a floor within `within_m` of a point in world, the nearest first.
  std::vector<NodeId> NodesNear(FloorId floor, const Eigen::Vector2d& point_in_world,
                                double within_m) const;

  /// Floors to which a ride from `from` may have gone: `climb_m` up, give or take `sigma_m`;
  /// nothing: nobody knows.
  std::vector<FloorId> FloorsReached(FloorId from, std::optional<double> climb_m,
                                     double sigma_m) const;

  /// Natural logarithm of how many places there are to be told apart.
  double LogPlaces() const { return log_places_; }

 private:
  const BuildingMap& map_;
  std::vector<std::vector<PosedScan>> scans_;             ///< by FloorId
  std::vector<std::unique_ptr<SearchableFloor>> floors_;  ///< by FloorId
  std::vector<FloorId> ids_;
  double log_places_ = 0.0;
};

}  // namespace masked_mapper
