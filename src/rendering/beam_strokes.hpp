// SPDX-License-Identifier: BSD-3-Clause
// What the beams of a scan do to a grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "fixed_line.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

constexpr double kMaxBeamCells = 16000;  // longer beams are cut: slopes are computed in 64 bits

// What a beam does to the grid: clears up to `range` and, if `hit`, ends in a wall there.
struct Stroke {
  double range = 0.0;
  bool hit = false;
};

inline std::optional<Stroke> StrokeOf(const LaserScan& scan, std::size_t beam,
                                      const GridOptions& options) {
  const double range = scan.ranges[beam];
  if (std::isnan(range)) return std::nullopt;
  const double reach = std::min(options.max_usable_range_m, kMaxBeamCells * options.resolution_m);
  if (scan.IsHit(beam)) return Stroke{std::min(range, reach), range <= reach};
  const double cleared =
      std::min({options.free_range_without_return_m, reach, static_cast<double>(scan.max_range)});
  if (cleared <= 0.0) return std::nullopt;
  return Stroke{cleared, false};
}

// Directions of a scanner's beams in its own frame, kept while its geometry stays the same.
class BeamDirections {
 public:
  struct Direction {
    double cos = 1.0;
    double sin = 0.0;
  };

  const std::vector<Direction>& Of(const LaserScan& scan) {
    if (directions_.size() != scan.size() || first_angle_ != scan.first_angle ||
        angle_step_ != scan.angle_step) {
      first_angle_ = scan.first_angle;
      angle_step_ = scan.angle_step;
      directions_.resize(scan.size());
      for (std::size_t beam = 0; beam < scan.size(); ++beam) {
        directions_[beam] = {std::cos(scan.Angle(beam)), std::sin(scan.Angle(beam))};
      }
    }
    return directions_;
  }

 private:
  double first_angle_ = 0.0;
  double angle_step_ = 0.0;
  std::vector<Direction> directions_;
};

// Calls `draw(start, end, hit)` for every beam that tells something.
template <typename Draw>
void ForEachBeam(const PosedScan& posed, const GridOptions& options, BeamDirections* cache,
                 const Draw& draw) {
  const LaserScan& scan = *posed.scan;
  const Pose2 T_world_laser = posed.T_world_robot * scan.T_robot_laser;
  const double per_cell = static_cast<double>(Fixed{1} << kFractionBits) / options.resolution_m;
  const double x = T_world_laser.x * per_cell;
  const double y = T_world_laser.y * per_cell;
  const double c = std::cos(T_world_laser.theta) * per_cell;
  const double s = std::sin(T_world_laser.theta) * per_cell;
  const FixedPoint start{static_cast<Fixed>(std::floor(x)), static_cast<Fixed>(std::floor(y))};
  const auto& directions = cache->Of(scan);
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    const std::optional<Stroke> stroke = StrokeOf(scan, beam, options);
    if (!stroke) continue;
    const double along_x = stroke->range * directions[beam].cos;
    const double along_y = stroke->range * directions[beam].sin;
    draw(start,
         FixedPoint{static_cast<Fixed>(std::floor(x + c * along_x - s * along_y)),
                    static_cast<Fixed>(std::floor(y + s * along_x + c * along_y))},
         stroke->hit);
  }
}

}  // namespace masked_mapper
