// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "floor_paths.hpp"
#include "free_space.hpp"

namespace masked_mapper {
namespace {

/// Who drives by within this of a vertex goes by way of it; half of a corridor's width, so that a
/// corridor driven up and down is one lane.
constexpr double kSameVertex = 0.7;  // m
constexpr double kSpacing = 2.5;     // m, of vertices along a way, before needless ones go

/// The lanes of one floor.
class FloorLanes {
 public:
  FloorLanes(const FreeSpace& space, FloorId floor) : space_(space), floor_(floor) {}

  void AddStop(LaneVertex vertex) {
    const auto cell = space_.NearestPassable(vertex.at_in_world, kSameVertex);
    Put(std::move(vertex), cell);
    kept_.back() = true;
  }

  void Follow(const FreeSpace::Points& way) {
    std::optional<std::size_t> at;
    GridCell last{};  // seen from there
    for (const Eigen::Vector2d& point : way) {
      const GridCell cell = space_.CellAt(point);
      if (!space_.IsPassable(cell)) continue;
      const std::optional<std::size_t> near = VertexNear(point, cell);
      if (!at) {
        at = near ? *near : Put({floor_, point, {}, {}}, cell);
      } else if (near) {
        if (*near != *at) Go(*at, last, *near);
        at = *near;
      } else if (!space_.Sees(*cells_[*at], cell)) {
        const std::size_t turn =
            last == *cells_[*at] ? *at : Put({floor_, space_.CentreOf(last), {}, {}}, last);
        Join(*at, turn);
        at = space_.Sees(last, cell) ? turn : Put({floor_, point, {}, {}}, cell);
        if (*at != turn) Go(turn, last, *at);
      } else if ((vertices_[*at].at_in_world - point).norm() > kSpacing) {
        const std::size_t next = Put({floor_, point, {}, {}}, cell);
        Join(*at, next);
        at = next;
      }
      last = cell;
    }
  }

  /// Those that nothing driven leads to are led to the nearest vertex by the shortest way.
  void JoinStops() {
    const std::size_t stops = vertices_.size();
    for (std::size_t i = 0; i < stops; ++i) {
      if (!kept_[i] || !next_to_[i].empty() || !cells_[i]) continue;
      std::vector<GridCell> targets;
      for (std::size_t j = 0; j < vertices_.size(); ++j) {
        if (j != i && cells_[j] && !next_to_[j].empty()) targets.push_back(*cells_[j]);
      }
      if (targets.empty()) continue;
      LeadTo(i, targets);
    }
  }

  /// A vertex in the middle of a straight lane is needless.
  void Simplify() {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (std::size_t i = 0; i < vertices_.size(); ++i) {
        if (kept_[i] || next_to_[i].size() != 2) continue;
        const std::size_t a = *next_to_[i].begin();
        const std::size_t b = *next_to_[i].rbegin();
        if (!cells_[a] || !cells_[b] || !space_.Sees(*cells_[a], *cells_[b])) continue;
        next_to_[a].erase(i);
        next_to_[b].erase(i);
        next_to_[i].clear();
        Join(a, b);
        has_changed = true;
      }
    }
  }

  void AppendTo(LaneGraph& graph) const {
    std::vector<std::size_t> place(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (!kept_[i] && next_to_[i].empty()) continue;
      place[i] = graph.vertices.size();
      graph.vertices.push_back(vertices_[i]);
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      for (const std::size_t j : next_to_[i]) {
        if (i < j) graph.lanes.push_back({place[i], place[j]});
      }
    }
  }

 private:
  std::size_t Put(LaneVertex vertex, const std::optional<GridCell>& cell) {
    vertices_.push_back(std::move(vertex));
    cells_.push_back(cell);
    next_to_.emplace_back();
    kept_.push_back(false);
    return vertices_.size() - 1;
  }

  void Join(std::size_t a, std::size_t b) {
    if (a == b) return;
    next_to_[a].insert(b);
    next_to_[b].insert(a);
  }

  /// From a vertex to another, of which `last` may see more than the first does.
  void Go(std::size_t from, const GridCell& last, std::size_t to) {
    if (space_.Sees(*cells_[from], *cells_[to])) {
      Join(from, to);
    } else if (space_.Sees(*cells_[from], last) && space_.Sees(last, *cells_[to])) {
      const std::size_t turn = Put({floor_, space_.CentreOf(last), {}, {}}, last);
      Join(from, turn);
      Join(turn, to);
    } else {
      LeadTo(from, {*cells_[to]});
    }
  }

  std::optional<std::size_t> VertexNear(const Eigen::Vector2d& point, const GridCell& cell) const {
    std::optional<std::size_t> nearest;
    double smallest = kSameVertex;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const double off = (vertices_[i].at_in_world - point).norm();
      if (off >= smallest || !cells_[i] || !space_.Sees(*cells_[i], cell)) continue;
      smallest = off;
      nearest = i;
    }
    return nearest;
  }

  void LeadTo(std::size_t from, const std::vector<GridCell>& targets) {
    const FloorPaths paths(space_, *cells_[from], targets);
    std::optional<std::vector<GridCell>> best;
    double shortest = std::numeric_limits<double>::infinity();
    for (const GridCell& target : targets) {
      const auto way = paths.WayTo(target);
      if (!way) continue;
      double length = 0.0;
      for (std::size_t i = 1; i < way->size(); ++i) {
        length +=
            std::hypot((*way)[i].column - (*way)[i - 1].column, (*way)[i].row - (*way)[i - 1].row);
      }
      if (length >= shortest) continue;
      shortest = length;
      best = way;
    }
    if (!best) return;
    std::size_t at = from;
    for (std::size_t i = 1; i < best->size(); ++i) {
      const GridCell& cell = (*best)[i];
      std::size_t next = vertices_.size();
      for (std::size_t j = 0; j < vertices_.size(); ++j) {
        if (cells_[j] && *cells_[j] == cell) next = j;
      }
      if (next == vertices_.size()) Put({floor_, space_.CentreOf(cell), {}, {}}, cell);
      Join(at, next);
      at = next;
    }
  }

  const FreeSpace& space_;
  FloorId floor_;
  std::vector<LaneVertex> vertices_;
  std::vector<std::optional<GridCell>> cells_;  ///< none: the robot cannot be there
  std::vector<std::set<std::size_t>> next_to_;
  std::vector<bool> kept_;  ///< stops and places
};

}  // namespace

LaneGraph LanesOf(const BuildingMap& map, const std::vector<OccupancyGrid>& grids,
                  const ClearanceOptions& clearance) {
  LaneGraph graph;
  graph.crossings = CrossingsOf(map);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto floor = static_cast<FloorId>(i);
    const FreeSpace space = FreeSpaceOf(map, grids[i], floor, clearance);
    FloorLanes lanes(space, floor);
    for (std::size_t c = 0; c < graph.crossings.size(); ++c) {
      for (const Stop& stop : graph.crossings[c].stops) {
        if (stop.floor == floor) lanes.AddStop({floor, stop.T_world_robot.Translation(), {}, c});
      }
    }
    for (const NamedPlace& place : map.places) {
      if (place.floor == floor) lanes.AddStop({floor, place.at_in_world, place.name, {}});
    }
    for (const FreeSpace::Points& way : DrivenOn(map, floor)) lanes.Follow(way);
    lanes.JoinStops();
    lanes.Simplify();
    lanes.AppendTo(graph);
  }
  return graph;
}

}  // namespace masked_mapper
