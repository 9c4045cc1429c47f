// SPDX-License-Identifier: BSD-3-Clause
// Puts observations in the order of their stamps, and mends stamps that no clock could have given.
// How is our choice; a log only promises lines in the order in which messages arrived.
//
// Messages of one kind come in their own order, but one kind may be late by a while (scans arrive
// after the odometry that was taken later): kinds are merged by stamp. What is left is a fault of
// the clock:
// - a 32-bit microsecond counter that wrapped: the time goes on from there;
// - a step backwards of up to a second: held at the stamp before, until the clock has caught up;
// - a single stamp far off, in front or behind: held at the stamp before;
// - a clock set back for good: what follows is moved so that the time goes on.
// A clock that jumps forward for good is believed: a robot may have paused.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class StampMender {
 public:
  /// The next observation as the log has it. Observations of one stream come in the order in which
  /// they were taken; a stream is one kind of reading of one sensor.
  void Add(Observation observation, std::size_t stream);
  /// One sensor per kind.
  void Add(Observation observation) {
    const std::size_t kind = observation.index();
    Add(std::move(observation), kind);
  }
  /// No more will come: everything held back becomes ready.
  void Finish();
  /// The next observation that is ready; stamps never decrease from one to the next.
  std::optional<Observation> Next();
  /// Of the observation that Next() gave last.
  std::size_t last_stream() const { return last_stream_; }

  /// Stamps mended, and changes of the clock.
  std::uint64_t jumps() const { return jumps_; }
  /// Observations that came after others with a later stamp.
  std::uint64_t reordered() const { return reordered_; }

 private:
  struct Queued {
    double stamp = 0.0;
    std::uint64_t sequence = 0;
    std::size_t stream = 0;
    Observation observation;
  };
  struct Undecided {
    std::size_t stream = 0;
    Observation observation;
  };

  double NewestOf(std::size_t stream) const;
  bool FitsAfter(double stamp, std::size_t stream) const;
  bool TryWrap(double raw_stamp, std::size_t stream);
  bool ConfirmsNewClock(double raw_stamp) const;
  void Accept(Observation observation, std::size_t stream, double stamp);
  void Hold(Observation observation, std::size_t stream);
  void HoldUndecided();
  void AdoptNewClock();
  void MoveAllTo(double stamp);

  double offset_ = 0.0;         ///< s, added to the log's stamps since the clock last changed
  double offset_before_ = 0.0;  ///< s, for stragglers from before that
  bool has_stamp_ = false;
  double newest_ = 0.0;  ///< s, the latest stamp accepted
  std::map<std::size_t, double> newest_of_stream_;
  double typical_step_ = 0.0;         ///< s, the last step forward between observations
  std::vector<Undecided> undecided_;  ///< far off the time line, all after each other
  std::vector<Queued> heap_;          ///< earliest on top
  std::uint64_t sequence_ = 0;
  std::size_t last_stream_ = 0;
  bool finished_ = false;
  double last_out_ = -std::numeric_limits<double>::infinity();
  std::uint64_t jumps_ = 0;
  std::uint64_t reordered_ = 0;
};

}  // namespace masked_mapper
