// SPDX-License-Identifier: BSD-3-Clause
#include "random_building.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "building_assembly.hpp"
#include "floor_planner.hpp"
#include "random_generator.hpp"

namespace masked_mapper {
namespace {

struct Line {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool glazed = false;

  double Length() const { return (to - from).norm(); }
  Pose2 Frame() const {
    return {from.x(), from.y(), std::atan2(to.y() - from.y(), to.x() - from.x())};
  }
};

struct Place {
  ConvexSpace hall;
  double column_spacing = 0.0;
};

/// What all floors have in common: corridors and halls as lines and spaces.
struct Skeleton {
  std::vector<Line> lines;
  std::vector<Line> stubs;  ///< dead ends, of which each floor has some
  std::vector<Place> halls;
};

class BuildingDrawer {
 public:
  explicit BuildingDrawer(std::uint64_t seed) : random_(seed, "random building") {}

  Building Draw() {
    building_.name = "random";
    DrawSkeleton();
    TurnAbout();
    style_ = DrawStyle();
    const std::size_t floors = DrawFloorCount();
    AddHalls();
    if (floors > 1) AddShafts(floors);
    AddStubs();
    AddFloors(floors);
    DrawTour(floors);
    return std::move(building_);
  }

 private:
  // Corridors.

  void DrawSkeleton() {
    switch (random_.Below(6)) {
      case 0:
        return DrawRing({0.0, 0.0});
      case 1:
        return DrawComb();
      case 2:
        return DrawLadder();
      case 3:
        return DrawWings();
      case 4:
        return DrawPolygon();
      default:
        return DrawTwins();
    }
  }

  void Add(double x0, double y0, double x1, double y1) {
    skeleton_.lines.push_back({{x0, y0}, {x1, y1}});
  }

  /// Returns the far corner.
  Eigen::Vector2d DrawRingAt(double x, double y, double width, double height) {
    Add(x, y, x + width, y);
    Add(x + width, y, x + width, y + height);
    Add(x + width, y + height, x, y + height);
    Add(x, y + height, x, y);
    if (width > 26.0 && random_.Chance(0.6)) {
      const double at = x + width * random_.Uniform(0.35, 0.65);
      Add(at, y, at, y + height);
    }
    if (height > 26.0 && random_.Chance(0.4)) {
      const double at = y + height * random_.Uniform(0.35, 0.65);
      Add(x, at, x + width, at);
    }
    return {x + width, y + height};
  }

  void DrawRing(const Eigen::Vector2d& corner) {
    const double width = random_.Uniform(20.0, 62.0);
    const double height = random_.Uniform(14.0, 44.0);
    DrawRingAt(corner.x(), corner.y(), width, height);
  }

  void DrawComb() {
    const double length = random_.Uniform(32.0, 78.0);
    Add(0.0, 0.0, length, 0.0);
    // A tooth stands at the end or well away from it.
    for (double x = random_.Chance(0.4) ? 0.0 : random_.Uniform(3.0, 8.0); x < length - 3.0;
         x += random_.Uniform(10.0, 18.0)) {
      const double tooth = random_.Uniform(10.0, 28.0);
      const double side = random_.Chance(0.75) ? 1.0 : -1.0;
      Add(x, 0.0, x, side * tooth);
    }
  }

  void DrawLadder() {
    const double length = random_.Uniform(24.0, 58.0);
    const auto rails = 2 + random_.Below(3);
    double y = 0.0;
    for (std::uint64_t rail = 0; rail < rails; ++rail) {
      Add(0.0, y, length, y);
      if (rail + 1 < rails) y += random_.Uniform(10.0, 17.0);
    }
    Add(0.0, 0.0, 0.0, y);
    Add(length, 0.0, length, y);
    if (random_.Chance(0.5)) {
      const double at = length * random_.Uniform(0.35, 0.65);
      Add(at, 0.0, at, y);
    }
  }

  void DrawWings() {
    const double length = random_.Uniform(24.0, 56.0);
    Add(0.0, 0.0, length, 0.0);
    int wings = 0;
    for (const double share : {0.0, 0.5, 1.0}) {
      for (const double side : {1.0, -1.0}) {
        if (!random_.Chance(0.5) && (wings > 0 || share < 1.0)) continue;
        const double wing = random_.Uniform(14.0, 36.0);
        const double slant = random_.Chance(0.3) ? random_.Uniform(-0.35, 0.35) * wing : 0.0;
        Add(share * length, 0.0, share * length + slant, side * wing);
        ++wings;
      }
    }
  }

  void DrawPolygon() {
    const auto corners = 3 + random_.Below(4);
    const double radius = random_.Uniform(17.0, 32.0);
    std::vector<Eigen::Vector2d> points;
    for (std::uint64_t corner = 0; corner < corners; ++corner) {
      const double share = (static_cast<double>(corner) + random_.Uniform(-0.15, 0.15)) /
                           static_cast<double>(corners);
      const double reach = radius * random_.Uniform(0.85, 1.15);
      points.emplace_back(reach * std::cos(2.0 * kPi * share), reach * std::sin(2.0 * kPi * share));
    }
    for (std::size_t corner = 0; corner < points.size(); ++corner) {
      skeleton_.lines.push_back({points[corner], points[(corner + 1) % points.size()]});
    }
    if (!random_.Chance(0.5)) return;
    const auto first = random_.Below(corners);
    const auto spokes = 2 + random_.Below(2);
    for (std::uint64_t spoke = 0; spoke < spokes; ++spoke) {
      skeleton_.lines.push_back({Eigen::Vector2d::Zero(), points[(first + spoke) % corners]});
    }
    Place place;
    constexpr int kSides = 12;
    const double hall = random_.Uniform(4.0, 6.5);
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * kPi * side / kSides;
      place.hall.corners.emplace_back(hall * std::cos(angle), hall * std::sin(angle));
      place.hall.surfaces.emplace_back(Surface::kWall);
    }
    skeleton_.halls.push_back(place);
  }

  void DrawTwins() {
    const double width = random_.Uniform(18.0, 34.0);
    const double height = random_.Uniform(14.0, 30.0);
    const Eigen::Vector2d corner = DrawRingAt(0.0, 0.0, width, height);
    const double gap = random_.Uniform(12.0, 30.0);
    const double shift = random_.Uniform(-8.0, 8.0);
    const double second_width = random_.Uniform(18.0, 34.0);
    const double second_height = random_.Uniform(16.0, 30.0);
    DrawRingAt(corner.x() + gap, shift, second_width, second_height);
    const double from = height * random_.Uniform(0.3, 0.7);
    const double to = std::clamp(from, shift + 2.0, shift + second_height - 2.0);
    skeleton_.lines.push_back({{corner.x(), from}, {corner.x() + gap, to}, true});
  }

  /// Buildings do not stand along the axes of their maps.
  void TurnAbout() {
    const Pose2 T_building_plan{0.0, 0.0, random_.Uniform(-kPi, kPi)};
    for (Line& line : skeleton_.lines) {
      line.from = T_building_plan * line.from;
      line.to = T_building_plan * line.to;
    }
    for (Place& place : skeleton_.halls) {
      for (Eigen::Vector2d& corner : place.hall.corners) corner = T_building_plan * corner;
    }
  }

  // Style.

  SideStyle DrawSide() {
    SideStyle side;
    side.depth_max = random_.Uniform(3.6, 7.5);
    side.depth_min = 0.7 * side.depth_max;
    side.width_min = random_.Uniform(2.4, 4.0);
    side.width_max = side.width_min + random_.Uniform(0.3, 5.0);
    side.wall = random_.Uniform(0.13, 0.4);
    side.recess = random_.Uniform(0.02, 0.8) * side.wall;
    side.open_share = random_.Uniform(0.08, 0.45);
    side.window_share = random_.Uniform(0.0, 1.0);
    return side;
  }

  CorridorStyle DrawStyle() {
    CorridorStyle style;
    style.width = random_.Uniform(1.9, 3.0);
    style.left = DrawSide();
    style.right = random_.Chance(0.5) ? style.left : DrawSide();
    style.clutter = random_.Chance(0.2) ? 0.0 : random_.Uniform(0.01, 0.15);
    style.fire_doors = random_.Chance(0.4) ? random_.Uniform(14.0, 40.0) : 0.0;
    return style;
  }

  std::size_t DrawFloorCount() {
    const double draw = random_.Uniform();
    return draw < 0.2 ? 1 : draw < 0.5 ? 2 : draw < 0.75 ? 3 : draw < 0.9 ? 4 : 5;
  }

  ConvexSpace SpaceOf(const Line& line) const {
    const double half = 0.5 * style_.width;
    return ConvexSpace::Rectangle(line.Frame(), 0.0, -half, line.Length(), half);
  }

  /// Whether a space keeps from all corridors (but perhaps one), halls and shafts.
  bool IsClear(const ConvexSpace& space, double gap, const Line* but) const {
    for (const Line& line : skeleton_.lines) {
      if (&line != but && Overlap(space, SpaceOf(line), gap)) return false;
    }
    for (const Line& line : skeleton_.stubs) {
      if (Overlap(space, SpaceOf(line), gap)) return false;
    }
    for (const Place& place : skeleton_.halls) {
      if (Overlap(space, place.hall, gap)) return false;
    }
    return std::none_of(shafts_.begin(), shafts_.end(),
                        [&](const ConvexSpace& shaft) { return Overlap(space, shaft, gap); });
  }

  /// A wide place along a corridor here and there.
  void AddHalls() {
    const auto tries = random_.Below(3);
    for (std::uint64_t attempt = 0; attempt < tries; ++attempt) {
      const Line& line = skeleton_.lines[random_.Below(skeleton_.lines.size())];
      const double half_length = random_.Uniform(3.0, 6.5);
      const double left = random_.Uniform(1.5, 7.0);
      const double right = random_.Uniform(1.5, 7.0);
      if (line.glazed || line.Length() < 2.0 * half_length + 8.0) continue;
      const double at = random_.Uniform(half_length + 3.0, line.Length() - half_length - 3.0);
      Place place;
      place.hall =
          ConvexSpace::Rectangle(line.Frame(), at - half_length, -right, at + half_length, left);
      place.column_spacing = random_.Chance(0.5) ? random_.Uniform(3.5, 6.0) : 0.0;
      if (IsClear(place.hall, 1.0, &line)) skeleton_.halls.push_back(place);
    }
  }

  // Elevators and stairs.

  /// A frame on the face of some corridor, x axis away from it, with room for `depth` and `width`.
  std::optional<Pose2> FindFace(double depth, double width) {
    for (int attempt = 0; attempt < 400; ++attempt) {
      const Line& line = skeleton_.lines[random_.Below(skeleton_.lines.size())];
      const double side = random_.Chance(0.5) ? 1.0 : -1.0;
      const double share = random_.Uniform();
      const double margin = 0.5 * width + 1.5;
      if (line.glazed || line.Length() < 2.0 * margin) continue;
      const double at = margin + share * (line.Length() - 2.0 * margin);
      const Pose2 T_building_face =
          line.Frame() * Pose2{at, side * 0.5 * style_.width, side * 0.5 * kPi};
      const ConvexSpace space =
          ConvexSpace::Rectangle(T_building_face, 0.05, -0.5 * width, depth, 0.5 * width);
      // The place in front belongs to it too, so that no hall widens the corridor there.
      const ConvexSpace front = ConvexSpace::Rectangle(T_building_face, -0.5 * style_.width,
                                                       -0.5 * width, 0.05, 0.5 * width);
      if (!IsClear(space, 0.4, &line) || !IsClear(front, 0.4, &line)) continue;
      shafts_.push_back(space);
      return T_building_face;
    }
    return std::nullopt;
  }

  void AddShafts(std::size_t floors) {
    const auto wanted = 1 + random_.Below(3);
    for (std::uint64_t count = 0; count < wanted; ++count) {
      Elevator elevator;
      elevator.name = "lift" + std::to_string(count);
      elevator.depth = random_.Uniform(1.7, 2.6);
      elevator.width = random_.Uniform(1.6, 2.4);
      elevator.door_width = random_.Uniform(0.95, 1.2);
      const std::optional<Pose2> T_building_face =
          FindFace(elevator.depth + 0.6, elevator.width + 0.8);
      if (!T_building_face) continue;
      elevator.T_building_cab = *T_building_face * Pose2{0.2 + 0.5 * elevator.depth, 0.0, kPi};
      building_.elevators.push_back(elevator);
    }
    for (std::size_t lower = 0; lower + 1 < floors; ++lower) {
      // Without any elevator, stairs are the only way.
      if (!building_.elevators.empty() && !random_.Chance(0.3)) continue;
      StairwellPlan plan;
      plan.flight_length = random_.Uniform(3.2, 5.0);
      plan.flight_width = random_.Uniform(1.3, 1.7);
      const std::optional<Pose2> T_building_face =
          FindFace(plan.flight_length + plan.landing_depth + 0.3, 2.0 * plan.flight_width + 0.8);
      if (!T_building_face) continue;
      plan.T_building_mouth = *T_building_face;
      stairwells_.emplace_back(lower, plan);
      Stairs stairs;
      stairs.way = StairwellWay(plan);
      building_.stairs.push_back(stairs);
    }
  }

  void AddStubs() {
    const auto tries = random_.Below(6);
    for (std::uint64_t attempt = 0; attempt < tries; ++attempt) {
      const Line host = skeleton_.lines[random_.Below(skeleton_.lines.size())];
      const double at = host.Length() * random_.Uniform(0.2, 0.8);
      const double side = random_.Chance(0.5) ? 1.0 : -1.0;
      const double length = random_.Uniform(5.0, 15.0);
      const Pose2 T_building_stub = host.Frame() * Pose2{at, 0.0, side * 0.5 * kPi};
      const Line stub{T_building_stub.Translation(),
                      T_building_stub * Eigen::Vector2d(length, 0.0)};
      const ConvexSpace beyond =
          ConvexSpace::Rectangle(T_building_stub, 0.5 * style_.width + 0.1, -0.5 * style_.width,
                                 length, 0.5 * style_.width);
      if (!host.glazed && IsClear(beyond, 0.8, nullptr)) skeleton_.stubs.push_back(stub);
    }
  }

  // Floors.

  void AddFloors(std::size_t floors) {
    const std::uint64_t plan_seed = random_.Next();
    const bool same_rooms = random_.Chance(0.25);
    const double storey = random_.Uniform(2.9, 4.6);
    const std::size_t start = random_.Below(floors);
    const auto visited_rooms = random_.Below(5);
    double elevation = 0.0;
    for (std::size_t f = 0; f < floors; ++f) {
      FloorPlanner planner(same_rooms ? plan_seed : plan_seed + f);
      planner.SetVisitedRooms(visited_rooms);
      for (std::size_t e = 0; e < building_.elevators.size(); ++e) {
        planner.AddElevatorStop(e, building_.elevators[e]);
      }
      for (std::size_t s = 0; s < stairwells_.size(); ++s) {
        const auto& [lower, plan] = stairwells_[s];
        if (lower == f || lower + 1 == f) planner.AddStairwell(s, plan, lower == f);
      }
      for (const Line& line : skeleton_.lines) {
        CorridorStyle style = style_;
        style.left.glazed = style.right.glazed = line.glazed;
        planner.AddCorridor(line.from, line.to, style);
      }
      for (const Line& stub : skeleton_.stubs) {
        if (same_rooms || random_.Chance(0.6)) planner.AddCorridor(stub.from, stub.to, style_);
      }
      for (const Place& place : skeleton_.halls) {
        planner.AddHall(place.hall, place.column_spacing);
      }
      const std::string label = std::to_string(static_cast<int>(f) - static_cast<int>(start));
      AddFloor(building_, planner.Plan(label, elevation));
      elevation += storey * (random_.Chance(0.3) ? random_.Uniform(0.95, 1.3) : 1.0);
    }
    building_.usual_tour.start_floor = start;
  }

  void DrawTour(std::size_t floors) {
    UsualTour& tour = building_.usual_tour;
    tour.start_way_point = random_.Below(building_.floors[tour.start_floor].way_points.size());
    tour.rest_per_metre = random_.Uniform(0.05, 0.6);
    std::vector<std::size_t> others;
    for (std::size_t f = 0; f < floors; ++f) {
      if (f != tour.start_floor) others.push_back(f);
    }
    tour.visits = {tour.start_floor};
    while (!others.empty()) {
      const std::size_t pick = random_.Below(others.size());
      tour.visits.push_back(others[pick]);
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(pick));
      // Now and then back to a floor that is known.
      if (tour.visits.size() > 2 && random_.Chance(0.3)) {
        const std::size_t again = tour.visits[random_.Below(tour.visits.size() - 1)];
        if (again != tour.visits.back()) tour.visits.push_back(again);
      }
    }
    if (floors > 1 && tour.visits.back() != tour.start_floor) {
      tour.visits.push_back(tour.start_floor);
    }
  }

  RandomGenerator random_;
  Building building_;
  Skeleton skeleton_;
  CorridorStyle style_;
  std::vector<ConvexSpace> shafts_;
  std::vector<std::pair<std::size_t, StairwellPlan>> stairwells_;  ///< with the lower floor
};

}  // namespace

Building RandomBuilding(std::uint64_t seed) { return BuildingDrawer(seed).Draw(); }

}  // namespace masked_mapper
