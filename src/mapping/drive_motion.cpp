// SPDX-License-Identifier: BSD-3-Clause
#include "drive_motion.hpp"

#include <utility>
#include <variant>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

std::optional<MovedScan> DriveMotion::Observe(Observation observation, const FacedPoints* points) {
  const StageTimer timer(seconds_);
  if (const auto* odometry = std::get_if<OdometryReading>(&observation)) motion_.Observe(*odometry);
  auto* scan = std::get_if<LaserScan>(&observation);
  if (scan == nullptr) return std::nullopt;
  const FloorInterval& interval = floors_.At(scan->stamp);
  motion_.Observe(*scan, interval.in_transit != in_transit_, points);
  MovedScan moved{std::move(*scan), motion_.last_step(), motion_.T_odom_robot(), interval};
  ChangeFloor(interval);
  return moved;
}

// As MaskedMapper::ChangeFloor.
void DriveMotion::ChangeFloor(const FloorInterval& interval) {
  const bool is_first = !level_;
  const bool other_floor = level_ && *level_ != interval.level;
  if (!interval.in_transit) level_ = interval.level;
  if (is_first) {
    in_transit_ = interval.in_transit;
    level_ = interval.level;
    return;
  }
  if (!in_transit_ && (interval.in_transit || other_floor)) {
    in_transit_ = true;
    // On stairs the scene changes step by step, and its far walls hold the way along a flight; a
    // cab's door opens on another floor at once.
    on_stairs_ = interval.in_transit && interval.travelled_m > cab_m_;
    if (!on_stairs_) motion_.EnterTransit();
  }
  if (in_transit_ && !interval.in_transit) {
    in_transit_ = false;
    if (!on_stairs_) motion_.LeaveTransit();
  }
}

}  // namespace masked_mapper
