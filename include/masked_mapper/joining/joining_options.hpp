// SPDX-License-Identifier: BSD-3-Clause
// When drives of several logs, or visits of floors that no sensor tells apart, are one.
#pragma once

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/scan_matching/floor_search.hpp"

namespace masked_mapper {

/// When drives of several logs are of one building.
struct DriveJoinOptions {
  FloorSearchOptions search;
  double stretch_m = 12.0;       ///< travel before and after a node that makes it a place
  double place_spacing_m = 3.0;  ///< between places
  int searched_places = 24;      ///< looked for everywhere; the others only where those say
  double min_score = 0.7;        ///< 0-1, of a place that fits
  double agree_m = 1.0;          ///< between a place and where all of them together put it
  int min_places = 4;            ///< that fit and agree
  double min_share = 0.4;        ///< of the places that lie within the older map
  double min_spread_m = 8.0;     ///< between the two places farthest apart
  double clear_lead = 0.05;      ///< of score, by which a place speaks against another way to join
  double reach_m = 4.0;          ///< from a node to those that it is offered to
  double sigma_m = 0.5;          ///< of where the places put it
  double sigma_deg = 2.0;        ///< and of the heading
  GridOptions seen;              ///< how free space is told, that a place may not stand against
};

/// The newer part lies already where motion puts it, as far off as this.
struct PiecePrior {
  Pose2 T_world_anchor;     ///< where it is known best
  double within_m = 2.0;    ///< there
  double within_deg = 8.0;  ///< of the heading
};

/// When two visits of floors that no sensor tells apart are one floor.
struct FloorJoinOptions {
  DriveJoinOptions places = PlacesOfOneDrive();
  PiecePrior ride;  ///< how far a ride may throw the robot's pose off

  /// Of places where motion has put the level already, fewer and nearer ones suffice, but most of
  /// them have to fit: a floor is seen whole, where drives share a part of their ways.
  static DriveJoinOptions PlacesOfOneDrive();
};

}  // namespace masked_mapper
