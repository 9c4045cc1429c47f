// SPDX-License-Identifier: BSD-3-Clause
// What of a finished map does not hold. Two visits of one place must have seen the same: where one
// saw through what the other calls a wall, one of them lies wrong. A closure or a way that the
// solved graph has to bend by far more than it may be off contradicts the rest. A map without
// doubts is one that can be trusted. Ours.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

enum class DoubtKind {
  kWalls,    ///< two visits of one place do not see the same walls
  kClosure,  ///< a closure that the rest of the map contradicts
  kMotion,   ///< a way between two nodes that the rest of the map contradicts
  kApart,    ///< a drive that nothing ties to the others
  kFloor,    ///< a floor that may be another one, for all that is known
};

struct Doubt {
  DoubtKind kind = DoubtKind::kWalls;
  FloorId floor = 0;
  double x = 0.0;       ///< m, in the world
  double y = 0.0;       ///< m
  double t_a = 0.0;     ///< s, the span of the drive that it is about
  double t_b = 0.0;     ///< s
  double size_m = 0.0;  ///< by how much the two sides disagree, as far as that can be told
  std::string text;     ///< for people
  std::string edit;     ///< the line of edits.yaml that would mend it; empty: none is known
};

/// "walls", "closure", "motion", "apart", "floor".
const char* Name(DoubtKind kind);

/// In order of kinds, then of stamps.
std::vector<Doubt> FindDoubts(const BuildingMap& map);

/// Ways to another floor that nothing told of: those that part, as few as possible, visits of one
/// floor of which one drove through walls that the other saw. In order, not overlapping. `heard`:
/// when nothing can have gone unnoticed.
std::vector<TimeSpan> FindUnnoticedChanges(const BuildingMap& map,
                                           const std::vector<TimeSpan>& heard);

/// If floor `newer` were floor `older`, and lay there as `T_older_newer` says: how often a way on
/// the one would lead through a wall that was seen on the other.
std::size_t WallsDrivenThrough(const BuildingMap& map, FloorId older, FloorId newer,
                               const Pose2& T_older_newer);

}  // namespace masked_mapper
