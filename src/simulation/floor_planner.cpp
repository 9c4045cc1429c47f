// SPDX-License-Identifier: BSD-3-Clause
#include "floor_planner.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace masked_mapper {
namespace {

constexpr double kRoomGap = 0.12;     // m, the wall between two rooms
constexpr double kDeadEndRoom = 1.0;  // m, between the last way-point of a dead end and its wall
constexpr double kDoorGap = 0.62;     // m, between furniture and a way
constexpr double kSamePlace = 0.05;   // m
constexpr double kTableTop = 0.74;    // m
constexpr double kLintel = 2.05;      // m, over open doors
constexpr double kHighest = 10.0;     // m, up to any ceiling

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A rectangle of which edge `edge` is glass from fraction `from` to `to`.
ConvexSpace RectangleWithWindow(const Pose2& T_building_local, double x0, double y0, double x1,
                                double y1, std::size_t edge, double from, double to) {
  const ConvexSpace plain = ConvexSpace::Rectangle(T_building_local, x0, y0, x1, y1);
  ConvexSpace space;
  for (std::size_t e = 0; e < 4; ++e) {
    const Eigen::Vector2d& a = plain.corners[e];
    const Eigen::Vector2d& b = plain.corners[(e + 1) % 4];
    space.corners.push_back(a);
    space.surfaces.emplace_back(Surface::kWall);
    if (e != edge) continue;
    space.corners.emplace_back(a + from * (b - a));
    space.surfaces.emplace_back(Surface::kGlass);
    space.corners.emplace_back(a + to * (b - a));
    space.surfaces.emplace_back(Surface::kWall);
  }
  return space;
}

/// Cuts edge `edge` of a space into panes of glass between mullions.
void Glaze(ConvexSpace& space, std::size_t edge) {
  constexpr double kPane = 2.3;      // m
  constexpr double kMullion = 0.14;  // m
  const Eigen::Vector2d a = space.corners[edge];
  const Eigen::Vector2d b = space.corners[(edge + 1) % space.corners.size()];
  const double length = (b - a).norm();
  const int panes = std::max(1, static_cast<int>(length / (kPane + kMullion)));
  const double step = length / panes;
  std::vector<Eigen::Vector2d> corners;
  std::vector<std::optional<Surface>> surfaces;
  for (int pane = 0; pane < panes; ++pane) {
    const double start = pane * step;
    if (pane > 0) corners.emplace_back(a + start / length * (b - a));
    surfaces.emplace_back(Surface::kWall);
    corners.emplace_back(a + (start + kMullion) / length * (b - a));
    surfaces.emplace_back(Surface::kGlass);
  }
  const auto at = static_cast<std::ptrdiff_t>(edge);
  space.corners.insert(space.corners.begin() + at + 1, corners.begin(), corners.end());
  space.surfaces.erase(space.surfaces.begin() + at);
  space.surfaces.insert(space.surfaces.begin() + at, surfaces.begin(), surfaces.end());
}

}  // namespace

void FloorPlanner::SetLimits(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  limited_ = true;
  low_ = low;
  high_ = high;
}

void FloorPlanner::AddCorridor(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const CorridorStyle& style) {
  Corridor corridor;
  corridor.from = from;
  corridor.to = to;
  corridor.style = style;
  const Eigen::Vector2d along = to - from;
  corridor.length = along.norm();
  assert(corridor.length > 0.0);
  corridor.T_building_corridor = {from.x(), from.y(), std::atan2(along.y(), along.x())};
  corridors_.push_back(corridor);
}

void FloorPlanner::AddHall(const ConvexSpace& hall, double column_spacing) {
  halls_.emplace_back(hall, column_spacing);
  spaces_.push_back(hall);
  reserved_.push_back(hall);
}

void FloorPlanner::AddElevatorStop(std::size_t elevator, const Elevator& cab) {
  constexpr double kShaftWall = 0.2;  // m
  const Pose2& T = cab.T_building_cab;
  const double x = 0.5 * cab.depth;
  const double y = 0.5 * cab.width + kShaftWall;
  reserved_.push_back(ConvexSpace::Rectangle(T, -x - kShaftWall, -y, x, y));
  elevator_stops_.push_back(
      {elevator, T * Eigen::Vector2d(x, 0.0), {std::cos(T.theta), std::sin(T.theta)}});
  // The way from the corridor to the cab's front; how far the corridor is, is found when planning.
  ConvexSpace doorway =
      ConvexSpace::Rectangle(T, x, -0.5 * cab.door_width, x + 0.8, 0.5 * cab.door_width);
  doorway.surfaces[3] = std::nullopt;
  spaces_.push_back(doorway);
  reserved_.push_back(doorway);
}

void FloorPlanner::AddStairwell(std::size_t stairs, const StairwellPlan& plan, bool lower) {
  constexpr double kHalfWall = 0.1;   // m, half the wall between the flights
  constexpr double kCloseWall = 0.2;  // m, between corridor and the flight that is not open here
  const Pose2& T = plan.T_building_mouth;
  const double up = -(kHalfWall + 0.5 * plan.flight_width);
  const double length = plan.flight_length;
  for (const double axis : {up, -up}) {
    const bool open = (axis == up) == lower;
    spaces_.push_back(ConvexSpace::Rectangle(T, open ? -0.3 : kCloseWall,
                                             axis - 0.5 * plan.flight_width, length + 0.1,
                                             axis + 0.5 * plan.flight_width));
    if (open) {
      stairs_mouths_.push_back(
          {stairs, T * Eigen::Vector2d(0.0, axis), {-std::cos(T.theta), -std::sin(T.theta)}});
    }
  }
  const double half = kHalfWall + plan.flight_width;
  spaces_.push_back(ConvexSpace::Rectangle(T, length, -half, length + plan.landing_depth, half));
  reserved_.push_back(
      ConvexSpace::Rectangle(T, 0.0, -half - 0.1, length + plan.landing_depth + 0.1, half + 0.1));
}

std::size_t FloorPlanner::AddWayPoint(const Eigen::Vector2d& position, const std::string& prefix) {
  for (std::size_t i = 0; i < floor_.way_points.size(); ++i) {
    if ((floor_.way_points[i].position - position).norm() < kSamePlace) return i;
  }
  floor_.way_points.push_back({prefix + std::to_string(floor_.way_points.size()), position});
  return floor_.way_points.size() - 1;
}

std::size_t FloorPlanner::AddStation(Corridor& corridor, double along, const std::string& prefix) {
  const Eigen::Vector2d position =
      corridor.from + along / corridor.length * (corridor.to - corridor.from);
  const std::size_t way_point = AddWayPoint(position, prefix);
  for (const Station& station : corridor.stations) {
    if (station.way_point == way_point) return way_point;
  }
  corridor.stations.push_back({along, way_point});
  return way_point;
}

std::optional<std::pair<double, double>> FloorPlanner::Crossing(const Corridor& a,
                                                                const Corridor& b) {
  const Eigen::Vector2d along_a = (a.to - a.from) / a.length;
  const Eigen::Vector2d along_b = (b.to - b.from) / b.length;
  const double sine = Cross(along_a, along_b);
  double at_a = 0.0;
  double at_b = 0.0;
  if (std::abs(sine) > 1e-3) {
    at_a = Cross(b.from - a.from, along_b) / sine;
    at_b = Cross(b.from - a.from, along_a) / sine;
  } else {  // end to end, or apart
    bool meet = false;
    for (const double end_a : {0.0, a.length}) {
      for (const double end_b : {0.0, b.length}) {
        const Eigen::Vector2d gap = a.from + end_a * along_a - b.from - end_b * along_b;
        if (gap.norm() > kSamePlace) continue;
        at_a = end_a;
        at_b = end_b;
        meet = true;
      }
    }
    if (!meet) return std::nullopt;
  }
  if (at_a < -kSamePlace || at_a > a.length + kSamePlace) return std::nullopt;
  if (at_b < -kSamePlace || at_b > b.length + kSamePlace) return std::nullopt;
  return std::make_pair(std::clamp(at_a, 0.0, a.length), std::clamp(at_b, 0.0, b.length));
}

ConvexSpace FloorPlanner::Knuckle(const Corridor& a, const Corridor& b, double at_a) {
  const Eigen::Vector2d along_a = (a.to - a.from) / a.length;
  const Eigen::Vector2d along_b = (b.to - b.from) / b.length;
  const Eigen::Vector2d centre = a.from + at_a * along_a;
  if (std::abs(Cross(along_a, along_b)) > 0.999) {
    return ConvexSpace::Rectangle({centre.x(), centre.y(), a.T_building_corridor.theta},
                                  -0.5 * b.style.width, -0.5 * a.style.width, 0.5 * b.style.width,
                                  0.5 * a.style.width);
  }
  constexpr int kSides = 16;
  ConvexSpace knuckle;
  const double radius = 0.5 * std::max(a.style.width, b.style.width) / std::cos(kPi / kSides);
  for (int side = 0; side < kSides; ++side) {
    const double angle = a.T_building_corridor.theta + (2 * side + 1) * kPi / kSides;
    knuckle.corners.emplace_back(centre +
                                 radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    knuckle.surfaces.emplace_back(Surface::kWall);
  }
  return knuckle;
}

void FloorPlanner::JoinCorridors() {
  for (std::size_t i = 0; i < corridors_.size(); ++i) {
    for (std::size_t j = i + 1; j < corridors_.size(); ++j) {
      Corridor& a = corridors_[i];
      Corridor& b = corridors_[j];
      const std::optional<std::pair<double, double>> crossing = Crossing(a, b);
      if (!crossing) continue;
      const auto& [at_a, at_b] = *crossing;
      AddStation(a, at_a, "j");
      AddStation(b, at_b, "j");
      const auto mark = [](Corridor& corridor, double at) {
        if (at < kSamePlace) corridor.joined_from = true;
        if (at > corridor.length - kSamePlace) corridor.joined_to = true;
      };
      mark(a, at_a);
      mark(b, at_b);
      // A round knuckle fills the outer corner where two ends meet.
      const bool corner = (at_a < kSamePlace || at_a > a.length - kSamePlace) &&
                          (at_b < kSamePlace || at_b > b.length - kSamePlace);
      if (!corner) continue;
      const ConvexSpace knuckle = Knuckle(a, b, at_a);
      spaces_.push_back(knuckle);
      reserved_.push_back(knuckle);
    }
  }
  for (Corridor& corridor : corridors_) {
    if (!corridor.joined_from)
      AddStation(corridor, std::min(kDeadEndRoom, 0.4 * corridor.length), "e");
    if (!corridor.joined_to) {
      AddStation(corridor, std::max(corridor.length - kDeadEndRoom, 0.6 * corridor.length), "e");
    }
  }
}

void FloorPlanner::DrawCorridor(const Corridor& corridor) {
  const double half = 0.5 * corridor.style.width;
  ConvexSpace space =
      ConvexSpace::Rectangle(corridor.T_building_corridor, 0.0, -half, corridor.length, half);
  reserved_.push_back(space);
  if (corridor.style.left.glazed) Glaze(space, 2);
  if (corridor.style.right.glazed) Glaze(space, 0);
  spaces_.push_back(space);
}

std::size_t FloorPlanner::StationFacing(const Stop& stop, const std::string& prefix) {
  std::size_t nearest = corridors_.size();
  double nearest_distance = std::numeric_limits<double>::infinity();
  double nearest_along = 0.0;
  for (std::size_t i = 0; i < corridors_.size(); ++i) {
    const Corridor& corridor = corridors_[i];
    const Eigen::Vector2d along = (corridor.to - corridor.from) / corridor.length;
    const double sine = Cross(stop.axis_direction, along);
    if (std::abs(sine) < 0.5) continue;
    const double distance = Cross(corridor.from - stop.axis_point, along) / sine;
    const double at = Cross(corridor.from - stop.axis_point, stop.axis_direction) / sine;
    if (distance < 0.0 || distance > nearest_distance) continue;
    if (at < 0.0 || at > corridor.length) continue;
    nearest = i;
    nearest_distance = distance;
    nearest_along = at;
  }
  assert(nearest < corridors_.size() && "a corridor passes in front of every elevator and stairs");
  Corridor& corridor = corridors_[nearest];
  const Eigen::Vector2d along = (corridor.to - corridor.from) / corridor.length;
  const bool left = Cross(along, stop.axis_point - corridor.from) > 0.0;
  corridor.doors[left ? 0 : 1].emplace_back(nearest_along - 1.2, nearest_along + 1.2);
  return AddStation(corridor, nearest_along, prefix);
}

bool FloorPlanner::FreeForRoom(const ConvexSpace& space, double gap) const {
  if (limited_) {
    for (const Eigen::Vector2d& corner : space.corners) {
      if ((corner - low_).minCoeff() < 0.0 || (high_ - corner).minCoeff() < 0.0) return false;
    }
  }
  return std::none_of(reserved_.begin(), reserved_.end(),
                      [&](const ConvexSpace& other) { return Overlap(space, other, gap); });
}

bool FloorPlanner::TryNiche(Corridor& corridor, double side, double x, double* end) {
  const double half = 0.5 * corridor.style.width;
  const double width = random_.Uniform(1.0, 3.2);
  const double depth = random_.Uniform(0.35, 1.5);
  const double y0 = side > 0.0 ? half - 0.2 : -half - depth;
  const double y1 = side > 0.0 ? half + depth : -half + 0.2;
  const ConvexSpace niche =
      ConvexSpace::Rectangle(corridor.T_building_corridor, x, y0, x + width, y1);
  const ConvexSpace outer =
      ConvexSpace::Rectangle(corridor.T_building_corridor, x, side > 0.0 ? half + 0.01 : y0,
                             x + width, side > 0.0 ? y1 : -half - 0.01);
  if (x + width > corridor.length || !FreeForRoom(outer, 0.0)) return false;
  spaces_.push_back(niche);
  reserved_.push_back(outer);
  corridor.doors[side > 0.0 ? 0 : 1].emplace_back(x, x + width);
  *end = x + width + random_.Uniform(0.2, 0.6);
  return true;
}

bool FloorPlanner::TryRoomOfSize(std::size_t corridor_index, double side, double x,
                                 const RoomWish& wish, double* end) {
  const Corridor& corridor = corridors_[corridor_index];
  const SideStyle& style = side > 0.0 ? corridor.style.left : corridor.style.right;
  const double half = 0.5 * corridor.style.width;
  const double width = wish.width;
  const double depth = wish.depth;
  const bool closet = wish.closet;
  Room room;
  room.corridor = corridor_index;
  room.side = side;
  room.x0 = x;
  room.x1 = x + width;
  room.v0 = half + style.wall;
  room.v1 = room.v0 + depth;
  const double y0 = side > 0.0 ? room.v0 : -room.v1;
  const double y1 = side > 0.0 ? room.v1 : -room.v0;
  const ConvexSpace plain =
      ConvexSpace::Rectangle(corridor.T_building_corridor, room.x0, y0, room.x1, y1);
  if (!FreeForRoom(plain, kRoomGap)) return false;
  const bool window = !closet && random_.Chance(style.window_share);
  const double window_from = random_.Uniform(0.08, 0.3);
  const double window_to = random_.Uniform(0.7, 0.92);
  spaces_.push_back(window ? RectangleWithWindow(corridor.T_building_corridor, room.x0, y0, room.x1,
                                                 y1, side > 0.0 ? 2 : 0, window_from, window_to)
                           : plain);
  reserved_.push_back(plain);
  const bool pane = wish.pane && width > 3.4;
  room.door_width = closet ? 0.8 : random_.Chance(0.12) && width > 3.5 ? 1.5 : 0.95;
  const double first = room.x0 + 0.5 * room.door_width + 0.15;
  const double last = room.x1 - 0.5 * room.door_width - 0.15;
  const double where = random_.Uniform();
  room.door_x = where < 0.35  ? first + 0.1 * random_.Uniform()
                : where < 0.7 ? last - 0.1 * random_.Uniform()
                              : random_.Uniform(first, last);
  room.open = random_.Chance(style.open_share);
  DrawRoomFront(room, style, pane);
  rooms_.push_back(room);
  *end = room.x1 + kRoomGap + 0.02 + (random_.Chance(0.15) ? random_.Uniform(0.1, 0.7) : 0.0);
  return true;
}

bool FloorPlanner::TryRoom(std::size_t corridor_index, double side, double x, double usual_depth,
                           double* end) {
  Corridor& corridor = corridors_[corridor_index];
  const SideStyle& style = side > 0.0 ? corridor.style.left : corridor.style.right;
  const double kind = random_.Uniform();
  const double full_width = random_.Uniform(style.width_min, style.width_max);
  // The outer wall of a wing is mostly one line.
  const double full_depth =
      random_.Chance(0.88) ? usual_depth : random_.Uniform(style.depth_min, style.depth_max);

  if (kind < 0.06) {  // a blank stretch
    *end = x + random_.Uniform(0.8, 3.0);
    return true;
  }
  // A niche, open to the corridor: a kitchenette, a window seat, a fire hose.
  if (kind < 0.11) return TryNiche(corridor, side, x, end);
  RoomWish wish;
  wish.closet = kind > 0.90;
  wish.pane = !wish.closet && kind < 0.19;
  for (const double depth_share : {1.0, 0.75, 0.55}) {
    for (const double width_share : {1.0, 0.7, 0.5}) {
      wish.width = wish.closet ? std::max(1.5, 0.45 * full_width * width_share)
                               : std::max(2.2, full_width * width_share);
      wish.depth = std::max(1.6, full_depth * depth_share * (wish.closet ? 0.6 : 1.0));
      if (x + wish.width > corridor.length) continue;
      if (TryRoomOfSize(corridor_index, side, x, wish, end)) return true;
    }
  }
  return false;
}

void FloorPlanner::DrawRoomFront(const Room& room, const SideStyle& style, bool pane) {
  Corridor& corridor = corridors_[room.corridor];
  const Pose2& T = corridor.T_building_corridor;
  const double half = 0.5 * corridor.style.width;
  const auto opening = [&](double x0, double x1) {
    const double v0 = half - 0.05;
    const double v1 = room.v0 + 0.05;
    spaces_.push_back(
        ConvexSpace::Rectangle(T, x0, room.side > 0.0 ? v0 : -v1, x1, room.side > 0.0 ? v1 : -v0));
  };
  const auto line = [&](double x0, double v0, double x1, double v1, Surface surface) {
    floor_.segments.push_back({T * Eigen::Vector2d(x0, room.side * v0),
                               T * Eigen::Vector2d(x1, room.side * v1), surface});
  };
  const double x0 = room.door_x - 0.5 * room.door_width;
  const double x1 = room.door_x + 0.5 * room.door_width;
  opening(x0, x1);
  if (room.open) {
    HangBlock(T, {x0, room.side * (half + 0.01)}, {x1, room.side * (room.v0 - 0.01)}, kLintel,
              kHighest);
  }
  corridor.doors[room.side > 0.0 ? 0 : 1].emplace_back(x0 - 0.25, x1 + 0.25);
  if (!room.open) {
    const double v = half + std::min(style.recess, style.wall - 0.02);
    line(x0, v, x1, v, Surface::kDoor);
  } else {
    // The leaf stands in the room, hinged on the side with less wall, so that it rests against it.
    const bool hinge_low = room.door_x - room.x0 < room.x1 - room.door_x;
    const double hinge = hinge_low ? x0 : x1;
    const double swing = DegToRad(random_.Uniform(90.0, 97.0));
    line(hinge, room.v0, hinge + (hinge_low ? 1.0 : -1.0) * room.door_width * std::cos(swing),
         room.v0 + room.door_width * std::sin(swing), Surface::kDoor);
  }
  if (!pane) return;
  const bool after = room.x1 - x1 > x0 - room.x0;
  const double p0 = after ? x1 + 0.2 : room.x0 + 0.2;
  const double p1 = after ? room.x1 - 0.2 : x0 - 0.2;
  if (p1 - p0 < 0.6) return;
  opening(p0, p1);
  const double v = half + 0.5 * style.wall;
  line(p0, v, p1, v, Surface::kGlass);
}

void FloorPlanner::FillSide(std::size_t corridor_index, double side) {
  const Corridor& corridor = corridors_[corridor_index];
  const SideStyle& style = side > 0.0 ? corridor.style.left : corridor.style.right;
  if (!style.rooms || style.glazed) return;
  const double usual_depth = random_.Uniform(style.depth_min, style.depth_max);
  double x = random_.Uniform(0.1, 0.9);
  while (x < corridor.length - 1.5) {
    double end = x;
    if (TryRoom(corridor_index, side, x, usual_depth, &end)) {
      x = end;
    } else {
      x += 0.3;
    }
  }
}

void FloorPlanner::VisitRooms() {
  std::vector<std::size_t> able;
  for (std::size_t i = 0; i < rooms_.size(); ++i) {
    const Room& room = rooms_[i];
    const bool wide = room.door_width > 0.9 && room.x1 - room.x0 > 2.6;
    if (room.open && wide && room.v1 - room.v0 > 3.0) able.push_back(i);
  }
  for (std::size_t count = 0; count < visited_rooms_ && !able.empty(); ++count) {
    const std::size_t pick = random_.Below(able.size());
    const Room& room = rooms_[able[pick]];
    able.erase(able.begin() + static_cast<std::ptrdiff_t>(pick));
    Corridor& corridor = corridors_[room.corridor];
    const std::size_t outside = AddStation(corridor, room.door_x, "d");
    const double v = room.v0 + std::min(1.7, 0.5 * (room.v1 - room.v0));
    const std::size_t inside = AddWayPoint(
        corridor.T_building_corridor * Eigen::Vector2d(room.door_x, room.side * v), "r");
    floor_.passages.push_back({outside, inside, true});
  }
}

void FloorPlanner::ConnectStations() {
  for (Corridor& corridor : corridors_) {
    std::sort(corridor.stations.begin(), corridor.stations.end(),
              [](const Station& a, const Station& b) { return a.along < b.along; });
    for (std::size_t i = 1; i < corridor.stations.size(); ++i) {
      floor_.passages.push_back(
          {corridor.stations[i - 1].way_point, corridor.stations[i].way_point, true});
    }
  }
}

bool FloorPlanner::PlaceBox(const Pose2& T_building_local, double x0, double y0, double x1,
                            double y1, double gap, Surface surface) {
  const ConvexSpace box = ConvexSpace::Rectangle(T_building_local, x0, y0, x1, y1);
  for (const Passage& passage : floor_.passages) {
    ConvexSpace way;
    const Eigen::Vector2d& a = floor_.way_points[passage.from].position;
    const Eigen::Vector2d& b = floor_.way_points[passage.to].position;
    const Eigen::Vector2d along = b - a;
    const Pose2 T_building_way{a.x(), a.y(), std::atan2(along.y(), along.x())};
    way = ConvexSpace::Rectangle(T_building_way, -gap, -gap, along.norm() + gap, gap);
    if (Overlap(way, box, 0.0)) return false;
  }
  for (const Stop& stop : elevator_stops_) {
    if ((stop.axis_point - 0.5 * (box.corners[0] + box.corners[2])).norm() < 2.0) return false;
  }
  for (const Stop& stop : stairs_mouths_) {
    if ((stop.axis_point - 0.5 * (box.corners[0] + box.corners[2])).norm() < 2.2) return false;
  }
  for (std::size_t e = 0; e < 4; ++e) {
    floor_.segments.push_back({box.corners[e], box.corners[(e + 1) % 4], surface});
  }
  return true;
}

void FloorPlanner::HangBlock(const Pose2& T_building_local, const Eigen::Vector2d& from,
                             const Eigen::Vector2d& to, double low, double high) {
  const Eigen::Vector2d middle = T_building_local * Eigen::Vector2d(0.5 * (from + to));
  floor_.overhead.push_back({{middle.x(), middle.y(), T_building_local.theta},
                             std::abs(to.x() - from.x()),
                             std::abs(to.y() - from.y()),
                             low,
                             high});
}

void FloorPlanner::FurnishRoom(const Room& room) {
  const Pose2& T = corridors_[room.corridor].T_building_corridor;
  const double width = room.x1 - room.x0;
  const double depth = room.v1 - room.v0;
  if (room.open && width > 2.4 && depth > 3.4) {
    // Beyond where ways lead. Drawn without chance: rooms stay as they are without it.
    const double x = 0.5 * (room.x0 + room.x1);
    HangBlock(T, {x - 0.8, room.side * (room.v1 - 0.9)}, {x + 0.8, room.side * (room.v1 - 0.2)},
              kTableTop - 0.04, kTableTop);
  }
  const auto place = [&](double x0, double v0, double x1, double v1) {
    const bool at_door = x0 < room.door_x + 0.8 && x1 > room.door_x - 0.8 && v0 < room.v0 + 1.1;
    if (at_door) return;
    PlaceBox(T, x0, room.side > 0.0 ? v0 : -v1, x1, room.side > 0.0 ? v1 : -v0, kDoorGap,
             Surface::kFurniture);
  };
  if (width < 2.4 || depth < 2.4) return;
  const int pieces = 1 + static_cast<int>(random_.Below(4));
  for (int piece = 0; piece < pieces; ++piece) {
    const double length = random_.Uniform(0.7, 1.7);
    const double thick = random_.Uniform(0.35, 0.8);
    const double along_x =
        random_.Uniform(room.x0 + 0.02, std::max(room.x0 + 0.03, room.x1 - length));
    const double along_v =
        random_.Uniform(room.v0 + 0.02, std::max(room.v0 + 0.03, room.v1 - length));
    switch (random_.Below(4)) {
      case 0:
        place(along_x, room.v1 - thick - 0.02, along_x + length, room.v1 - 0.02);
        break;
      case 1:
        place(room.x0 + 0.02, along_v, room.x0 + thick + 0.02, along_v + length);
        break;
      case 2:
        place(room.x1 - thick - 0.02, along_v, room.x1 - 0.02, along_v + length);
        break;
      default: {
        const double cx = 0.5 * (room.x0 + room.x1) + random_.Uniform(-0.3, 0.3);
        const double cv = 0.5 * (room.v0 + room.v1) + random_.Uniform(-0.2, 0.5);
        if (depth > 3.4 && width > 3.0) {
          place(cx - 0.5 * length, cv - 0.5 * thick, cx + 0.5 * length, cv + 0.5 * thick);
        }
      }
    }
  }
}

void FloorPlanner::FurnishCorridor(std::size_t corridor_index) {
  Corridor& corridor = corridors_[corridor_index];
  const Pose2& T = corridor.T_building_corridor;
  const double half = 0.5 * corridor.style.width;
  const auto free_of_doors = [&](int side, double x0, double x1) {
    const auto& doors = corridor.doors[side];
    return std::none_of(doors.begin(), doors.end(), [&](const std::pair<double, double>& door) {
      return x0 < door.second && x1 > door.first;
    });
  };
  const auto free_of_stations = [&](double x, double gap) {
    return std::none_of(corridor.stations.begin(), corridor.stations.end(),
                        [&](const Station& station) { return std::abs(station.along - x) < gap; });
  };
  if (corridor.style.fire_doors > 0.0) {
    double x = corridor.style.fire_doors * random_.Uniform(0.4, 0.8);
    for (; x < corridor.length - 2.0; x += corridor.style.fire_doors * random_.Uniform(0.7, 1.3)) {
      const double post = half - 0.72;
      if (post < 0.12 || !free_of_stations(x, 1.5)) continue;
      if (!free_of_doors(0, x - 0.1, x + 0.1) || !free_of_doors(1, x - 0.1, x + 0.1)) continue;
      const double reach = std::min(post, 0.3);
      PlaceBox(T, x - 0.06, half - reach, x + 0.06, half, 0.7, Surface::kWall);
      PlaceBox(T, x - 0.06, -half, x + 0.06, -half + reach, 0.7, Surface::kWall);
      HangBlock(T, {x - 0.06, -half}, {x + 0.06, half}, kLintel, kHighest);
      corridor.doors[0].emplace_back(x - 0.4, x + 0.4);
      corridor.doors[1].emplace_back(x - 0.4, x + 0.4);
    }
  }
  if (!(corridor.style.clutter > 0.0)) return;
  for (int side = 0; side < 2; ++side) {
    double x = random_.Uniform(0.5, 2.0 / corridor.style.clutter);
    for (; x < corridor.length - 2.0; x += random_.Uniform(0.2, 1.8) / corridor.style.clutter) {
      const double length = random_.Uniform(0.3, 1.8);
      const double depth = std::min(half - 0.68, random_.Uniform(0.12, 0.5));
      if (depth < 0.08 || !free_of_doors(side, x, x + length)) continue;
      if (!free_of_stations(x + 0.5 * length, 1.3 + 0.5 * length)) continue;
      const double y0 = side == 0 ? half - depth : -half;
      const double y1 = side == 0 ? half : -half + depth;
      PlaceBox(T, x, y0, x + length, y1, 0.66, Surface::kFurniture);
    }
  }
}

void FloorPlanner::FurnishHalls() {
  for (const auto& entry : halls_) {
    const ConvexSpace& hall = entry.first;
    const double spacing = entry.second;
    Eigen::Vector2d low = hall.corners.front();
    Eigen::Vector2d high = low;
    for (const Eigen::Vector2d& corner : hall.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const auto inside = [&](const Eigen::Vector2d& point, double margin) {
      for (std::size_t e = 0; e < hall.corners.size(); ++e) {
        const Eigen::Vector2d& a = hall.corners[e];
        const Eigen::Vector2d edge = hall.corners[(e + 1) % hall.corners.size()] - a;
        if (Cross(edge.normalized(), point - a) < margin) return false;
      }
      return true;
    };
    if (spacing > 0.0) {
      for (double x = low.x() + 0.5 * spacing; x < high.x(); x += spacing) {
        for (double y = low.y() + 0.5 * spacing; y < high.y(); y += spacing) {
          if (!inside({x, y}, 0.8)) continue;
          PlaceBox({x, y, 0.0}, -0.25, -0.25, 0.25, 0.25, 0.8, Surface::kWall);
        }
      }
    }
    const double area = (high - low).prod();
    const auto pieces = static_cast<int>(area / 25.0);
    for (int piece = 0; piece < pieces; ++piece) {
      const double x = random_.Uniform(low.x(), high.x());
      const double y = random_.Uniform(low.y(), high.y());
      const Eigen::Vector2d at(x, y);
      const double heading = random_.Uniform(0.0, kPi);
      const double length = random_.Uniform(0.4, 1.1);
      if (!inside(at, 1.2)) continue;
      PlaceBox({at.x(), at.y(), heading}, -length, -0.3, length, 0.3, 0.9, Surface::kFurniture);
    }
  }
}

FloorPlanner::Planned FloorPlanner::Plan(const std::string& label, double elevation) {
  floor_.label = label;
  floor_.elevation = elevation;
  Planned planned;
  JoinCorridors();
  for (const Corridor& corridor : corridors_) DrawCorridor(corridor);
  for (const Stop& stop : elevator_stops_) {
    planned.elevator_way_points.emplace_back(stop.index, StationFacing(stop, "l"));
  }
  for (const Stop& stop : stairs_mouths_) {
    planned.stairs_way_points.emplace_back(stop.index, StationFacing(stop, "s"));
  }
  for (std::size_t i = 0; i < corridors_.size(); ++i) {
    FillSide(i, 1.0);
    FillSide(i, -1.0);
  }
  VisitRooms();
  ConnectStations();
  for (const Room& room : rooms_) FurnishRoom(room);
  for (std::size_t i = 0; i < corridors_.size(); ++i) FurnishCorridor(i);
  FurnishHalls();
  const std::vector<Segment> walls = Walls(spaces_);
  floor_.segments.insert(floor_.segments.begin(), walls.begin(), walls.end());
  planned.floor = floor_;
  return planned;
}

}  // namespace masked_mapper
