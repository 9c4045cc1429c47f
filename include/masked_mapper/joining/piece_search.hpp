// SPDX-License-Identifier: BSD-3-Clause
// Whether one piece of a map is of the same building as another, and where it lies in it, with no
// prior at all. Places of the newer piece are looked for on whole floors of the older one; a
// transform is believed when many places far apart agree on it, when they are most of those that
// lie within the older piece, and when no other transform and no other pairing of floors explains
// them nearly as well. Ours.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/scan_matching/floor_search.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

/// When drives of several logs are of one building (joining/piece_search.hpp, drive_joining.hpp).
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
  int places_needed = 2;   ///< stands for the validator's: where the drive lies is known already
  double reach_m = 4.0;    ///< from a node to those that it is offered to
  double sigma_m = 0.5;    ///< of where the places put it
  double sigma_deg = 2.0;  ///< and of the heading
  GridOptions seen;        ///< how free space is told, that a place may not stand against
};

/// How a piece lies in another.
struct PiecePlacement {
  Pose2 T_older_newer;
  std::map<FloorId, FloorId> older_floor_of;  ///< of floors of the newer piece that were met again
  int fitting = 0;                            ///< places
  int within = 0;                             ///< places that lie within the older piece
};

struct PieceSearchResult {
  std::optional<PiecePlacement> placement;
  std::string reason;  ///< for people: why there is one, or none
};

/// Stretches of the way driven.
struct MapPart {
  std::vector<IndexRange> nodes;
  std::vector<IndexRange> poses;
};

/// The newer part lies already where motion puts it, as far off as this.
struct PiecePrior {
  Pose2 T_world_anchor;     ///< where it is known best
  double within_m = 2.0;    ///< there
  double within_deg = 8.0;  ///< of the heading
};

/// Two parts of one map. The newer one's floors are none of the older one's.
struct PieceQuestion {
  MapPart older;
  MapPart newer;
  std::vector<FloorId> is_floor;  ///< what each floor counts as, where some are one; empty: itself
  std::optional<PiecePrior> prior;  ///< without it: anywhere
};

PieceSearchResult FindPiece(const BuildingMap& map, const PieceQuestion& question,
                            const DriveJoinOptions& options, const MatcherOptions& matcher);

/// Drives of the pieces, by place in `map.drives`; pieces have no floor in common. Floors whose
/// labels were given are one only when they are called alike; others when their heights over each
/// other allow it, as far as they were measured. Same result at any number of threads.
PieceSearchResult FindPiece(const BuildingMap& map, const std::vector<std::size_t>& older,
                            const std::vector<std::size_t>& newer, const DriveJoinOptions& options,
                            const MatcherOptions& matcher);

}  // namespace masked_mapper
