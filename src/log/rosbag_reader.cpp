// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/rosbag_reader.hpp"

#include <utility>

#include "bag_look.hpp"
#include "bag_observations.hpp"
#include "bag_without_scans.hpp"
#include "masked_mapper/log/open_bag.hpp"
#include "masked_mapper/log/read_ahead.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

void ReadBag(const std::string& path, const LogOptions& options, const BagPlan& plan,
             const ReadAhead::Sink& sink) {
  const std::unique_ptr<RosBag> bag = OpenBag(path);
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

}  // namespace

std::unique_ptr<LogReader> OpenRosBag(const std::string& path, const LogOptions& options) {
  const std::unique_ptr<RosBag> bag = OpenBag(path);
  if (!bag->IsIndexed()) {
    while (bag->Next()) {
    }  // the connections are wherever they are
    bag->Rewind();
  }
  BagPlan plan = ChooseTopics(path, bag->Connections(), options);
  if (plan.scanners == 0) throw InputError(path + ": " + WhatIsThereInsteadOfScans(bag.get()));
  plan = LookAtBag(path, options, std::move(plan), bag.get());
  LogStatistics statistics;
  statistics.max_range = plan.max_range;
  return std::make_unique<ReadAhead>(
      statistics,
      [path, options, plan](const ReadAhead::Sink& sink) { ReadBag(path, options, plan, sink); });
}

}  // namespace masked_mapper
