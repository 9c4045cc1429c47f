// SPDX-License-Identifier: BSD-3-Clause
// How the robot moves along a tour: a unicycle with limited speed, turn rate and acceleration that
// rounds its corners, turns on the spot, stops now and then, and rides elevators. The motion is
// known in closed form, so every sensor may sample it at stamps of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "tour.hpp"

namespace masked_mapper {

struct RobotState {
  Pose2 T_building_robot;
  double elevation = 0.0;              ///< m
  double speed = 0.0;                  ///< m/s, forwards
  double turn_rate = 0.0;              ///< rad/s
  double speed_change = 0.0;           ///< m/s^2, forwards
  double slope = 0.0;                  ///< m up per metre driven; stairs, else 0
  double vertical_acceleration = 0.0;  ///< m/s^2, upwards, without gravity
  std::size_t floor = 0;               ///< whose walls surround the robot
  bool in_transit = false;             ///< the cab's door is not fully open, or on stairs
  std::size_t elevator = 0;            ///< whose door is moving or open, when `door_open` > 0
  double door_open = 0.0;              ///< 0 to 1
};

class RobotDrive {
 public:
  /// The building must have passed CheckBuilding with the robot's radius and some centimetres.
  RobotDrive(const Building& building, const Tour& tour, const DriveOptions& options);

  double Duration() const { return duration_; }  ///< s
  double Length() const { return length_; }      ///< m, of the path in the plane
  /// The state at a time from 0 to Duration(), seconds; clamped to it.
  RobotState At(double time) const;

 private:
  friend class DriveBuilder;

  /// Constant acceleration along a line or an arc, or of a turn on the spot.
  struct Motion {
    double start = 0.0;  ///< s
    Pose2 T_building_robot;
    double speed = 0.0;
    double acceleration = 0.0;
    double curvature = 0.0;  ///< 1/m
    double turn_rate = 0.0;
    double turn_acceleration = 0.0;
    double elevation = 0.0;
    double slope = 0.0;  ///< m up per m driven
  };
  struct FloorSpan {
    double start = 0.0;
    std::size_t floor = 0;
    bool in_transit = false;
  };
  struct Ride {
    double start = 0.0;
    double end = 0.0;
    double from = 0.0;  ///< m
    double to = 0.0;
    double ramp = 0.0;  ///< s of speeding up, and of slowing down
  };
  struct DoorMove {
    double start = 0.0;
    double end = 0.0;
    std::size_t elevator = 0;
    double from = 0.0;  ///< share open
    double to = 0.0;
  };

  std::vector<Motion> motions_;
  std::vector<FloorSpan> floor_spans_;
  std::vector<Ride> rides_;
  std::vector<DoorMove> door_moves_;
  double duration_ = 0.0;
  double length_ = 0.0;
};

}  // namespace masked_mapper
