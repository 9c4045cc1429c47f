// SPDX-License-Identifier: BSD-3-Clause
#include "moved_scans.hpp"

#include <utility>

#include "masked_mapper/map/stage_timer.hpp"

namespace masked_mapper {
namespace {

// Scans are handed over some at once, since it takes time to wake a thread. So many in all bridge
// the time in which loops are closed at one node.
constexpr std::size_t kHandedOver = 16;
constexpr std::size_t kMostAhead = 32;  // times that

}  // namespace

MovedScans::MovedScans(LogReader& log, DriveMotion& motion, std::uint64_t observations, int threads)
    : log_(log), motion_(motion), observations_(observations) {
  if (threads > 1) ahead_.emplace(kMostAhead, [this](const auto& sink) { MakeAhead(sink); });
}

std::optional<LoggedScan> MovedScans::Next() {
  if (!ahead_) return Make();
  while (next_ == taken_.size()) {
    std::optional<Scans> more = ahead_->Next();
    is_over_ = !more;
    if (is_over_) return std::nullopt;
    taken_ = std::move(*more);
    next_ = 0;
  }
  return std::move(taken_[next_++]);
}

void MovedScans::AskForState(LoggedScan& last) {
  if (last.motion) return;
  if (ahead_ && !is_over_) {
    is_asked_for_state_ = true;
    return;
  }
  // Behind the end of the log readings have gone in that no scan tells of.
  last.observations = observations_;
  last.motion = motion_.SaveState();
}

std::optional<LoggedScan> MovedScans::Make() {
  while (true) {
    std::optional<Observation> observation;
    {
      const StageTimer timer(read_seconds_);
      observation = log_.Next();
    }
    if (!observation) return std::nullopt;
    ++observations_;
    std::optional<MovedScan> moved = motion_.Observe(std::move(*observation));
    if (moved) return LoggedScan{std::move(*moved), observations_, log_.Progress(), {}};
  }
}

void MovedScans::MakeAhead(const RunAhead<Scans>::Sink& sink) {
  Scans made;
  try {
    while (std::optional<LoggedScan> scan = Make()) {
      if (is_asked_for_state_.exchange(false)) scan->motion = motion_.SaveState();
      const bool is_waited_for = scan->motion.has_value();
      made.push_back(std::move(*scan));
      if (!is_waited_for && made.size() < kHandedOver) continue;
      if (!sink(std::exchange(made, {}))) return;
    }
  } catch (...) {
    sink(std::move(made));  // what was made before comes first
    throw;
  }
  sink(std::move(made));
}

}  // namespace masked_mapper
