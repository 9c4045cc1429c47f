// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/route.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "floor_paths.hpp"
#include "free_space.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class RouteSearch {
 public:
  RouteSearch(const BuildingMap& map, const std::vector<OccupancyGrid>& grids, const Place& from,
              const Place& to, const RouteOptions& options)
      : map_(map), grids_(grids), options_(options) {
    for (const Place& place : {from, to}) {
      nodes_.emplace_back();
      nodes_.back().place = place;
      PutOnFloor(nodes_.back());
    }
    crossings_ = CrossingsOf(map);
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      if (crossings_[i].kind == CrossingKind::kStairs && !options.use_stairs) continue;
      for (const Stop& stop : crossings_[i].stops) {
        nodes_.emplace_back();
        nodes_.back().place = {stop.floor, stop.T_world_robot.Translation()};
        nodes_.back().crossing = i;
      }
    }
  }

  Route Find() {
    Route route;
    route.from = nodes_[kFrom].place;
    route.to = nodes_[kTo].place;
    if (!nodes_[kFrom].cell) {
      route.reason = "the start is no place for the robot: a wall is too near, or nobody looked";
      return route;
    }
    nodes_[kFrom].cost = 0.0;
    while (const std::optional<std::size_t> node = Next()) {
      nodes_[*node].is_settled = true;
      PutOnFloor(nodes_[*node]);
      if (!nodes_[*node].cell) continue;
      if (*node == kTo) return Answer(std::move(route));
      Expand(*node);
    }
    return NoWay(std::move(route));
  }

 private:
  static constexpr std::size_t kFrom = 0;
  static constexpr std::size_t kTo = 1;

  /// The start, the end, or a stop of a crossing.
  struct Node {
    Place place;
    bool is_on_floor = false;
    std::optional<GridCell> cell;  ///< none: the robot cannot be there
    std::optional<std::size_t> crossing;
    double cost = kNever;
    bool is_settled = false;
    std::size_t before = 0;
    std::vector<Eigen::Vector2d> way;  ///< from the node before; none by a ride
    bool by_crossing = false;
  };

  /// Once asked for: many a floor is never looked at.
  void PutOnFloor(Node& node) {
    if (node.is_on_floor) return;
    node.is_on_floor = true;
    const FreeSpace& space = SpaceOf(node.place.floor);
    node.cell = space.NearestPassable(node.place.at_in_world, options_.clearance.radius_m);
    // The place itself where the robot may be there, else the nearest from which it touches it.
    if (node.cell && !(*node.cell == space.CellAt(node.place.at_in_world))) {
      node.place.at_in_world = space.CentreOf(*node.cell);
    }
  }

  const FreeSpace& SpaceOf(FloorId floor) {
    const auto known = spaces_.find(floor);
    if (known != spaces_.end()) return known->second;
    return spaces_
        .emplace(floor, FreeSpaceOf(map_, grids_[static_cast<std::size_t>(floor)], floor,
                                    options_.clearance))
        .first->second;
  }

  std::optional<std::size_t> Next() const {
    std::optional<std::size_t> next;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].is_settled || nodes_[i].cost == kNever) continue;
      if (!next || nodes_[i].cost < nodes_[*next].cost) next = i;
    }
    return next;
  }

  void Expand(std::size_t from) {
    Cross(from);
    const FloorId floor = nodes_[from].place.floor;
    // Who came on foot has this floor behind him: its other nodes are reached by shorter ways.
    if (from != kFrom && !nodes_[from].by_crossing) return;
    std::vector<std::size_t> others;
    std::vector<GridCell> targets;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].place.floor != floor || nodes_[i].is_settled) continue;
      PutOnFloor(nodes_[i]);
      if (!nodes_[i].cell) continue;
      others.push_back(i);
      targets.push_back(*nodes_[i].cell);
    }
    const FreeSpace& space = SpaceOf(floor);
    const bool ends_here = floor == nodes_[kTo].place.floor;
    if (ends_here && !nodes_[kTo].cell) targets.clear();  // to find what is nearest to it
    if (others.empty() && !ends_here) return;
    const FloorPaths paths(space, *nodes_[from].cell, targets);
    for (const std::size_t other : others) {
      const auto cells = paths.WayTo(*nodes_[other].cell);
      if (!cells) continue;
      std::vector<Eigen::Vector2d> way;
      for (const GridCell& cell : *cells) way.push_back(space.CentreOf(cell));
      way.front() = nodes_[from].place.at_in_world;
      if (way.size() == 1) way.push_back(way.front());
      way.back() = nodes_[other].place.at_in_world;
      Reach(other, from, std::move(way), 0.0, false);
    }
    if (ends_here && (!nodes_[kTo].cell || !paths.Reaches(*nodes_[kTo].cell))) {
      NoteNearest({floor, space.CentreOf(paths.NearestReached(nodes_[kTo].place.at_in_world))});
    }
  }

  void NoteNearest(const Place& place) {
    const Eigen::Vector2d& wanted = nodes_[kTo].place.at_in_world;
    if (!nearest_ ||
        (place.at_in_world - wanted).norm() < (nearest_->at_in_world - wanted).norm()) {
      nearest_ = place;
    }
  }

  /// To the other stops of a crossing.
  void Cross(std::size_t from) {
    if (!nodes_[from].crossing || nodes_[from].by_crossing) return;
    const Crossing& crossing = crossings_[*nodes_[from].crossing];
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (i == from || nodes_[i].crossing != nodes_[from].crossing) continue;
      std::vector<Eigen::Vector2d> way = crossing.way;
      if (!way.empty() && crossing.stops.front().floor != nodes_[from].place.floor) {
        std::reverse(way.begin(), way.end());
      }
      const double ride = crossing.kind == CrossingKind::kElevator ? options_.ride_cost_m : 0.0;
      Reach(i, from, std::move(way), ride, true);
    }
  }

  void Reach(std::size_t node, std::size_t before, std::vector<Eigen::Vector2d> way, double extra_m,
             bool by_crossing) {
    const double cost = nodes_[before].cost + LengthOf(way) + extra_m;
    if (nodes_[node].is_settled || cost >= nodes_[node].cost) return;
    nodes_[node].cost = cost;
    nodes_[node].before = before;
    nodes_[node].way = std::move(way);
    nodes_[node].by_crossing = by_crossing;
  }

  Route Answer(Route route) const {
    route.is_found = true;
    route.cost_m = nodes_[kTo].cost;
    std::vector<std::size_t> order = {kTo};
    while (order.back() != kFrom) order.push_back(nodes_[order.back()].before);
    std::reverse(order.begin(), order.end());
    // On foot and by crossings in turn: who came to a stop on foot needs no other way on from it,
    // and a cab goes to all of its floors in one ride.
    for (std::size_t i = 1; i < order.size(); ++i) {
      const Node& node = nodes_[order[i]];
      if (node.by_crossing) {
        route.transits.push_back({crossings_[*node.crossing].kind, nodes_[order[i - 1]].place.floor,
                                  node.place.floor, LengthOf(node.way)});
      } else {
        route.legs.push_back({node.place.floor, LengthOf(node.way), node.way});
      }
    }
    for (const RouteLeg& leg : route.legs) route.length_m += leg.length_m;
    for (const RouteTransit& transit : route.transits) route.length_m += transit.length_m;
    return route;
  }

  Route NoWay(Route route) {
    const FloorId wanted = nodes_[kTo].place.floor;
    if (!nodes_[kTo].cell) {
      route.reason = "the end is no place for the robot: a wall is too near, or nobody looked";
    } else if (nearest_) {
      route.reason = "nothing that was seen to be free leads there, wide enough for the robot";
    } else {
      route.reason =
          "no elevator or stairs that were driven lead to floor " + map_.graph.floor(wanted).label;
    }
    if (!nearest_) NearestOnOtherFloor();
    route.nearest = nearest_;
    return route;
  }

  void NearestOnOtherFloor() {
    const auto height_off = [&](const Node& node) {
      return std::abs(map_.graph.floor(node.place.floor).elevation -
                      map_.graph.floor(nodes_[kTo].place.floor).elevation);
    };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!nodes_[i].is_settled || !nodes_[i].cell) continue;
      if (!best || height_off(nodes_[i]) < height_off(nodes_[*best])) best = i;
    }
    const FreeSpace& space = SpaceOf(nodes_[*best].place.floor);
    const FloorPaths paths(space, *nodes_[*best].cell, {});
    NoteNearest({nodes_[*best].place.floor,
                 space.CentreOf(paths.NearestReached(nodes_[kTo].place.at_in_world))});
  }

  const BuildingMap& map_;
  const std::vector<OccupancyGrid>& grids_;
  const RouteOptions& options_;
  std::vector<Crossing> crossings_;
  std::vector<Node> nodes_;
  std::map<FloorId, FreeSpace> spaces_;
  std::optional<Place> nearest_;
};

}  // namespace

Route FindRoute(const BuildingMap& map, const std::vector<OccupancyGrid>& grids, const Place& from,
                const Place& to, const RouteOptions& options) {
  return RouteSearch(map, grids, from, to, options).Find();
}

}  // namespace masked_mapper
