// SPDX-License-Identifier: BSD-3-Clause
#include "straightened_scan.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {
namespace {

/// Hits of two neighbouring beams are of one surface unless it is seen more grazingly than this: a
/// wall along a corridor is seen so some 20 m ahead, an edge in front of another wall nearer by.
constexpr double kGrazing = 0.05;  // rad
/// A beam speaks for directions off by less, in steps: beams are spread and crowded by the motion.
constexpr double kNear = 0.75;

/// A beam as seen from where the laser was at the stamp.
struct SeenBeam {
  double place = 0.0;                                        ///< in steps from beam 0, not wrapped
  double range = 0.0;                                        ///< m, or kNoReturn
  Eigen::Vector2d point_in_laser = Eigen::Vector2d::Zero();  ///< of a hit
};

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool AreOneSurface(const SeenBeam& a, const SeenBeam& b) {
  const double along = (b.point_in_laser - a.point_in_laser).norm();
  return std::abs(Cross(a.point_in_laser, b.point_in_laser)) >
         std::sin(kGrazing) * along * std::max(a.range, b.range);
}

class Straightening {
 public:
  explicit Straightening(const LaserScan& scan)
      : scan_(scan),
        turn_(2.0 * kPi / std::abs(scan.angle_step)),
        on_surface_(scan.size(), kInvalidRange),
        nearest_(scan.size(), kInvalidRange),
        off_(scan.size(), kNear) {}

  std::vector<float> Straighten(const MotionInSweep& T_stamp_then) {
    const std::vector<std::optional<SeenBeam>> seen = Seen(T_stamp_then);
    for (std::size_t beam = 0; beam < seen.size(); ++beam) {
      if (!seen[beam]) continue;
      EnterWhereNearest(*seen[beam]);
      const bool is_between = beam + 1 < seen.size() && seen[beam + 1] &&
                              std::isfinite(seen[beam]->range) &&
                              std::isfinite(seen[beam + 1]->range);
      if (is_between && AreOneSurface(*seen[beam], *seen[beam + 1])) {
        EnterBetween(*seen[beam], *seen[beam + 1]);
      }
    }
    for (std::size_t beam = 0; beam < on_surface_.size(); ++beam) {
      if (std::isnan(on_surface_[beam])) on_surface_[beam] = nearest_[beam];
    }
    return std::move(on_surface_);
  }

 private:
  std::vector<std::optional<SeenBeam>> Seen(const MotionInSweep& T_stamp_then) const {
    std::vector<std::optional<SeenBeam>> seen(scan_.size());
    const Pose2 T_laser_robot = Inverse(scan_.T_robot_laser);
    auto direction = BeamSweep::InLaser(scan_);
    for (std::size_t beam = 0; beam < scan_.size(); ++beam, direction.Advance()) {
      if (std::isnan(scan_.ranges[beam])) continue;
      const Pose2 T_stamp_beam =
          T_laser_robot * T_stamp_then(scan_.TimeOf(beam)) * scan_.T_robot_laser;
      SeenBeam one;
      double turned = T_stamp_beam.theta;
      one.range = scan_.ranges[beam];
      if (scan_.IsHit(beam)) {
        one.point_in_laser = T_stamp_beam * Eigen::Vector2d(one.range * direction.Current());
        one.range = one.point_in_laser.norm();
        if (!(one.range < scan_.max_range)) one.range = kNoReturn;
        turned = std::atan2(Cross(direction.Current(), one.point_in_laser),
                            direction.Current().dot(one.point_in_laser));
      } else {
        one.range = kNoReturn;
      }
      one.place = static_cast<double>(beam) + turned / scan_.angle_step;
      seen[beam] = one;
    }
    return seen;
  }

  /// Calls `enter` with every beam of the scan at or next to a place; all round, that is one only.
  template <class Enter>
  void ForBeams(double from, double to, const Enter& enter) const {
    const auto last = static_cast<double>(scan_.size() - 1);
    for (const double turns : {-turn_, 0.0, turn_}) {
      const double first = std::max(0.0, std::ceil(from + turns));
      for (double beam = first; beam <= std::min(last, to + turns); beam += 1.0) {
        enter(static_cast<std::size_t>(beam), beam - turns);
      }
    }
  }

  void EnterWhereNearest(const SeenBeam& seen) {
    ForBeams(seen.place - kNear, seen.place + kNear, [&](std::size_t beam, double place) {
      const double off = std::abs(place - seen.place);
      if (off >= off_[beam]) return;
      off_[beam] = off;
      nearest_[beam] = static_cast<float>(seen.range);
    });
  }

  void EnterBetween(const SeenBeam& a, const SeenBeam& b) {
    const Eigen::Vector2d along = b.point_in_laser - a.point_in_laser;
    const auto [from, to] = std::minmax(a.place, b.place);
    ForBeams(from, to, [&](std::size_t beam, double) {
      const double angle = scan_.Angle(beam);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const double range = Cross(a.point_in_laser, along) / Cross(direction, along);
      if (!(range > 0.0) || range >= on_surface_[beam]) return;
      on_surface_[beam] = static_cast<float>(range);
    });
  }

  const LaserScan& scan_;
  double turn_;                    ///< steps all round
  std::vector<float> on_surface_;  ///< between hits of one surface
  std::vector<float> nearest_;     ///< of the beam next to it
  std::vector<double> off_;        ///< of that, in steps
};

}  // namespace

MotionInSweep SteadyMotion(const Pose2& T_begin_end, double seconds) {
  return [=](double then) { return Interpolate(Pose2{}, T_begin_end, then / seconds); };
}

LaserScan Straightened(LaserScan scan, const MotionInSweep& T_stamp_then) {
  if (scan.beam_time == 0.0) return scan;
  if (!scan.ranges.empty() && scan.angle_step != 0.0) {
    scan.ranges = Straightening(scan).Straighten(T_stamp_then);
  }
  scan.beam_time = 0.0;
  return scan;
}

}  // namespace masked_mapper
