// SPDX-License-Identifier: BSD-3-Clause
// The scans of a log with the robot's motion, in order. With more than one thread they are made
// ahead of whoever takes them, since nothing of what is done with them comes back to the motion,
// and their points ahead of the motion; they are the same.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive_motion.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/run_ahead.hpp"
#include "masked_mapper/scan_matching/local_map.hpp"

namespace masked_mapper {

/// A scan, and what there was behind it.
struct LoggedScan {
  MovedScan moved;
  std::uint64_t observations = 0;  ///< of the log, that had gone in
  double progress = 0.0;           ///< share of the log, 0 to 1
  /// The state of the motion for a checkpoint, where it was asked for.
  std::optional<std::string> motion;
};

class MovedScans {
 public:
  /// `observations` of the log have gone into the motion. Both are this one's alone as long as this
  /// lives.
  MovedScans(LogReader& log, DriveMotion& motion, std::uint64_t observations, int threads);

  /// Empty at the end of the log. Throws what log and motion throw.
  std::optional<LoggedScan> Next();

  /// Asks for the state of the motion: behind `last`, the scan taken last, or, where others are
  /// being made ahead of it, behind one of those that follow; if not, behind the end of the log.
  void AskForState(LoggedScan& last);

  /// s, that the log was read; once all scans are taken.
  double read_seconds() const { return read_seconds_; }

 private:
  /// An observation, and what can be made of it before its motion is known.
  struct Prepared {
    Observation observation;
    std::optional<FacedPoints> points;
    double progress = 0.0;
  };

  std::optional<Prepared> Prepare();
  std::optional<LoggedScan> Move();

  LogReader& log_;
  DriveMotion& motion_;
  std::uint64_t observations_;
  double read_seconds_ = 0.0;
  std::atomic<bool> is_asked_for_state_ = false;
  bool is_over_ = false;
  // The last, since their threads use the others. The second takes from the first.
  std::optional<RunAhead<Prepared>> prepared_;
  std::optional<RunAhead<LoggedScan>> moved_;
};

}  // namespace masked_mapper
