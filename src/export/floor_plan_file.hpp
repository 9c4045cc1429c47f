// SPDX-License-Identifier: BSD-3-Clause
// Floor plans of lines: walls, named places, kept-out areas, stops of elevators and stairs; metres
// in world, one layer per floor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/wall_lines.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

struct PlanLayer {
  FloorId floor = 0;
  std::vector<WallLine> walls;
};

/// Drawn 1:100 with y up; a group per floor, which editors show as a layer.
std::string SvgText(const BuildingMap& map, const std::vector<PlanLayer>& layers,
                    const std::vector<Crossing>& crossings);

/// A FeatureCollection; every feature has the properties `floor`, `elevation_m` and `kind` (wall,
/// place, keep_out, elevator, stairs).
std::string GeoJsonText(const BuildingMap& map, const std::vector<PlanLayer>& layers,
                        const std::vector<Crossing>& crossings);

}  // namespace masked_mapper
