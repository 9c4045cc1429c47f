// SPDX-License-Identifier: BSD-3-Clause
// Furnishes a floor from its skeleton. Given are corridors as centre lines, halls, elevators and
// stairs; rooms of uneven widths with doors, panes and furniture are packed along the corridors
// where there is space, and the graph of ways follows from the centre lines and where they cross.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "floor_sketch.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "random_generator.hpp"

namespace masked_mapper {

/// One side of a corridor, seen from its first end: left is counter-clockwise.
struct SideStyle {
  bool rooms = true;
  bool glazed = false;        ///< an outer wall of glass with mullions; without rooms
  double depth_min = 3.6;     ///< m, of rooms; less where there is no space
  double depth_max = 5.6;     ///< m
  double width_min = 2.7;     ///< m, of rooms
  double width_max = 6.2;     ///< m
  double wall = 0.16;         ///< m, between corridor and rooms
  double recess = 0.06;       ///< m, of a closed door behind the corridor's face
  double open_share = 0.22;   ///< of the doors that stand open
  double window_share = 0.6;  ///< of the rooms with a window opposite the door
};

struct CorridorStyle {
  double width = 2.2;  ///< m
  SideStyle left;
  SideStyle right;
  double clutter = 0.05;    ///< cupboards, benches, pillars per metre and side
  double fire_doors = 0.0;  ///< m between pairs of posts that narrow the corridor; 0: none
};

/// Stairs of two flights side by side that turn on a half-way landing.
struct StairwellPlan {
  Pose2 T_building_mouth;      ///< on the corridor's face between the flights, x axis inwards
  double flight_length = 4.2;  ///< m
  double flight_width = 1.4;   ///< m
  double landing_depth = 1.5;  ///< m
};

class FloorPlanner {
 public:
  explicit FloorPlanner(std::uint64_t seed) : random_(seed, "floor") {}

  /// Rooms keep within this rectangle.
  void SetLimits(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  /// How many rooms with open doors become part of the tour.
  void SetVisitedRooms(std::size_t count) { visited_rooms_ = count; }

  /// A corridor along a centre line. Corridors whose lines meet are joined.
  void AddCorridor(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                   const CorridorStyle& style);
  /// A wide space without rooms; columns stand every `column_spacing` m (0: none) off the ways.
  void AddHall(const ConvexSpace& hall, double column_spacing);
  /// The corridor in front of the cab's door is found by its axis; there must be one.
  void AddElevatorStop(std::size_t elevator, const Elevator& cab);
  /// `lower`: the flight that leads up is open; else the one that leads down.
  void AddStairwell(std::size_t stairs, const StairwellPlan& plan, bool lower);

  struct Planned {
    FloorPlan floor;
    std::vector<std::pair<std::size_t, std::size_t>> elevator_way_points;  ///< elevator, way-point
    std::vector<std::pair<std::size_t, std::size_t>> stairs_way_points;    ///< stairs, way-point
  };
  Planned Plan(const std::string& label, double elevation);

 private:
  struct Station {
    double along = 0.0;
    std::size_t way_point = 0;
  };
  struct Corridor {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
    CorridorStyle style;
    Pose2 T_building_corridor;
    double length = 0.0;
    bool joined_from = false;
    bool joined_to = false;
    std::vector<Station> stations;
    std::vector<std::pair<double, double>> doors[2];  ///< taken stretches of the left, right face
  };
  /// A room in its corridor's frame: x along it, v away from its centre line on the room's side.
  struct Room {
    std::size_t corridor = 0;
    double side = 1.0;  ///< 1 left, -1 right
    double x0 = 0.0, x1 = 0.0, v0 = 0.0, v1 = 0.0;
    double door_x = 0.0;
    double door_width = 0.9;
    bool open = false;
  };
  struct Stop {
    std::size_t index = 0;
    Eigen::Vector2d axis_point;      ///< on the axis at the door
    Eigen::Vector2d axis_direction;  ///< towards the corridor
  };

  /// A room as it is wished for.
  struct RoomWish {
    double width = 0.0;
    double depth = 0.0;
    bool closet = false;
    bool pane = false;  ///< a window to the corridor, where it is wide enough
  };

  /// Where two centre lines meet, m along each.
  static std::optional<std::pair<double, double>> Crossing(const Corridor& a, const Corridor& b);
  /// What fills the outer corner where the ends of two corridors meet, `at_a` m along the first.
  static ConvexSpace Knuckle(const Corridor& a, const Corridor& b, double at_a);
  void JoinCorridors();
  void DrawCorridor(const Corridor& corridor);
  void FillSide(std::size_t corridor_index, double side);
  bool TryRoom(std::size_t corridor_index, double side, double x, double usual_depth, double* end);
  bool TryNiche(Corridor& corridor, double side, double x, double* end);
  bool TryRoomOfSize(std::size_t corridor_index, double side, double x, const RoomWish& wish,
                     double* end);
  void DrawRoomFront(const Room& room, const SideStyle& style, bool pane);
  void VisitRooms();
  void FurnishRoom(const Room& room);
  /// What hangs over a stretch of a corridor's frame, x along it.
  void HangBlock(const Pose2& T_building_local, const Eigen::Vector2d& from,
                 const Eigen::Vector2d& to, double low, double high);
  void FurnishCorridor(std::size_t corridor_index);
  void FurnishHalls();
  std::size_t AddStation(Corridor& corridor, double along, const std::string& prefix);
  std::size_t AddWayPoint(const Eigen::Vector2d& position, const std::string& prefix);
  std::size_t StationFacing(const Stop& stop, const std::string& prefix);
  void ConnectStations();
  bool FreeForRoom(const ConvexSpace& space, double gap) const;
  /// Puts a box there unless it would stand nearer than `gap` to a way. In the corridor's frame.
  bool PlaceBox(const Pose2& T_building_local, double x0, double y0, double x1, double y1,
                double gap, Surface surface);

  RandomGenerator random_;
  bool limited_ = false;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_ = Eigen::Vector2d::Zero();
  std::size_t visited_rooms_ = 0;
  std::vector<Corridor> corridors_;
  std::vector<std::pair<ConvexSpace, double>> halls_;
  std::vector<Stop> elevator_stops_;
  std::vector<Stop> stairs_mouths_;
  std::vector<ConvexSpace> spaces_;    ///< free
  std::vector<ConvexSpace> reserved_;  ///< where no room may be put
  std::vector<Room> rooms_;
  FloorPlan floor_;
};

}  // namespace masked_mapper
