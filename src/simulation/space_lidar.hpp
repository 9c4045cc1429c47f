// SPDX-License-Identifier: BSD-3-Clause
// A 3D lidar in a simulated building, among surfaces that have heights and people who have bodies.
// The robot moves while a sweep is taken, and every return has its own time.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lidar_simulation.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "space_surfaces.hpp"

namespace masked_mapper {

class SpaceLidar {
 public:
  /// `noise`: glass, lost beams, people; the sigma of ranges is the lidar's own, but 0 where that
  /// of `noise` is.
  SpaceLidar(const Building& building, const SpaceLidarOptions& options, const LidarNoise& noise,
             std::uint64_t seed);

  /// The sweep that ends at `time` (s from the start, not before that of the last call), or begins
  /// there where the layout counts times from its stamp; `state_at` tells where the robot is. Stamp
  /// and odometry are left to the caller.
  CloudReading Sweep(double time, const std::function<RobotState(double)>& state_at);

 private:
  struct Ray {
    double turn = 0.0;   ///< rad, from ahead
    double slope = 0.0;  ///< up per m over the ground
    double time = 0.0;   ///< s, after the stamp of the sweep
  };
  struct Crossing {
    double range = 0.0;  ///< m, over the ground
    double low = 0.0;    ///< m above the floor
    double high = 0.0;
    Surface surface = Surface::kWall;
    double cosine = 1.0;
  };

  /// A level surface that the half-plane meets.
  struct Flat {
    double from = 0.0;  ///< m, over the ground
    double to = 0.0;
    double height = 0.0;  ///< m above the floor
  };

  /// The rays of one sweep in the order in which they are sent.
  std::vector<Ray> Rays();
  /// All that a vertical half-plane from the lidar meets, nearest first, up to what hides the rest.
  void Cross(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, std::size_t floor,
             const std::vector<Segment>& doors, const std::vector<Leg>& legs);
  bool Return(const Ray& ray, double ceiling, CloudPoint* point);

  const Building& building_;
  SpaceLidarOptions options_;
  LidarNoise noise_;
  RandomGenerator random_;
  People people_;
  std::vector<SpaceSurfaces> surfaces_;  ///< by floor
  std::vector<SegmentIndex> index_;
  std::vector<Crossing> crossings_;
  std::vector<Flat> flats_;
  std::uint64_t sent_ = 0;  ///< rays of all sweeps so far
};

}  // namespace masked_mapper
