// SPDX-License-Identifier: BSD-3-Clause
#include "moved_scans.hpp"

#include <utility>
#include <variant>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kAtOnce = 16;
constexpr std::size_t kMostPrepared = 8;  // times that
constexpr std::size_t kMostMoved = 32;    // the same: they bridge the closing of loops at one node

}  // namespace

MovedScans::MovedScans(LogReader& log, DriveMotion& motion, std::uint64_t observations, int threads)
    : log_(log), motion_(motion), observations_(observations) {
  if (threads <= 1) return;
  prepared_.emplace(
      kMostPrepared,
      [this](const auto& sink) {
        while (std::optional<Prepared> prepared = Prepare()) {
          const auto* scan = std::get_if<LaserScan>(&prepared->observation);
          // A bent scan has other points once it is straightened.
          if (motion_.uses_points() && scan != nullptr && scan->beam_time == 0.0) {
            prepared->points.emplace(*PointsInRobot(*scan));
          }
          if (!sink(std::move(*prepared))) return;
        }
      },
      kAtOnce);
  moved_.emplace(
      kMostMoved,
      [this](const auto& sink) {
        while (std::optional<LoggedScan> scan = Move()) {
          if (is_asked_for_state_.exchange(false)) scan->motion = motion_.SaveState();
          if (!sink(std::move(*scan))) return;
        }
      },
      kAtOnce);
}

std::optional<LoggedScan> MovedScans::Next() {
  if (!moved_) return Move();
  std::optional<LoggedScan> scan = moved_->Next();
  is_over_ = !scan;
  return scan;
}

void MovedScans::AskForState(LoggedScan& last) {
  if (last.motion) return;
  if (moved_ && !is_over_) {
    is_asked_for_state_ = true;
    return;
  }
  // Behind the end of the log readings have gone in that no scan tells of.
  last.observations = observations_;
  last.motion = motion_.SaveState();
}

std::optional<MovedScans::Prepared> MovedScans::Prepare() {
  const StageTimer timer(read_seconds_);
  std::optional<Observation> observation = log_.Next();
  if (!observation) return std::nullopt;
  return Prepared{std::move(*observation), {}, log_.Progress()};
}

std::optional<LoggedScan> MovedScans::Move() {
  while (std::optional<Prepared> next = prepared_ ? prepared_->Next() : Prepare()) {
    ++observations_;
    std::optional<MovedScan> moved =
        motion_.Observe(std::move(next->observation), next->points ? &*next->points : nullptr);
    if (moved) return LoggedScan{std::move(*moved), observations_, next->progress, {}};
  }
  return std::nullopt;
}

}  // namespace masked_mapper
