// SPDX-License-Identifier: BSD-3-Clause
// Whether two visits of one place saw the same. A point of one visit is held against the beams of
// the other: they end at it, pass through it, or say nothing of it.
#pragma once

#include <cstddef>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// A kept scan as a place of the drive.
struct Visit {
  std::size_t kept = 0;  ///< in BuildingMap::kept_scans
  std::size_t drive = 0;
  FloorId floor = 0;
  Pose2 T_world_robot;
  double travelled_m = 0.0;  ///< along the motion path of all drives
};

/// Every kept scan outside transit.
std::vector<Visit> VisitsOf(const BuildingMap& map);

struct Agreement {
  int met = 0;      ///< points of the newer visit at which beams of the older one end
  int through = 0;  ///< through which they pass
  /// Share of the points that are told of, through which beams pass.
  double Contradiction() const {
    return met + through == 0 ? 0.0 : static_cast<double>(through) / (met + through);
  }
};

/// Points of `newer` within `range_m`, against the scans of `older` (visits of one pass), with
/// walls `tolerance_m` apart still the same.
Agreement AgreementOf(const BuildingMap& map, const Visit& newer, const std::vector<Visit>& older,
                      double range_m, double tolerance_m);

}  // namespace masked_mapper
