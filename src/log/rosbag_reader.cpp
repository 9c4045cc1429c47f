// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_reader.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "bag_ahead.hpp"
#include "bag_look.hpp"
#include "bag_observations.hpp"
#include "bag_sequence.hpp"
#include "bag_without_scans.hpp"
#include "kept_pass.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "open_bag.hpp"
#include "read_ahead.hpp"
#include "sorted_bag.hpp"

namespace masked_mapper {
namespace {

/// The bag of a plan between two passes: opened once, handed from pass to pass.
class BagShelf {
 public:
  using Open = std::function<std::unique_ptr<RosBag>()>;
  explicit BagShelf(Open open) : open_(std::move(open)) {}

  /// At its first message. Another is opened when a pass still has the one.
  std::unique_ptr<RosBag> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!bag_) return open_();
    bag_->Rewind();
    return std::move(bag_);
  }
  void PutBack(std::unique_ptr<RosBag> bag) {
    const std::lock_guard<std::mutex> lock(mutex_);
    bag_ = std::move(bag);
  }

 private:
  Open open_;
  std::mutex mutex_;
  std::unique_ptr<RosBag> bag_;
};

/// False when nobody wanted the rest. `clouds`, unless null, keeps them.
bool ReadBag(const LogOptions& options, const BagPlan& plan, RosBag* bag, BagEvidence* evidence,
             KeptPass* clouds, const ReadAhead::Sink& sink) {
  BagObservations reader(options, plan, *bag, evidence,
                         clouds == nullptr ? CloudsKept::kNone : CloudsKept::kWhereTheRobotWentOn);
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
    if (clouds != nullptr) clouds->AddClouds(reader.TakeClouds());
    const bool full = batch.observations.size() >= ObservationBatch::kSize ||
                      ++messages % (8 * ObservationBatch::kSize) == 0;
    if (!full && more) continue;
    batch.statistics = reader.Statistics();
    batch.progress = bag->Progress();
    if (!sink(std::exchange(batch, {}))) return false;
  }
  return true;
}

/// What the first pass to the end found, handed from its thread to the plan.
struct WholeBag {
  std::mutex mutex;
  std::unique_ptr<BagEvidence> evidence;
};

class RosBagPlan final : public LogPlan {
 public:
  RosBagPlan(const std::vector<std::string>& paths, const LogOptions& options)
      : options_(options),
        open_([paths]() -> std::unique_ptr<RosBag> {
          if (paths.size() == 1) return OpenBag(paths.front());
          return std::make_unique<BagSequence>(paths, BagSequence::Order::kAsGiven);
        }),
        shelf_(std::make_shared<BagShelf>(open_)),
        whole_(std::make_shared<WholeBag>()) {
    std::unique_ptr<RosBag> bag = shelf_->Take();
    if (!bag->IsIndexed()) {
      while (bag->Next()) {
      }  // the connections are wherever they are
      bag->Rewind();
    }
    const std::string& path = paths.front();
    topics_ = ChooseTopics(path, bag->Connections(), options);
    if (topics_.scanners == 0) {
      throw InputError(path + ": " + WhatIsThereInsteadOfScans(bag.get()));
    }
    plan_ = LookAtBag(path, options, topics_, bag.get());
    plan_.is_disordered = false;  // of the first pass, which takes the messages as they stand
    shelf_->PutBack(std::move(bag));
  }

  std::unique_ptr<LogReader> Read() override {
    LogStatistics statistics;
    statistics.max_range = plan_.max_range;
    if (kept_ && kept_->IsWhole()) {
      return std::make_unique<ReadAhead>(
          statistics, [kept = kept_](const ReadAhead::Sink& sink) { kept->Replay(sink); });
    }
    kept_ = HasClouds() ? std::make_shared<KeptPass>() : nullptr;
    const auto pass = [options = options_, plan = plan_, topics = topics_, shelf = shelf_,
                       kept = kept_, keeps_clouds = keeps_clouds_,
                       whole = is_settled_ ? nullptr : whole_](const ReadAhead::Sink& sink) {
      std::unique_ptr<RosBag> bag = shelf->Take();
      std::unique_ptr<BagEvidence> evidence;
      if (whole) evidence = std::make_unique<BagEvidence>(options, topics);
      const auto keep = [&](ObservationBatch batch) {
        if (kept) kept->Add(batch);
        return sink(std::move(batch));
      };
      std::optional<BagAhead> ahead;
      BagStreams streams(plan, *bag);
      if (kept) {
        ahead.emplace(bag.get(), [&streams](std::uint32_t id) { return streams.IsCloud(id); });
      }
      RosBag* const read = ahead ? &*ahead : bag.get();
      const bool to_the_end =
          ReadBag(options, plan, read, evidence.get(), keeps_clouds ? kept.get() : nullptr, keep);
      ahead.reset();
      if (kept && to_the_end) kept->Finish();
      shelf->PutBack(std::move(bag));
      if (!whole || !to_the_end) return;
      const std::lock_guard<std::mutex> lock(whole->mutex);
      whole->evidence = std::move(evidence);
    };
    return std::make_unique<ReadAhead>(statistics, pass);
  }

  void KeepClouds() override { keeps_clouds_ = true; }
  std::vector<StampedCloud> KeptClouds() const override {
    return kept_ ? kept_->Clouds() : std::vector<StampedCloud>();
  }

  bool Reconsider() override {
    const std::lock_guard<std::mutex> lock(whole_->mutex);
    if (is_settled_ || !whole_->evidence) return false;
    is_settled_ = true;
    BagPlan plan = whole_->evidence->Conclude();
    const bool otherwise = ReadsOtherwise(plan_, plan);
    if (otherwise && !LimitIsOtherwise(plan)) {
      plan.max_range = plan_.max_range;
      plan.no_return = plan_.no_return;
    }
    if (otherwise) {
      plan_ = std::move(plan);
      kept_.reset();
    }
    if (plan_.is_disordered) SortShelf();
    findings_ = whole_->evidence->Findings(plan_);
    whole_->evidence.reset();
    return otherwise;
  }

  std::vector<SensorFinding> Findings() const override { return findings_; }

 private:
  bool HasClouds() const {
    return std::any_of(plan_.topics.begin(), plan_.topics.end(),
                       [](const BagTopic& topic) { return topic.kind == TopicKind::kCloud; });
  }

  bool LimitIsOtherwise(const BagPlan& plan) const {
    return plan.ranges.front().scale != plan_.ranges.front().scale;
  }

  void SortShelf() {
    shelf_ = std::make_shared<BagShelf>([open = open_, plan = plan_]() -> std::unique_ptr<RosBag> {
      std::unique_ptr<RosBag> bag = open();
      BagStreams streams(plan, *bag);
      return std::make_unique<SortedBag>(std::move(bag), [&streams](std::uint32_t connection) {
        return streams.Find(connection).has_value();
      });
    });
  }

  LogOptions options_;
  BagShelf::Open open_;
  std::shared_ptr<BagShelf> shelf_;
  std::shared_ptr<WholeBag> whole_;
  std::shared_ptr<KeptPass> kept_;  ///< of the last pass through clouds, by the plan
  BagPlan topics_;
  BagPlan plan_;
  bool is_settled_ = false;
  bool keeps_clouds_ = false;
  std::vector<SensorFinding> findings_;
};

}  // namespace

std::unique_ptr<LogPlan> PlanRosBag(const std::vector<std::string>& paths,
                                    const LogOptions& options) {
  return std::make_unique<RosBagPlan>(paths, options);
}

}  // namespace masked_mapper
