// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_reader.hpp"

#include <mutex>
#include <utility>

#include "bag_look.hpp"
#include "bag_observations.hpp"
#include "masked_mapper/log/bag_file.hpp"
#include "masked_mapper/log/read_ahead.hpp"
#include "masked_mapper/log/ros2_bag_file.hpp"

namespace masked_mapper {
namespace {

std::unique_ptr<RosBag> OpenBag(const std::string& path) {
  if (Ros2BagFile::IsBag(path)) return std::make_unique<Ros2BagFile>(path);
  return std::make_unique<BagFile>(path);
}

/// The bag of a plan between two passes: opened once, handed from pass to pass.
class BagShelf {
 public:
  explicit BagShelf(std::string path) : path_(std::move(path)) {}

  /// At its first message. Another is opened when a pass still has the one.
  std::unique_ptr<RosBag> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!bag_) return OpenBag(path_);
    bag_->Rewind();
    return std::move(bag_);
  }
  void PutBack(std::unique_ptr<RosBag> bag) {
    const std::lock_guard<std::mutex> lock(mutex_);
    bag_ = std::move(bag);
  }

 private:
  std::string path_;
  std::mutex mutex_;
  std::unique_ptr<RosBag> bag_;
};

void ReadBag(const LogOptions& options, const BagPlan& plan, RosBag* bag,
             const ReadAhead::Sink& sink) {
  BagObservations reader(options, plan, *bag);
  ObservationBatch batch;
  std::size_t messages = 0;
  bool more = true;
  while (more) {
    const std::optional<BagMessage> message = bag->Next();
    more = message.has_value();
    if (message) reader.Add(*message);
    if (!more) reader.Finish();
    while (std::optional<Observation> observation = reader.Next()) {
      batch.observations.push_back(std::move(*observation));
    }
    const bool full = batch.observations.size() >= ObservationBatch::kSize ||
                      ++messages % (8 * ObservationBatch::kSize) == 0;
    if (!full && more) continue;
    batch.statistics = reader.Statistics();
    batch.progress = bag->Progress();
    if (!sink(std::exchange(batch, {}))) return;
  }
}

class RosBagPlan final : public LogPlan {
 public:
  RosBagPlan(const std::string& path, const LogOptions& options)
      : options_(options), shelf_(std::make_shared<BagShelf>(path)) {
    std::unique_ptr<RosBag> bag = shelf_->Take();
    if (!bag->IsIndexed()) {
      while (bag->Next()) {
      }  // the connections are wherever they are
      bag->Rewind();
    }
    plan_ = LookAtBag(path, options, ChooseTopics(path, bag->Connections(), options), bag.get());
    shelf_->PutBack(std::move(bag));
  }

  std::unique_ptr<LogReader> Read() override {
    LogStatistics statistics;
    statistics.max_range = plan_.max_range;
    return std::make_unique<ReadAhead>(statistics, [options = options_, plan = plan_,
                                                    shelf = shelf_](const ReadAhead::Sink& sink) {
      std::unique_ptr<RosBag> bag = shelf->Take();
      ReadBag(options, plan, bag.get(), sink);
      shelf->PutBack(std::move(bag));
    });
  }

 private:
  LogOptions options_;
  std::shared_ptr<BagShelf> shelf_;
  BagPlan plan_;
};

}  // namespace

std::unique_ptr<LogPlan> PlanRosBag(const std::string& path, const LogOptions& options) {
  return std::make_unique<RosBagPlan>(path, options);
}

}  // namespace masked_mapper
