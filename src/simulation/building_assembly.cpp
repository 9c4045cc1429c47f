// SPDX-License-Identifier: BSD-3-Clause
#include "building_assembly.hpp"

#include <cassert>

namespace masked_mapper {

void AddFloor(Building& building, const FloorPlanner::Planned& planned) {
  const std::size_t floor = building.floors.size();
  building.floors.push_back(planned.floor);
  for (const auto& [elevator, way_point] : planned.elevator_way_points) {
    building.elevators[elevator].landings.push_back({floor, way_point});
  }
  for (const auto& [index, way_point] : planned.stairs_way_points) {
    Stairs& stairs = building.stairs[index];
    // The name marks stairs that already have their lower end.
    if (stairs.name.empty()) {
      stairs.name = "stairs" + std::to_string(index);
      stairs.lower = {floor, way_point};
    } else {
      stairs.upper = {floor, way_point};
    }
  }
}

std::vector<Eigen::Vector2d> StairwellWay(const StairwellPlan& plan) {
  const double y = 0.1 + 0.5 * plan.flight_width;
  const double x = plan.flight_length + 0.5 * plan.landing_depth;
  return {plan.T_building_mouth * Eigen::Vector2d(x, -y),
          plan.T_building_mouth * Eigen::Vector2d(x, y)};
}

std::size_t NearestWayPoint(const FloorPlan& floor, const Eigen::Vector2d& position) {
  assert(!floor.way_points.empty());
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < floor.way_points.size(); ++i) {
    if ((floor.way_points[i].position - position).squaredNorm() <
        (floor.way_points[nearest].position - position).squaredNorm()) {
      nearest = i;
    }
  }
  return nearest;
}

}  // namespace masked_mapper
