// SPDX-License-Identifier: BSD-3-Clause
// Where a robot drove through what it saw as a wall on another visit. Floors of one plan agree in
// nearly all that is seen of them, and a visit that lies wrong may agree in much: a wall that was
// driven through is no matter of shares.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "visit_agreement.hpp"

namespace masked_mapper {

struct WallCrossing {
  std::size_t driven = 0;         ///< the visit that drove there, in `visits`
  std::vector<std::size_t> seen;  ///< those that saw a wall, kLeastSeen or more, in order
};

/// Scans that see a wall where there is one: in fewer, it was somebody who stood there.
constexpr std::size_t kLeastSeen = 3;

/// A place on a floor.
struct FloorPlace {
  FloorId floor = 0;
  Eigen::Vector2d in_world{0.0, 0.0};  ///< m
};

/// Where the robot left a floor for another, or reached it. There doors of cabs open and close.
std::vector<FloorPlace> DoorsOf(const BuildingMap& map);

/// Of every pass through a wall one, in the order of driving, but for those at `doors`. `visits`:
/// of `map`, in its order, wherever they are put; `are_asked`: whether the one may have driven
/// through what the other saw.
std::vector<WallCrossing> FindWallCrossings(
    const BuildingMap& map, const std::vector<Visit>& visits, const std::vector<FloorPlace>& doors,
    const std::function<bool(std::size_t driven, std::size_t seen)>& are_asked);

/// Of the whole map as it is, between any two visits.
std::vector<WallCrossing> FindWallCrossings(const BuildingMap& map,
                                            const std::vector<Visit>& visits);

}  // namespace masked_mapper
