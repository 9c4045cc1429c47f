// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/rosbag_reader.hpp"

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
  const BagPlan plan =
      LookAtBag(path, options, ChooseTopics(path, bag->Connections(), options), bag.get());
  LogStatistics statistics;
  statistics.max_range = plan.max_range;
  return std::make_unique<ReadAhead>(
      statistics,
      [path, options, plan](const ReadAhead::Sink& sink) { ReadBag(path, options, plan, sink); });
}

}  // namespace masked_mapper
