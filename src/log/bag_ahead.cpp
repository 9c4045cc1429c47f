// SPDX-License-Identifier: BSD-3-Clause
#include "bag_ahead.hpp"

#include <utility>

namespace masked_mapper {
namespace {

constexpr std::size_t kBatchBytes = std::size_t{1} << 20U;
constexpr std::size_t kBatchMessages = 256;
constexpr std::size_t kBatchesAhead = 4;

}  // namespace

BagAhead::BagAhead(RosBag* bag, IsCloud is_cloud)
    : bag_(*bag), is_cloud_(std::move(is_cloud)), connections_(bag->Connections()) {
  Start();
}

void BagAhead::Start() {
  batch_ = {};
  batch_.truncated = bag_.Truncated();
  batch_.damaged = bag_.Damaged();
  batch_.first_damage = bag_.FirstDamage();
  next_ = 0;
  batches_.emplace(kBatchesAhead, [this](const RunAhead<Batch>::Sink& sink) {
    bool more = true;
    while (more) {
      Batch batch;
      more = Fill(&batch);
      if (!sink(std::move(batch))) break;
    }
  });
}

bool BagAhead::Fill(Batch* batch) {
  bool more = true;
  std::size_t bytes = 0;
  while (bytes < kBatchBytes && batch->messages.size() < kBatchMessages) {
    std::optional<BagMessage> message = bag_.Next();
    more = message.has_value();
    if (!more) break;
    bytes += message->size;
    batch->begins.push_back(batch->bytes.size());
    if (is_cloud_ && is_cloud_(message->connection)) {
      auto cloud = ParsePointCloud(message->data, message->size, message->encoding);
      if (cloud) message->cloud = std::make_shared<RosPointCloud>(std::move(*cloud));
    }
    if (!message->cloud) {
      batch->bytes.insert(batch->bytes.end(), message->data, message->data + message->size);
    }
    batch->messages.push_back(std::move(*message));
  }
  batch->truncated = bag_.Truncated();
  batch->damaged = bag_.Damaged();
  batch->first_damage = bag_.FirstDamage();
  batch->progress = bag_.Progress();
  return more;
}

std::optional<BagMessage> BagAhead::Next() {
  while (next_ == batch_.messages.size()) {
    std::optional<Batch> batch = batches_->Next();
    if (!batch) return std::nullopt;
    batch_ = std::move(*batch);
    next_ = 0;
  }
  BagMessage message = std::move(batch_.messages[next_]);
  message.data = message.cloud ? nullptr : batch_.bytes.data() + batch_.begins[next_];
  ++next_;
  return message;
}

void BagAhead::Rewind() {
  batches_.reset();
  bag_.Rewind();
  Start();
}

}  // namespace masked_mapper
