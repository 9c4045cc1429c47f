// SPDX-License-Identifier: BSD-3-Clause
// The clouds that a map keeps, one after the other.
#pragma once

#include <cstddef>
#include <functional>

#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

/// They were chosen by the way between them already, as the wheels told it: none is too near.
constexpr CloudSpacing kSpacingOfKept{0.15, 10.0};

/// `take(cloud, trajectory_index)` of one of `stride`, in order. Throws InputError at one that is
/// damaged.
void ForEachKeptCloud(const BuildingMap& map, std::size_t stride,
                      const std::function<void(const LevelledCloud&, std::size_t)>& take);

}  // namespace masked_mapper
