// SPDX-License-Identifier: BSD-3-Clause
// A log reader that produces its observations in a thread of its own, a few batches ahead of
// whoever takes them. What is handed out does not depend on the threads' timing.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "bounded_queue.hpp"
#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {

/// Observations, and the statistics and the progress as of behind them.
struct ObservationBatch {
  static constexpr std::size_t kSize = 128;
  std::vector<Observation> observations;
  LogStatistics statistics;
  double progress = 0.0;
};

class ReadAhead : public LogReader {
 public:
  /// Takes a batch; false when nobody wants any more, and the producer should return.
  using Sink = std::function<bool(ObservationBatch)>;
  /// Runs in the reader's thread until the log is at its end. What it throws, Next() throws.
  using Producer = std::function<void(const Sink&)>;

  ReadAhead(LogStatistics statistics_before, Producer producer);
  ~ReadAhead() override;

  std::optional<Observation> Next() override;
  const LogStatistics& Statistics() const override { return statistics_; }
  double Progress() const override { return progress_; }

 private:
  static constexpr std::size_t kBatchesAhead = 8;
  BoundedQueue<ObservationBatch> batches_{kBatchesAhead};
  std::exception_ptr error_;  ///< written before the queue is closed, read after
  std::vector<Observation> batch_;
  std::size_t position_ = 0;
  LogStatistics statistics_;
  double progress_ = 0.0;
  std::thread thread_;
};

}  // namespace masked_mapper
