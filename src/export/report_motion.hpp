// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// The motion path may start anywhere; as drawn it starts where the map does.
Pose2 WorldFromOdometry(const BuildingMap& result);

/// A few of the points that the kept scans hit, so that the map before optimisation can be drawn.
nlohmann::ordered_json ScansJson(const BuildingMap& result, const Pose2& T_world_odom,
                                 double max_range_m);

/// The trajectory before and after optimisation, no finer than can be seen.
nlohmann::ordered_json TrajectoryJson(const BuildingMap& result, const Pose2& T_world_odom);

}  // namespace masked_mapper
