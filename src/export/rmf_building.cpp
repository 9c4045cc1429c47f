// SPDX-License-Identifier: BSD-3-Clause
#include "rmf_building.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lift_cab.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

// Types of parameters: a value stands beside the number of its type.
std::string Text(const std::string& value) { return "[1, \"" + value + "\"]"; }
std::string Whole(int value) { return "[2, " + std::to_string(value) + "]"; }
std::string Real(double value) { return "[3, " + FixedText(value, 6) + "]"; }
std::string Flag(bool value) { return std::string("[4, ") + (value ? "true" : "false") + "]"; }

std::string Quoted(const std::string& text) { return "\"" + text + "\""; }

}  // namespace

RmfBuilding::RmfBuilding(const SquaredMap& squared, std::string name)
    : squared_(squared),
      name_(std::move(name)),
      crossing_names_(CrossingNames(squared.lanes.crossings)) {
  if (squared.grids.empty()) return;
  const OccupancyGrid& grid = squared.grids.front();
  left_ = grid.origin_x;
  bottom_ = grid.origin_y;
  right_ = left_ + grid.width * grid.resolution_m;
  top_ = bottom_ + grid.height * grid.resolution_m;
}

std::string RmfBuilding::Label(FloorId floor) const {
  return squared_.map.graph.floor(floor).label;
}

Eigen::Vector2d RmfBuilding::InPixels(const Eigen::Vector2d& at_in_squared) const {
  const double resolution_m = squared_.grids.front().resolution_m;
  return {(at_in_squared.x() - left_) / resolution_m, (top_ - at_in_squared.y()) / resolution_m};
}

RmfBuilding::Level RmfBuilding::LevelOf(FloorId floor) const {
  const LaneGraph& graph = squared_.lanes;
  Level level;
  std::map<std::size_t, std::size_t> place;  // by vertex of the lane graph
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    const LaneVertex& vertex = graph.vertices[i];
    if (vertex.floor != floor) continue;
    Vertex own{vertex.at_in_world, vertex.name, {}};
    if (vertex.crossing) {
      const Crossing& crossing = graph.crossings[*vertex.crossing];
      own.name = crossing_names_[*vertex.crossing] + "_" + Label(floor);
      if (crossing.kind == CrossingKind::kElevator) {
        // A lift's waypoints stand above each other, in the middle of its cab.
        own.lift = crossing_names_[*vertex.crossing];
        const Stop& first = crossing.stops.front();
        own.at_in_squared = CabAround(first, squared_.grids[static_cast<std::size_t>(first.floor)])
                                .T_world_cab.Translation();
      }
    }
    place[i] = level.vertices.size();
    level.vertices.push_back(std::move(own));
  }
  for (const Lane& lane : graph.lanes) {
    if (graph.vertices[lane.from].floor != floor) continue;
    level.lanes.emplace_back(place.at(lane.from), place.at(lane.to));
  }
  for (const WallLine& wall : squared_.walls[static_cast<std::size_t>(floor)]) {
    level.walls.emplace_back(level.vertices.size(), level.vertices.size() + 1);
    level.vertices.push_back({wall.a, {}, {}});
    level.vertices.push_back({wall.b, {}, {}});
  }
  level.measurement = {level.vertices.size(), level.vertices.size() + 1};
  level.vertices.push_back({{left_, bottom_}, {}, {}});
  level.vertices.push_back({{right_, bottom_}, {}, {}});
  return level;
}

std::string RmfBuilding::LevelText(FloorId floor) const {
  const Level level = LevelOf(floor);
  const auto pixels = [&](const Eigen::Vector2d& at) {
    const Eigen::Vector2d pixel = InPixels(at);
    return FixedText(pixel.x(), 3) + ", " + FixedText(pixel.y(), 3);
  };
  const auto edge = [](const std::pair<std::size_t, std::size_t>& ends, const std::string& what) {
    return "      - [" + std::to_string(ends.first) + ", " + std::to_string(ends.second) + ", {" +
           what + "}]\n";
  };
  std::string text = "  " + Quoted(Label(floor)) +
                     ":\n    drawing:\n      filename: " + Quoted(Label(floor) + ".png") +
                     "\n    elevation: " + FixedText(squared_.map.graph.floor(floor).elevation, 3) +
                     "\n";
  // Two points that all pictures share put the levels above each other.
  text += "    fiducials:\n      - [" + pixels({left_, bottom_}) + ", lower_left]\n      - [" +
          pixels({right_, top_}) + ", upper_right]\n    layers: {}\n    vertices:\n";
  for (const Vertex& vertex : level.vertices) {
    text += "      - [" + pixels(vertex.at_in_squared) + ", 0, " + Quoted(vertex.name) + ", {" +
            (vertex.lift.empty() ? "" : "lift_cabin: " + Text(vertex.lift)) + "}]\n";
  }
  text += "    measurements:\n" + edge(level.measurement, "distance: " + Real(right_ - left_));
  text += level.lanes.empty() ? "    lanes: []\n" : "    lanes:\n";
  for (const auto& lane : level.lanes) {
    text += edge(lane, "bidirectional: " + Flag(true) + ", graph_idx: " + Whole(0));
  }
  text += level.walls.empty() ? "    walls: []\n" : "    walls:\n";
  for (const auto& wall : level.walls) text += edge(wall, "");
  return text;
}

std::string RmfBuilding::LiftText(std::size_t crossing) const {
  const std::vector<Stop>& stops = squared_.lanes.crossings[crossing].stops;
  const FloorId first = stops.front().floor;
  const LiftCab cab = CabAround(stops.front(), squared_.grids[static_cast<std::size_t>(first)]);
  const Eigen::Vector2d at = InPixels(cab.T_world_cab.Translation());
  std::string text =
      "  " + Quoted(crossing_names_[crossing]) + ":\n    x: " + FixedText(at.x(), 3) +
      "\n    y: " + FixedText(at.y(), 3) + "\n    yaw: " + FixedText(cab.T_world_cab.theta, 6) +
      "\n    width: " + FixedText(cab.width_m, 3) + "\n    depth: " + FixedText(cab.depth_m, 3) +
      "\n    reference_floor_name: " + Quoted(Label(first)) +
      "\n    initial_floor_name: " + Quoted(Label(first)) +
      "\n    lowest_floor: " + Quoted(Label(first)) +
      "\n    highest_floor: " + Quoted(Label(stops.back().floor)) + "\n    plugins: true\n";
  // Doors stand in the frame of the cab, y up, and slide along the axis given.
  std::string doors;
  std::string level_doors;
  std::vector<int> turns;  // in quarters of how the first door looks
  for (const Stop& stop : stops) {
    const LiftCab here = CabAround(stop, squared_.grids[static_cast<std::size_t>(stop.floor)]);
    const int quarters = static_cast<int>(
        std::lround(WrapAngle(here.T_world_cab.theta - cab.T_world_cab.theta) / (M_PI / 2)));
    const int turn = (quarters + 4) % 4;
    const std::string door = "door_" + std::to_string(turn);
    level_doors += "      " + Quoted(Label(stop.floor)) + ": [" + door + "]\n";
    if (std::find(turns.begin(), turns.end(), turn) != turns.end()) continue;
    turns.push_back(turn);
    const double reach = 0.5 * (turn % 2 == 0 ? cab.depth_m : cab.width_m);
    const double angle = turn * M_PI / 2;
    doors += "      " + door + ": {door_type: 2, x: " + FixedText(-reach * std::sin(angle), 3) +
             ", y: " + FixedText(reach * std::cos(angle), 3) +
             ", width: " + FixedText(here.door_width_m, 3) +
             ", motion_axis_orientation: " + FixedText(turn % 2 == 0 ? 0.0 : M_PI / 2, 6) + "}\n";
  }
  return text + "    doors:\n" + doors + "    level_doors:\n" + level_doors;
}

std::string RmfBuilding::BuildingYaml() const {
  std::string text = "name: " + Quoted(name_) + "\ncoordinate_system: reference_image\n";
  if (squared_.grids.empty()) return text + "levels: {}\nlifts: {}\n";
  text += "reference_level_name: " + Quoted(Label(0)) + "\nlevels:\n";
  for (std::size_t i = 0; i < squared_.grids.size(); ++i) {
    text += LevelText(static_cast<FloorId>(i));
  }
  std::string lifts;
  for (std::size_t i = 0; i < crossing_names_.size(); ++i) {
    if (squared_.lanes.crossings[i].kind == CrossingKind::kElevator) lifts += LiftText(i);
  }
  return text + (lifts.empty() ? "lifts: {}\n" : "lifts:\n" + lifts);
}

std::string RmfBuilding::NavGraphYaml() const {
  std::string text = "building_name: " + Quoted(name_) + "\nlevels:\n";
  for (std::size_t i = 0; i < squared_.grids.size(); ++i) {
    const auto floor = static_cast<FloorId>(i);
    const Level level = LevelOf(floor);
    text += "  " + Quoted(Label(floor)) + ":\n";
    text += level.lanes.empty() ? "    lanes: []\n" : "    lanes:\n";
    std::vector<std::size_t> place(level.vertices.size(), level.vertices.size());
    std::vector<std::size_t> order;
    const auto placed = [&](std::size_t vertex) {
      if (place[vertex] == level.vertices.size()) {
        place[vertex] = order.size();
        order.push_back(vertex);
      }
      return std::to_string(place[vertex]);
    };
    for (const auto& [from, to] : level.lanes) {
      const std::string a = placed(from);
      const std::string b = placed(to);
      text += "      - [" + a + ", " + b + ", {}]\n      - [" + b + ", " + a + ", {}]\n";
    }
    text += order.empty() ? "    vertices: []\n" : "    vertices:\n";
    for (const std::size_t i_vertex : order) {
      const Vertex& vertex = level.vertices[i_vertex];
      const Eigen::Vector2d at = vertex.at_in_squared + Shift();
      text += "      - [" + FixedText(at.x(), 3) + ", " + FixedText(at.y(), 3) +
              ", {name: " + Quoted(vertex.name) +
              (vertex.lift.empty() ? "" : ", lift: " + Quoted(vertex.lift)) + "}]\n";
    }
  }
  return text;
}

}  // namespace masked_mapper
