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

#include "masked_mapper/joining/joining_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

/// How a piece lies in another.
struct PiecePlacement {
  Pose2 T_older_newer;
  std::map<FloorId, FloorId> older_floor_of;  ///< of floors of the newer piece that were met again
  int fitting = 0;                            ///< places
  int within = 0;                             ///< places that lie within the older piece
};

struct PieceSearchResult {
  std::optional<PiecePlacement> placement;
  std::string reason;                ///< for people: why there is one, or none
  std::vector<PiecePlacement> ways;  ///< in which it fits, none clearly better; one: `placement`
};

/// Stretches of the way driven.
struct MapPart {
  std::vector<IndexRange> nodes;
  std::vector<IndexRange> poses;
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
