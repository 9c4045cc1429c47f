// SPDX-License-Identifier: BSD-3-Clause
// A simulated building: floors of line segments as a 2D scanner sees them, the ways a robot may
// take on them, and the elevators and stairs between them. All in one frame, `building`; metres,
// radians.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

enum class Surface : std::uint8_t { kWall, kGlass, kDoor, kFurniture };

/// A piece of something upright. The robot passes none; a beam may pass glass.
struct Segment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  Surface surface = Surface::kWall;
};

/// An upright block in the air, as a table's top or a lintel: 2D scanners look past it, and what is
/// lower than it may drive below.
struct Overhead {
  Pose2 T_building_block;  ///< of its centre
  double length = 0.0;     ///< m, along x
  double width = 0.0;      ///< m, along y
  double low = 0.0;        ///< m above the floor
  double high = 0.0;       ///< m; what lies above the ceiling is not there
};

struct WayPoint {
  std::string name;  ///< unique on its floor; letters, digits, `_`, `.`, `-`
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

/// A straight way between two way-points, free for the robot.
struct Passage {
  std::size_t from = 0;  ///< way-points of the floor
  std::size_t to = 0;
  bool must_visit = true;  ///< corridors are visited by every tour; other ways only when of use
};

struct FloorPlan {
  std::string label;
  double elevation = 0.0;         ///< m
  std::vector<Segment> segments;  ///< without the cabs of elevators
  std::vector<Overhead> overhead;
  std::vector<WayPoint> way_points;
  std::vector<Passage> passages;
};

/// Where a connection is reached on one floor.
struct Landing {
  std::size_t floor = 0;
  std::size_t way_point =
      0;  ///< in front of the door, on the cab's axis; or at the end of the stairs
};

/// A cab with one door at its +x side. Inside it no other wall of the building may stand.
struct Elevator {
  std::string name;
  Pose2 T_building_cab;           ///< centre of the cab, x axis out of the door
  double depth = 2.0;             ///< m, along x
  double width = 2.0;             ///< m, along y
  double door_width = 1.1;        ///< m, in the middle of the front
  std::vector<Landing> landings;  ///< at least two, of different floors
};

/// Stairs or a ramp: a way in the plane along which the height changes evenly.
/// Their walls stand on both floors; the scanner sees the lower floor's on the first half of the
/// way.
struct Stairs {
  std::string name;
  Landing lower;
  Landing upper;
  std::vector<Eigen::Vector2d> way;  ///< between the two way-points, from below; may be empty
};

/// What a tour of this building usually is.
struct UsualTour {
  std::size_t start_floor = 0;
  std::size_t start_way_point = 0;
  std::vector<std::size_t>
      visits;  ///< floors in order, beginning and ending with the start's; empty: all
  double rest_per_metre = 0.2;  ///< s of standing about per metre driven
};

struct Building {
  std::string name;
  std::vector<FloorPlan> floors;  ///< by elevation, rising
  std::vector<Elevator> elevators;
  std::vector<Stairs> stairs;
  UsualTour usual_tour;
};

/// The names of the buildings that come with the program, `random` among them.
std::vector<std::string> BuildingNames();
/// A named building, or one from a file.
/// Throws InputError when there is neither.
Building LoadBuilding(const std::string& name_or_path, std::uint64_t seed);

/// The walls of a cab and its front beside the door; the door itself is not among them.
std::vector<Segment> CabWalls(const Elevator& elevator);

/// The two leaves of a cab's door, `open` from 0 (one closed line) to 1 (nothing left).
std::vector<Segment> CabDoor(const Elevator& elevator, double open);

/// All that stands on a floor whatever happens: its segments and the cabs of the elevators that
/// stop.
std::vector<Segment> StandingSegments(const Building& building, std::size_t floor);

/// The way of stairs from landing to landing, cut half-way: the part that the lower floor's walls
/// surround, and the part that the upper floor's do.
std::pair<std::vector<Eigen::Vector2d>, std::vector<Eigen::Vector2d>> StairsHalves(
    const Building& building, const Stairs& stairs);

/// Corners of the smallest upright rectangle around a floor's segments and way-points.
struct Bounds {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double Area() const { return (high.x() - low.x()) * (high.y() - low.y()); }
};
Bounds BoundsOf(const FloorPlan& floor);

/// Metres of passages that a tour must visit.
double CorridorLength(const FloorPlan& floor);

/// The distance of a point from a segment, metres.
double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b);

/// Throws InputError, in one line that says where, when a building cannot be driven: no floor,
/// labels or names that are taken or not allowed, indices or numbers out of range, floors not
/// rising, ways that pass closer than `clearance` (m) to what stands there, way-points that must be
/// visited and cannot be reached from the start.
void CheckBuilding(const Building& building, double clearance);

}  // namespace masked_mapper
