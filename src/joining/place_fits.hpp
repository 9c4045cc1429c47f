// SPDX-License-Identifier: BSD-3-Clause
// Places of one part of a map held against floors of another: how well each fits where a guess puts
// it, by what the two have both seen.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"
#include "piece_search.hpp"

namespace masked_mapper {

MapPart PartOfDrives(const BuildingMap& map, const std::vector<std::size_t>& drives);

/// A floor of the older part.
struct OldFloor {
  FloorId id = 0;
  SearchableFloor scene;
  std::vector<Eigen::Vector2d> way_in_world;  ///< where the robot was
};

/// What the newer part saw around one of its poses.
struct Place {
  FloorId floor = 0;
  Pose2 T_world_place;
  std::vector<Eigen::Vector2d> coarse_points;  ///< in the place's frame
  std::vector<Eigen::Vector2d> fine_points;
};

class PlaceFits {
 public:
  /// All outlive this. `is_floor`: what each floor of the map counts as, where some are one; empty:
  /// each as itself.
  PlaceFits(const BuildingMap& map, const DriveJoinOptions& options, const MatcherOptions& matcher,
            std::vector<FloorId> is_floor = {});

  void ReadFloors(const MapPart& older);
  /// At nodes, of which masks make few, or all along the way.
  void ReadPlacesAtNodes(const MapPart& newer);
  void ReadPlacesAlongTheWay(const MapPart& newer);

  const std::vector<OldFloor>& floors() const { return floors_; }
  const std::vector<Place>& places() const { return places_; }

  /// The place near a guess, and its score by those of its points that lie where the older part has
  /// seen something: drives share a part of their ways only. Empty when those are too few.
  std::optional<PlaceFit> FitOf(const Place& place, FloorId older, const Pose2& T_older_newer,
                                double within_m) const;

  /// Whether the older part's robot was there, too, and not only saw it from afar.
  bool WasPassed(FloorId older, const Pose2& T_world_place) const;

  /// m between the two places farthest apart.
  double SpreadOf(const std::vector<std::size_t>& places) const;

 private:
  const Node& At(NodeId node) const { return map_.graph.nodes()[static_cast<std::size_t>(node)]; }
  FloorId CountsAs(FloorId floor) const;
  IndexRange KeptOf(const IndexRange& poses) const;
  const OldFloor& OldFloorOf(FloorId older) const;
  const TrajectoryPose& PoseOf(std::size_t kept) const;
  ScanPoints::ConstPtr StretchAround(NodeId node, double half_length_m) const;
  ScanPoints::ConstPtr StretchAround(const IndexRange& kept, std::size_t middle,
                                     double half_length_m) const;
  void AddPlace(FloorId floor, const Pose2& T_world_place, const ScanPoints& wide,
                const ScanPoints& near);

  const BuildingMap& map_;
  const DriveJoinOptions& joins_;
  const MatcherOptions& matcher_;
  std::vector<FloorId> is_floor_;
  std::vector<OldFloor> floors_;
  std::vector<Place> places_;
};

}  // namespace masked_mapper
