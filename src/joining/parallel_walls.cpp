// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/wall_lines.hpp"

namespace masked_mapper {
namespace {

constexpr double kPart = 30.0;  // m; of a floor, that is straight in itself

/// By which walls that are drawn parallel are not.
constexpr double kBuiltDeg = 0.03;

/// The heading of a way has the doubt of every step in it, which is a bound: ways through a cab,
/// and others, err by a sixth of it. Walls are to be better than what the way is in truth.
constexpr double kOfItsDoubt = 0.2;
constexpr double kMostSigmas = 3.0;
constexpr double kAnywhere = 1e5;  // m; no way is so unsure

/// What the walls of a part say.
struct Part {
  FloorId floor = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double length_m = 0.0;  ///< of all its walls
  WallDirection direction;
  NodeId node = -1;  ///< the nearest to its middle
};

/// What about two passes kept of every place: how often a corridor was driven along adds little to
/// what its walls tell, and much to what drawing them costs.
std::vector<PosedScan> ScansOfPlaces(const BuildingMap& map) {
  constexpr double kPlace = 1.0;  // m
  constexpr int kMostAtPlace = 14;
  std::map<std::tuple<FloorId, int, int>, int> at_place;
  std::vector<PosedScan> scans;
  for (const KeptScan& kept : map.kept_scans) {
    const TrajectoryPose& pose = map.trajectory[kept.trajectory_index];
    if (pose.in_transit) continue;
    const Eigen::Vector2d cell = pose.T_world_robot.Translation() / kPlace;
    int& count = at_place[{pose.floor, static_cast<int>(std::floor(cell.x())),
                           static_cast<int>(std::floor(cell.y()))}];
    if (count++ < kMostAtPlace) scans.push_back({pose.T_world_robot, pose.floor, &kept.scan});
  }
  return scans;
}

std::vector<std::vector<WallLine>> WallsOfFloors(const BuildingMap& map, int threads) {
  const std::vector<PosedScan> scans = ScansOfPlaces(map);
  GridOptions grid;
  grid.threads = threads;
  grid.glass = false;  // a pane is hit seldom: directions are told by walls
  std::vector<std::vector<WallLine>> walls;
  for (std::size_t i = 0; i < map.graph.floors().size(); ++i) {
    walls.push_back(FitWallLines(RenderGrid(scans, static_cast<FloorId>(i), grid)));
  }
  return walls;
}

/// Nothing where there is no node on the part.
std::optional<NodeId> NearestNode(const PoseGraph& graph, FloorId floor,
                                  const Eigen::Vector2d& point) {
  std::optional<NodeId> nearest;
  double least = kPart;
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const Node& node = graph.nodes()[i];
    if (node.floor != floor) continue;
    const double distance = (node.T_world_robot.Translation() - point).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<NodeId>(i);
  }
  return nearest;
}

std::optional<Part> PartOf(const PoseGraph& graph, FloorId floor,
                           const std::vector<WallLine>& walls, double angle) {
  const std::optional<WallDirection> direction = DirectionNear(angle, walls);
  if (!direction || std::isinf(direction->sigma)) return std::nullopt;
  Part part;
  part.floor = floor;
  part.direction = *direction;
  part.direction.sigma = std::hypot(direction->sigma, DegToRad(kBuiltDeg));
  for (const WallLine& wall : walls) {
    const double length = (wall.b - wall.a).norm();
    part.middle += length * 0.5 * (wall.a + wall.b);
    part.length_m += length;
  }
  part.middle /= part.length_m;
  const std::optional<NodeId> node = NearestNode(graph, floor, part.middle);
  if (!node) return std::nullopt;
  part.node = *node;
  return part;
}

std::vector<Part> PartsOf(const BuildingMap& map, int threads) {
  const std::vector<std::vector<WallLine>> walls = WallsOfFloors(map, threads);
  std::vector<WallLine> all;
  std::map<std::tuple<std::size_t, int, int>, std::vector<WallLine>> cells;
  for (std::size_t floor = 0; floor < walls.size(); ++floor) {
    all.insert(all.end(), walls[floor].begin(), walls[floor].end());
    for (const WallLine& wall : walls[floor]) {
      const Eigen::Vector2d cell = (wall.a + wall.b) / (2.0 * kPart);
      cells[{floor, static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))}]
          .push_back(wall);
    }
  }
  std::vector<Part> parts;
  const std::optional<WallDirection> most = DirectionOf(all);
  if (!most) return parts;
  for (const auto& [cell, lines] : cells) {
    const auto floor = static_cast<FloorId>(std::get<0>(cell));
    if (const std::optional<Part> part = PartOf(map.graph, floor, lines, most->angle)) {
      parts.push_back(*part);
    }
  }
  return parts;
}

/// `turn_rad`: from the heading of `from` to that of `to`.
Edge HeadingTie(NodeId from, NodeId to, double turn_rad, double sigma_rad) {
  Edge edge{from, to, {{0.0, 0.0, WrapAngle(turn_rad)}, {}}, EdgeKind::kHeading};
  edge.T_from_to.covariance =
      Eigen::Vector3d(kAnywhere, kAnywhere, sigma_rad).cwiseAbs2().asDiagonal();
  return edge;
}

/// To the part that has most walls.
std::vector<Edge> TiesOf(const PoseGraph& graph, const std::vector<Part>& parts) {
  std::vector<Edge> ties;
  if (parts.empty()) return ties;
  const Part& hub = *std::max_element(
      parts.begin(), parts.end(),
      [](const Part& one, const Part& other) { return one.length_m < other.length_m; });
  std::vector<double> way_sigma(graph.nodes().size(), std::numeric_limits<double>::infinity());
  for (const ProjectedNode& projected : DijkstraProjection(graph, hub.node)) {
    way_sigma[static_cast<std::size_t>(projected.node)] =
        kOfItsDoubt * std::sqrt(projected.T_source_node.covariance(2, 2));
  }
  for (const Part& part : parts) {
    const double way = way_sigma[static_cast<std::size_t>(part.node)];
    const double off = std::remainder(part.direction.angle - hub.direction.angle, M_PI / 2.0);
    const double sigma = std::hypot(part.direction.sigma, hub.direction.sigma);
    if (part.node == hub.node || !(sigma < way) || std::isinf(way)) continue;
    if (std::abs(off) > kMostSigmas * std::hypot(sigma, way)) continue;
    const double turn =
        graph.node(part.node).T_world_robot.theta - graph.node(hub.node).T_world_robot.theta;
    ties.push_back(HeadingTie(hub.node, part.node, turn - off, sigma));
  }
  return ties;
}

}  // namespace

void TieParallelWalls(const OptimizerOptions& solver, int threads, BuildingMap& map) {
  if (map.graph.floors().size() < 2) return;
  const StageTimer timer(map.seconds.optimisation);
  const std::vector<Edge> ties = TiesOf(map.graph, PartsOf(map, threads));
  if (ties.empty()) return;
  for (const Edge& tie : ties) map.graph.AddEdge(tie);
  Optimize(solver, map.graph);
  BendTrajectory(map.graph, map.trajectory);
}

}  // namespace masked_mapper
