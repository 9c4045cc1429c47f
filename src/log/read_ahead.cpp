// SPDX-License-Identifier: BSD-3-Clause
#include "read_ahead.hpp"

#include <utility>

namespace masked_mapper {

ReadAhead::ReadAhead(LogStatistics statistics_before, Producer producer)
    : statistics_(std::move(statistics_before)) {
  thread_ = std::thread([this, producer = std::move(producer)] {
    try {
      producer([this](ObservationBatch batch) { return batches_.Push(std::move(batch)); });
    } catch (...) {
      error_ = std::current_exception();
    }
    batches_.Close();
  });
}

ReadAhead::~ReadAhead() {
  batches_.Close();
  thread_.join();
}

std::optional<Observation> ReadAhead::Next() {
  while (position_ == batch_.size()) {
    std::optional<ObservationBatch> batch = batches_.Pop();
    if (!batch) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    batch_ = std::move(batch->observations);
    position_ = 0;
    statistics_ = std::move(batch->statistics);
    progress_ = batch->progress;
  }
  return std::move(batch_[position_++]);
}

}  // namespace masked_mapper
