// SPDX-License-Identifier: BSD-3-Clause
#include "read_ahead.hpp"

#include <utility>

namespace masked_mapper {

std::optional<Observation> ReadAhead::Next() {
  while (position_ == batch_.size()) {
    std::optional<ObservationBatch> batch = batches_.Next();
    if (!batch) return std::nullopt;
    batch_ = std::move(batch->observations);
    position_ = 0;
    statistics_ = std::move(batch->statistics);
    progress_ = batch->progress;
  }
  return std::move(batch_[position_++]);
}

}  // namespace masked_mapper
