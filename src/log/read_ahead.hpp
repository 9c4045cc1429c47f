// SPDX-License-Identifier: BSD-3-Clause
// A log reader that produces its observations in a thread of its own, a few batches ahead of
// whoever takes them. What is handed out does not depend on the threads' timing.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/run_ahead.hpp"

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
  using Sink = RunAhead<ObservationBatch>::Sink;
  /// Runs in the reader's thread until the log is at its end.
  using Producer = RunAhead<ObservationBatch>::Producer;

  ReadAhead(LogStatistics statistics_before, Producer producer)
      : statistics_(std::move(statistics_before)), batches_(kBatchesAhead, std::move(producer)) {}

  std::optional<Observation> Next() override;
  const LogStatistics& Statistics() const override { return statistics_; }
  double Progress() const override { return progress_; }

 private:
  static constexpr std::size_t kBatchesAhead = 8;
  std::vector<Observation> batch_;
  std::size_t position_ = 0;
  LogStatistics statistics_;
  double progress_ = 0.0;
  RunAhead<ObservationBatch> batches_;
};

}  // namespace masked_mapper
