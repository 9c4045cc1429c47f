// SPDX-License-Identifier: BSD-3-Clause
// A 2D scanner in a simulated building: exact ray casting, and apart from it what makes real scans
// less than exact (noise, glass, people, beams that are lost).
#pragma once

#include <cstdint>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/people.hpp"
#include "masked_mapper/simulation/random_generator.hpp"
#include "masked_mapper/simulation/robot_drive.hpp"
#include "masked_mapper/simulation/segment_index.hpp"

namespace masked_mapper {

/// The scanner itself; the defaults are those of the named buildings.
struct LidarOptions {
  double rate = 5.0;  ///< Hz
  std::size_t beams = 361;
  double field_of_view_deg = 270.0;  ///< from the first beam to the last; 360: evenly all round
  double max_range = 30.0;           ///< m
  double min_range = 0.05;           ///< m, nearer things are not seen
  Pose2 T_robot_laser{0.12, 0.0, 0.0};
};

struct LidarNoise {
  double sigma = 0.02;         ///< m
  double resolution = 0.01;    ///< m, ranges are multiples of it; 0: exact
  double glass_return = 0.75;  ///< chance that glass returns a beam that meets it squarely; at
                               ///< slant angles it falls with the square of the cosine
  double lost = 0.0005;        ///< chance that a beam does not return at all
  PeopleOptions people;

  /// Nothing but walls: every beam ends at the first thing standing, glass included.
  static LidarNoise None();
};

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
