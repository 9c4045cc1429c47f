// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "turn_of.hpp"

namespace masked_mapper {
namespace {

constexpr double kAboveFloor = 0.3;    // m, of the band's lower end: bags, thresholds, feet
constexpr double kTopOfBand = 1.8;     // m, a hand below the lintel of a door
constexpr double kBelowCeiling = 0.3;  // m
constexpr double kAboutLidar = 0.2;    // m: rays that fly level reach farthest

constexpr std::array<std::size_t, 6> kBeams = {1440, 1080, 720, 540, 360, 180};
constexpr std::size_t kRaysPerBeam = 24;

// A wall leans by this over the band when a ramp or a threshold tilts the robot, and a scanner's
// noise is less.
constexpr float kThick = 0.1F;     // m
constexpr float kFlattest = 0.1F;  // share of the range by which a wall may recede in one beam
constexpr float kLeastUpright =
    0.2F;  // m that returns must lie over one another: more than a stair
constexpr int kStoppedPerPassed = 2;

/// Where the rays of a cloud go, over the ground.
struct Rays {
  std::vector<float> turns;   ///< in [0, 1] of a turn, from straight behind; no number: nowhere
  std::vector<float> ranges;  ///< m

  Rays(const CloudPoints& points, const Eigen::Vector3f& lidar)
      : turns(points.size()), ranges(points.size()) {
    for (std::size_t first = 0; first < points.size(); first += kTurnsAtOnce) {
      const std::size_t count = std::min(kTurnsAtOnce, points.size() - first);
      Floats x{};
      Floats y{};
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3f& position = points[first + i].position;
        x[i] = position.x() - lidar.x();
        y[i] = position.y() - lidar.y();
        ranges[first + i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
      }
      const Floats all = TurnsOf(y, x);
      std::memcpy(&turns[first], &all, count * sizeof(float));
    }
  }
};

constexpr std::uint32_t kNoBeam = std::numeric_limits<std::uint32_t>::max();

/// The beam nearest to a place that is counted in beams; the one behind the last is the first.
/// Asked for every point of every cloud, and of no negative number: a call of lround would be felt.
std::uint32_t Nearest(float in_beams) {
  return static_cast<std::uint32_t>(in_beams + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
}

std::uint32_t BeamOf(float turn, std::size_t beams) {
  const auto all = static_cast<std::uint32_t>(beams);
  const std::uint32_t beam = Nearest(turn * static_cast<float>(beams));
  return beam < all ? beam : beam - all;
}

/// Rays by the beams that they are nearest to.
struct Beams {
  std::size_t count = 0;
  std::vector<std::uint32_t> of_ray;  ///< kNoBeam: it goes nowhere

  Beams(const std::vector<float>& turns, std::size_t beams) : count(beams) {
    of_ray.reserve(turns.size());
    for (const float turn : turns) {
      of_ray.push_back(std::isnan(turn) ? kNoBeam : BeamOf(turn, beams));
    }
  }

  /// Whether none is empty between two columns of the lidar.
  bool AreFilled() const {
    std::vector<char> is_filled(count, 0);
    for (const std::uint32_t beam : of_ray) {
      if (beam != kNoBeam) is_filled[beam] = 1;
    }
    std::size_t filled = 0;
    std::size_t holes = 0;
    for (std::size_t beam = 0; beam < count; ++beam) {
      filled += is_filled[beam] != 0 ? 1 : 0;
      const bool between =
          is_filled[(beam + 1) % count] != 0 && is_filled[(beam + count - 1) % count] != 0;
      holes += is_filled[beam] == 0 && between ? 1 : 0;
    }
    constexpr std::size_t kFewHoles = 50;  // one of so many
    return holes * kFewHoles <= filled;
  }
};

/// The finest beams that the rays fill: enough in each, and none between two columns of the lidar.
Beams FinestBeams(const std::vector<float>& turns) {
  for (const std::size_t count : kBeams) {
    if (count * kRaysPerBeam > turns.size()) continue;
    Beams beams(turns, count);
    if (beams.AreFilled()) return beams;
  }
  return {turns, kBeams.back()};
}

struct Ray {
  float range = 0.0F;   // m, over the ground
  float height = 0.0F;  // m, of the return
  float offset = 0.0F;  // rad, off the middle of the beam
};

/// The rays of one beam, in the order of the cloud.
class Beam {
 public:
  Beam(const Ray* begin, const Ray* end, float lidar_height, const WallBand& band)
      : begin_(begin),
        end_(end),
        lidar_height_(lidar_height),
        low_(static_cast<float>(band.low_m)),
        high_(static_cast<float>(band.high_m)) {}

  /// The nearest return inside the band that is not nearer than `least`; infinity without one.
  float Nearest(float least = 0.0F) const {
    float nearest = kNoReturn;
    for (const Ray* ray = begin_; ray != end_; ++ray) {
      const bool counts = InBand(ray->height) && ray->range >= least;
      nearest = counts ? std::min(nearest, ray->range) : nearest;
    }
    return nearest;
  }

  /// The range of the wall, where `nearest` is the nearest return; not a number without one.
  /// `recedes`: m by which a wall may change its range across the beam.
  float Wall(float nearest, float recedes) const {
    while (nearest < kNoReturn) {
      const float thick = kThick + std::min(recedes, kFlattest * nearest);
      if (IsWall(nearest, thick)) return At(nearest, thick);
      nearest = Nearest(nearest + 0.25F * thick);
    }
    return kInvalidRange;
  }

 private:
  bool InBand(float height) const { return height >= low_ && height <= high_; }

  /// Of the wall that begins at a range.
  bool IsWall(float range, float thick) const {
    // Returns up to two thicknesses behind the first are one wall.
    const float behind = range + 2.0F * thick;
    float lowest = kNoReturn;
    float highest = -kNoReturn;
    int stopped = 0;
    int passed = 0;
    for (const Ray* ray = begin_; ray != end_; ++ray) {
      if (ray->range < range) continue;
      if (ray->range <= behind) {
        lowest = std::min(lowest, ray->height);
        highest = std::max(highest, ray->height);
        stopped += InBand(ray->height) ? 1 : 0;
      } else {
        const float there =
            lidar_height_ + (ray->height - lidar_height_) * (range + thick) / ray->range;
        passed += InBand(there) ? 1 : 0;
      }
    }
    return stopped >= 2 && highest - lowest >= kLeastUpright &&
           stopped >= kStoppedPerPassed * passed;
  }

  /// Where the middle of the beam meets the wall that begins at a range: along a straight wall
  /// 1 / range is linear in the direction.
  float At(float range, float thick) const {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    const float behind = range + 2.0F * thick;
    for (const Ray* ray = begin_; ray != end_; ++ray) {
      if (!(ray->range >= range && ray->range <= behind) || !InBand(ray->height)) continue;
      const double inverse = 1.0 / ray->range;
      n += 1.0;
      x += ray->offset;
      y += inverse;
      xx += static_cast<double>(ray->offset) * ray->offset;
      xy += ray->offset * inverse;
    }
    const double mean = y / n;
    const double spread = xx - x * x / n;
    // Few rays, all to one side, say nothing of the slope; nor does one steeper than the window.
    if (n < 4.0 || !(spread > 0.0)) return static_cast<float>(1.0 / mean);
    const double slope = (xy - x * y / n) / spread;
    const double at_middle = mean - slope * x / n;
    const double found = 1.0 / at_middle;
    const double plain = 1.0 / mean;
    return static_cast<float>(std::clamp(found, plain - thick, plain + thick));
  }

  const Ray* begin_;
  const Ray* end_;
  float lidar_height_;
  float low_;
  float high_;
};

/// All rays by their beams.
class Sweep {
 public:
  Sweep(const CloudPoints& points, const Rays& rays, const Beams& beams)
      : begins_(beams.count + 1, 0) {
    for (const std::uint32_t beam : beams.of_ray) {
      if (beam != kNoBeam) ++begins_[beam + 1];
    }
    for (std::size_t beam = 0; beam < beams.count; ++beam) begins_[beam + 1] += begins_[beam];
    rays_.resize(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    const auto count = static_cast<float>(beams.count);
    const auto step = static_cast<float>(2.0 * kPi / static_cast<double>(beams.count));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (beams.of_ray[i] == kNoBeam) continue;
      const float in_beams = rays.turns[i] * count;
      rays_[next[beams.of_ray[i]]++] = {rays.ranges[i], points[i].position.z(),
                                        (in_beams - static_cast<float>(Nearest(in_beams))) * step};
    }
  }

  Beam At(std::size_t beam, float lidar_height, const WallBand& band) const {
    return {rays_.data() + begins_[beam], rays_.data() + begins_[beam + 1], lidar_height, band};
  }

 private:
  std::vector<std::size_t> begins_;
  std::vector<Ray> rays_;
};

}  // namespace

WallBand BandBetween(const Ground& ground, double lidar_height_m, const WallBand& given) {
  WallBand band;
  band.low_m = lidar_height_m > 0.0 ? std::min(kAboveFloor, 0.5 * lidar_height_m) : kAboveFloor;
  band.high_m = std::max(kTopOfBand, lidar_height_m + kAboutLidar);
  if (ground.ceiling_m) {
    const double ceiling = *ground.ceiling_m - ground.floor_m;
    band.high_m = std::min(band.high_m, std::max(ceiling - kBelowCeiling, lidar_height_m));
  }
  if (given.low_m > 0.0) band.low_m = given.low_m;
  if (given.high_m > 0.0) band.high_m = given.high_m;
  return band;
}

LaserScan CutToScan(const CloudPoints& points_in_level, const Eigen::Vector3d& lidar_in_level,
                    const WallBand& band, float max_range) {
  const Eigen::Vector3f lidar = lidar_in_level.cast<float>();
  const Rays rays(points_in_level, lidar);
  const Beams by_rays = FinestBeams(rays.turns);
  const std::size_t beams = by_rays.count;
  const Sweep sweep(points_in_level, rays, by_rays);
  const float lidar_height = lidar.z();

  std::vector<float> nearest(beams);
  for (std::size_t i = 0; i < beams; ++i) nearest[i] = sweep.At(i, lidar_height, band).Nearest();

  LaserScan scan;
  scan.T_robot_laser = {lidar_in_level.x(), lidar_in_level.y(), 0.0};
  scan.angle_step = 2.0 * kPi / static_cast<double>(beams);
  scan.first_angle = -kPi;
  scan.max_range = max_range;
  scan.ranges.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const auto step_to = [&](std::size_t other) {
      const float step = std::abs(nearest[i] - nearest[other]);
      return std::isfinite(step) ? step : 0.0F;
    };
    const float recedes = std::max(step_to((i + 1) % beams), step_to((i + beams - 1) % beams));
    const float wall = sweep.At(i, lidar_height, band).Wall(nearest[i], recedes);
    scan.ranges[i] = wall < max_range ? wall : kInvalidRange;
  }
  return scan;
}

}  // namespace masked_mapper
