// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/polygon.hpp"
#include "masked_mapper/text/enum_names.hpp"
#include "occupancy_grid_file.hpp"
#include "output_file.hpp"
#include "png_file.hpp"
#include "rmf_building.hpp"
#include "squared_map.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

/// Occupied where nobody may go, free elsewhere.
OccupancyGrid KeepOutMask(const BuildingMap& map, const OccupancyGrid& grid, FloorId floor) {
  OccupancyGrid mask = grid;
  mask.walls.clear();
  mask.cells.assign(grid.cells.size(), Cell::kFree);
  for (const Area& area : map.areas) {
    if (area.floor != floor || area.kind != AreaKind::kKeepOut) continue;
    ForEachCellInside(area.corners_in_world, {grid.origin_x, grid.origin_y}, grid.resolution_m,
                      grid.width, grid.height,
                      [&](std::size_t cell) { mask.cells[cell] = Cell::kOccupied; });
  }
  return mask;
}

Json PointJson(const Eigen::Vector2d& at) {
  return {std::round(at.x() * 1000.0) / 1000.0, std::round(at.y() * 1000.0) / 1000.0};
}

/// Nodes and edges of one floor; ids are unique among both and over all floors, and a lane is two
/// edges, since those of the route server have a direction.
class RouteGraph {
 public:
  RouteGraph(const SquaredMap& squared, FloorId floor, const std::vector<std::string>& names)
      : squared_(squared), floor_(floor), names_(names) {}

  /// Nothing when there is no edge, which the route server would refuse.
  std::string Text() const {
    const LaneGraph& lanes = squared_.lanes;
    Json nodes = Json::array();
    for (std::size_t i = 0; i < lanes.vertices.size(); ++i) {
      if (lanes.vertices[i].floor == floor_) nodes.push_back(NodeJson(i));
    }
    Json edges = Json::array();
    for (std::size_t i = 0; i < lanes.lanes.size(); ++i) {
      const Lane& lane = lanes.lanes[i];
      if (lanes.vertices[lane.from].floor != floor_) continue;
      edges.push_back(EdgeJson(lanes.vertices.size() + 2 * i, lane.from, lane.to));
      edges.push_back(EdgeJson(lanes.vertices.size() + 2 * i + 1, lane.to, lane.from));
    }
    if (edges.empty()) return {};
    Json features = std::move(nodes);
    for (Json& edge : edges) features.push_back(std::move(edge));
    const Json collection = {{"type", "FeatureCollection"},
                             {"name", squared_.map.graph.floor(floor_).label},
                             {"features", std::move(features)}};
    return collection.dump(1) + "\n";
  }

 private:
  Json NodeJson(std::size_t vertex) const {
    const LaneVertex& node = squared_.lanes.vertices[vertex];
    Json metadata = {{"floor", squared_.map.graph.floor(floor_).label}};
    if (!node.name.empty()) metadata["name"] = node.name;
    if (node.crossing) {
      const Crossing& crossing = squared_.lanes.crossings[*node.crossing];
      metadata[Name(crossing.kind)] = names_[*node.crossing];
      Json floors = Json::array();
      for (const Stop& stop : crossing.stops) {
        floors.push_back(squared_.map.graph.floor(stop.floor).label);
      }
      metadata["floors"] = std::move(floors);
    }
    return {{"type", "Feature"},
            {"properties", {{"id", vertex}, {"frame", "map"}, {"metadata", std::move(metadata)}}},
            {"geometry", {{"type", "Point"}, {"coordinates", PointJson(node.at_in_world)}}}};
  }

  Json EdgeJson(std::size_t id, std::size_t from, std::size_t to) const {
    const auto& vertices = squared_.lanes.vertices;
    Json line =
        Json::array({PointJson(vertices[from].at_in_world), PointJson(vertices[to].at_in_world)});
    return {{"type", "Feature"},
            {"properties", {{"id", id}, {"startid", from}, {"endid", to}}},
            {"geometry",
             {{"type", "MultiLineString"}, {"coordinates", Json::array({std::move(line)})}}}};
  }

  const SquaredMap& squared_;
  FloorId floor_;
  const std::vector<std::string>& names_;
};

}  // namespace

void WriteNav2(const BuildingMap& map, const HandoverOptions& options,
               const std::filesystem::path& folder) {
  const SquaredMap squared = Squared(map, options);
  const std::vector<std::string> names = CrossingNames(squared.lanes.crossings);
  for (std::size_t i = 0; i < squared.grids.size(); ++i) {
    const auto floor = static_cast<FloorId>(i);
    const std::string& label = squared.map.graph.floor(floor).label;
    const std::filesystem::path own = folder / "floors" / label;
    std::filesystem::create_directories(own);
    WriteOccupancyGrid(squared.grids[i], own / "map");
    WriteOccupancyGrid(KeepOutMask(squared.map, squared.grids[i], floor), own / "keepout");
    const std::string graph = RouteGraph(squared, floor, names).Text();
    if (!graph.empty()) WriteFile(own / "graph.geojson", graph);
  }
  WriteFrame(squared, Eigen::Vector2d::Zero(), folder / "frame.yaml");
}

void WriteRmf(const BuildingMap& map, const HandoverOptions& options,
              const std::filesystem::path& folder) {
  const SquaredMap squared = Squared(map, options);
  const RmfBuilding building(squared, options.name);
  for (std::size_t i = 0; i < squared.grids.size(); ++i) {
    const OccupancyGrid& grid = squared.grids[i];
    WriteGreyPng(GreyPixels(grid), grid.width,
                 folder / (squared.map.graph.floor(static_cast<FloorId>(i)).label + ".png"));
  }
  WriteFile(folder / (options.name + ".building.yaml"), building.BuildingYaml());
  std::filesystem::create_directories(folder / "nav_graphs");
  WriteFile(folder / "nav_graphs" / "0.yaml", building.NavGraphYaml());
  WriteFrame(squared, building.Shift(), folder / "frame.yaml");
}

}  // namespace masked_mapper
