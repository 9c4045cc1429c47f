// SPDX-License-Identifier: BSD-3-Clause
// Putting planned floors together into a building.
#pragma once

#include <Eigen/Core>

#include "floor_planner.hpp"
#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// Adds a floor above those there, and its landings to the elevators and stairs that it names.
/// Stairs take their lower landing from the first of their two floors.
void AddFloor(Building& building, const FloorPlanner::Planned& planned);

/// The middle of the way of stairs that a StairwellPlan makes: around the half-way landing.
std::vector<Eigen::Vector2d> StairwellWay(const StairwellPlan& plan);

/// The way-point of a floor that is nearest to a position.
std::size_t NearestWayPoint(const FloorPlan& floor, const Eigen::Vector2d& position);

}  // namespace masked_mapper
