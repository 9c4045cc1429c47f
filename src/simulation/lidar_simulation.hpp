// SPDX-License-Identifier: BSD-3-Clause
// A 2D scanner in a simulated building: exact ray casting, and apart from it what makes real scans
// less than exact (noise, glass, people, beams that are lost).
#pragma once

#include <cstdint>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "people.hpp"
#include "random_generator.hpp"
#include "robot_drive.hpp"
#include "segment_index.hpp"

namespace masked_mapper {

class LidarSimulation {
 public:
  /// Throws InputError when an option is out of range.
  LidarSimulation(const Building& building, const LidarOptions& options, const LidarNoise& noise,
                  std::uint64_t seed);

  /// The scan of a robot at a time (s from the start, not before that of the last call). Stamp and
  /// odometry are left to the caller.
  LaserScan Scan(double time, const RobotState& state);

  /// What stands on a floor, elevator doors aside.
  const SegmentIndex& Standing(std::size_t floor) const { return standing_[floor]; }
  /// The doors of all elevators on the floor of a robot, as they stand at that moment.
  std::vector<Segment> Doors(const RobotState& state) const;

 private:
  float Range(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
              const SegmentIndex& standing, const std::vector<Segment>& doors,
              const std::vector<Leg>& legs);

  const Building& building_;
  LidarOptions options_;
  LidarNoise noise_;
  RandomGenerator random_;
  People people_;
  std::vector<SegmentIndex> standing_;  // per floor
};

}  // namespace masked_mapper
