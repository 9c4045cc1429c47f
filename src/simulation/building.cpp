// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/building.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "masked_mapper/text/input_error.hpp"
#include "segment_index.hpp"

namespace masked_mapper {
namespace {

constexpr double kMaxCoordinate = 10'000.0;  // m, more than any building

[[noreturn]] void Fail(const Building& building, const std::string& what) {
  throw InputError("building '" + building.name + "': " + what);
}

bool IsName(const std::string& name) {
  if (name.empty() || name.size() > 64 || name == "." || name == "..") return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  });
}

bool IsPosition(const Eigen::Vector2d& point) {
  return std::abs(point.x()) <= kMaxCoordinate && std::abs(point.y()) <= kMaxCoordinate;
}

std::string Metres(double value) {
  const long centimetres = std::lround(value * 100.0);
  const std::string cents = std::to_string(centimetres % 100);
  return std::to_string(centimetres / 100) + "." + (cents.size() < 2 ? "0" : "") + cents + " m";
}

Eigen::Vector2d PositionOf(const Building& building, const Landing& landing) {
  return building.floors[landing.floor].way_points[landing.way_point].position;
}

void CheckFloor(const Building& building, const FloorPlan& floor) {
  const std::string where = "floor " + floor.label + ": ";
  std::set<std::string> names;
  for (const WayPoint& way_point : floor.way_points) {
    if (!IsName(way_point.name)) Fail(building, where + "'" + way_point.name + "' is no name");
    if (!names.insert(way_point.name).second) {
      Fail(building, where + "two way-points are called " + way_point.name);
    }
    if (!IsPosition(way_point.position)) {
      Fail(building, where + "way-point " + way_point.name + " lies beyond 10 km");
    }
  }
  for (const Segment& segment : floor.segments) {
    if (!IsPosition(segment.a) || !IsPosition(segment.b)) {
      Fail(building, where + "a wall reaches beyond 10 km");
    }
  }
  for (const Overhead& block : floor.overhead) {
    if (!IsPosition(block.T_building_block.Translation()) ||
        !std::isfinite(block.T_building_block.theta)) {
      Fail(building, where + "something overhead lies beyond 10 km");
    }
    if (!(block.length > 0.0 && block.length <= 1000.0 && block.width > 0.0 &&
          block.width <= 1000.0 && block.low > 0.0 && block.low < block.high)) {
      Fail(building, where + "what is overhead has an extent, and hangs above the floor");
    }
  }
  for (const Passage& passage : floor.passages) {
    if (passage.from >= floor.way_points.size() || passage.to >= floor.way_points.size() ||
        passage.from == passage.to) {
      Fail(building, where + "a corridor joins no two way-points");
    }
  }
}

void CheckLanding(const Building& building, const std::string& name, const Landing& landing) {
  if (landing.floor >= building.floors.size() ||
      landing.way_point >= building.floors[landing.floor].way_points.size()) {
    Fail(building, name + " stops at a way-point that is not there");
  }
}

void CheckConnections(const Building& building) {
  std::set<std::string> names;
  for (const Elevator& elevator : building.elevators) {
    const std::string name = "elevator " + elevator.name;
    if (!IsName(elevator.name) || !names.insert(elevator.name).second) {
      Fail(building, name + ": its name is taken or not allowed");
    }
    if (!IsPosition(elevator.T_building_cab.Translation()) ||
        !std::isfinite(elevator.T_building_cab.theta)) {
      Fail(building, name + " lies beyond 10 km");
    }
    if (!(elevator.depth >= 1.0 && elevator.depth <= 10.0 && elevator.width >= 1.0 &&
          elevator.width <= 10.0 && elevator.door_width > 0.0 &&
          elevator.door_width <= elevator.width)) {
      Fail(building, name + ": a cab is 1 to 10 m deep and wide, its door no wider than the cab");
    }
    std::set<std::size_t> floors;
    for (const Landing& landing : elevator.landings) {
      CheckLanding(building, name, landing);
      if (!floors.insert(landing.floor).second) {
        Fail(building, name + " stops twice on floor " + building.floors[landing.floor].label);
      }
    }
    if (floors.size() < 2) Fail(building, name + " stops on fewer than two floors");
  }
  for (const Stairs& stairs : building.stairs) {
    const std::string name = "stairs " + stairs.name;
    if (!IsName(stairs.name) || !names.insert(stairs.name).second) {
      Fail(building, name + ": the name is taken or not allowed");
    }
    CheckLanding(building, name, stairs.lower);
    CheckLanding(building, name, stairs.upper);
    if (stairs.lower.floor >= stairs.upper.floor) {
      Fail(building, name + " do not lead from a floor to a higher one");
    }
    for (const Eigen::Vector2d& point : stairs.way) {
      if (!IsPosition(point)) Fail(building, name + " reach beyond 10 km");
    }
  }
}

void CheckTour(const Building& building) {
  const UsualTour& tour = building.usual_tour;
  CheckLanding(building, "the tour", {tour.start_floor, tour.start_way_point});
  for (const std::size_t floor : tour.visits) {
    if (floor >= building.floors.size())
      Fail(building, "the tour visits a floor that is not there");
  }
  if (!tour.visits.empty() &&
      (tour.visits.front() != tour.start_floor || tour.visits.back() != tour.start_floor)) {
    Fail(building, "the tour does not begin and end on the floor of its start");
  }
  if (!(tour.rest_per_metre >= 0.0 && tour.rest_per_metre <= 100.0)) {
    Fail(building, "the rest per metre is not within 0 to 100 s");
  }
}

/// Every way-point that a tour must come to can be reached from the start, over all floors.
void CheckReach(const Building& building) {
  std::vector<std::vector<bool>> reached;
  for (const FloorPlan& floor : building.floors)
    reached.emplace_back(floor.way_points.size(), false);
  std::vector<Landing> open{{building.usual_tour.start_floor, building.usual_tour.start_way_point}};
  const auto reach = [&](const Landing& landing) {
    if (reached[landing.floor][landing.way_point]) return;
    reached[landing.floor][landing.way_point] = true;
    open.push_back(landing);
  };
  reached[open[0].floor][open[0].way_point] = true;
  while (!open.empty()) {
    const Landing here = open.back();
    open.pop_back();
    const auto is_here = [&](const Landing& landing) {
      return landing.floor == here.floor && landing.way_point == here.way_point;
    };
    for (const Passage& passage : building.floors[here.floor].passages) {
      if (passage.from == here.way_point) reach({here.floor, passage.to});
      if (passage.to == here.way_point) reach({here.floor, passage.from});
    }
    for (const Elevator& elevator : building.elevators) {
      if (std::any_of(elevator.landings.begin(), elevator.landings.end(), is_here)) {
        for (const Landing& landing : elevator.landings) reach(landing);
      }
    }
    for (const Stairs& stairs : building.stairs) {
      if (is_here(stairs.lower)) reach(stairs.upper);
      if (is_here(stairs.upper)) reach(stairs.lower);
    }
  }
  for (std::size_t f = 0; f < building.floors.size(); ++f) {
    const FloorPlan& floor = building.floors[f];
    for (const Passage& passage : floor.passages) {
      if (passage.must_visit && !reached[f][passage.from]) {
        Fail(building, "floor " + floor.label + ": way-point " +
                           floor.way_points[passage.from].name +
                           " cannot be reached from the start");
      }
    }
  }
}

void CheckWays(const Building& building, double clearance) {
  for (std::size_t f = 0; f < building.floors.size(); ++f) {
    const FloorPlan& floor = building.floors[f];
    const SegmentIndex index(StandingSegments(building, f));
    const auto check = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                           const std::string& way) {
      const double found = index.Clearance(a, b, clearance);
      if (found < clearance) {
        Fail(building, "floor " + floor.label + ": " + way + " passes " + Metres(found) +
                           " from a wall or furniture; the robot needs " + Metres(clearance));
      }
    };
    for (const Passage& passage : floor.passages) {
      const WayPoint& from = floor.way_points[passage.from];
      const WayPoint& to = floor.way_points[passage.to];
      check(from.position, to.position, "the way from " + from.name + " to " + to.name);
    }
    for (const Elevator& elevator : building.elevators) {
      for (const Landing& landing : elevator.landings) {
        if (landing.floor != f) continue;
        check(PositionOf(building, landing), elevator.T_building_cab.Translation(),
              "the way into elevator " + elevator.name);
      }
    }
    for (const Stairs& stairs : building.stairs) {
      const auto [lower_half, upper_half] = StairsHalves(building, stairs);
      const auto check_half = [&](const std::vector<Eigen::Vector2d>& half) {
        for (std::size_t i = 1; i < half.size(); ++i) {
          check(half[i - 1], half[i], "the way of stairs " + stairs.name);
        }
      };
      if (stairs.lower.floor == f) check_half(lower_half);
      if (stairs.upper.floor == f) check_half(upper_half);
    }
  }
}

}  // namespace

std::vector<Segment> CabWalls(const Elevator& elevator) {
  const double x = 0.5 * elevator.depth;
  const double y = 0.5 * elevator.width;
  const double d = 0.5 * elevator.door_width;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    return Segment{elevator.T_building_cab * Eigen::Vector2d(x0, y0),
                   elevator.T_building_cab * Eigen::Vector2d(x1, y1), Surface::kWall};
  };
  return {wall(x, d, x, y), wall(x, y, -x, y), wall(-x, y, -x, -y), wall(-x, -y, x, -y),
          wall(x, -y, x, -d)};
}

std::vector<Segment> CabDoor(const Elevator& elevator, double open) {
  const double gap = 0.5 * elevator.door_width * std::clamp(open, 0.0, 1.0);
  const double x = 0.5 * elevator.depth;
  const double d = 0.5 * elevator.door_width;
  if (!(gap < d)) return {};
  const auto leaf = [&](double y0, double y1) {
    return Segment{elevator.T_building_cab * Eigen::Vector2d(x, y0),
                   elevator.T_building_cab * Eigen::Vector2d(x, y1), Surface::kDoor};
  };
  if (!(gap > 0.0)) return {leaf(-d, d)};
  return {leaf(-d, -gap), leaf(gap, d)};
}

std::vector<Segment> StandingSegments(const Building& building, std::size_t floor) {
  std::vector<Segment> segments = building.floors[floor].segments;
  for (const Elevator& elevator : building.elevators) {
    for (const Landing& landing : elevator.landings) {
      if (landing.floor != floor) continue;
      const std::vector<Segment> walls = CabWalls(elevator);
      segments.insert(segments.end(), walls.begin(), walls.end());
    }
  }
  return segments;
}

std::pair<std::vector<Eigen::Vector2d>, std::vector<Eigen::Vector2d>> StairsHalves(
    const Building& building, const Stairs& stairs) {
  const auto position = [&](const Landing& landing) {
    return building.floors[landing.floor].way_points[landing.way_point].position;
  };
  std::vector<Eigen::Vector2d> way{position(stairs.lower)};
  way.insert(way.end(), stairs.way.begin(), stairs.way.end());
  way.push_back(position(stairs.upper));
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();

  std::vector<Eigen::Vector2d> lower{way.front()};
  std::vector<Eigen::Vector2d> upper;
  double left = 0.5 * length;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double piece = (way[i] - way[i - 1]).norm();
    if (upper.empty() && (piece >= left || i + 1 == way.size())) {
      const double share = piece > 0.0 ? std::min(1.0, left / piece) : 1.0;
      const Eigen::Vector2d middle = way[i - 1] + share * (way[i] - way[i - 1]);
      lower.push_back(middle);
      upper.push_back(middle);
    }
    (upper.empty() ? lower : upper).push_back(way[i]);
    left -= piece;
  }
  return {lower, upper};
}

Bounds BoundsOf(const FloorPlan& floor) {
  std::vector<Eigen::Vector2d> points;
  for (const Segment& segment : floor.segments) {
    points.push_back(segment.a);
    points.push_back(segment.b);
  }
  for (const WayPoint& way_point : floor.way_points) points.push_back(way_point.position);
  Bounds bounds;
  if (points.empty()) return bounds;
  bounds.low = bounds.high = points.front();
  for (const Eigen::Vector2d& point : points) {
    bounds.low = bounds.low.cwiseMin(point);
    bounds.high = bounds.high.cwiseMax(point);
  }
  return bounds;
}

double CorridorLength(const FloorPlan& floor) {
  double length = 0.0;
  for (const Passage& passage : floor.passages) {
    if (!passage.must_visit) continue;
    length +=
        (floor.way_points[passage.to].position - floor.way_points[passage.from].position).norm();
  }
  return length;
}

double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b) {
  const Eigen::Vector2d edge = b - a;
  const double squared = edge.squaredNorm();
  if (!(squared > 0.0)) return (point - a).norm();
  const double along = std::clamp((point - a).dot(edge) / squared, 0.0, 1.0);
  return (point - a - along * edge).norm();
}

void CheckBuilding(const Building& building, double clearance) {
  if (building.floors.empty()) Fail(building, "it has no floor");
  std::set<std::string> labels;
  double last = -kMaxCoordinate;
  for (const FloorPlan& floor : building.floors) {
    if (!IsName(floor.label) || floor.label == "-" || !labels.insert(floor.label).second) {
      Fail(building, "floor label '" + floor.label + "' is taken or not allowed");
    }
    if (!(floor.elevation > last && floor.elevation <= kMaxCoordinate)) {
      Fail(building, "floor " + floor.label + " is not above the floor before it");
    }
    last = floor.elevation;
    CheckFloor(building, floor);
  }
  CheckConnections(building);
  CheckTour(building);
  CheckReach(building);
  CheckWays(building, clearance);
}

}  // namespace masked_mapper
