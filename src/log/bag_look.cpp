// SPDX-License-Identifier: BSD-3-Clause
#include "bag_look.hpp"

#include <cstdint>
#include <optional>

#include "bag_evidence.hpp"
#include "bag_without_scans.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongestLook = 60.0;  // s of the bag, for frames that come late

}  // namespace

BagPlan LookAtBag(const std::string& path, const LogOptions& options, const BagPlan& topics,
                  RosBag* bag) {
  BagEvidence evidence(options, topics);
  BagStreams streams(topics, *bag);
  std::optional<double> begin;
  bool has_scans = false;
  std::uint64_t malformed_scans = 0;
  std::string fault;
  while (const std::optional<BagMessage> message = bag->Next()) {
    if (!begin) begin = message->time;
    const std::optional<std::size_t> stream = streams.Find(message->connection);
    if (!stream) continue;
    const auto parsed = ParseMessage(topics.topics[*stream].kind, *message, options);
    if (!parsed) {
      malformed_scans += *stream < topics.scanners ? 1 : 0;
      if (fault.empty() && topics.topics[*stream].kind == TopicKind::kCloud) {
        fault = ", the first on " + topics.topics[*stream].name + " is a " +
                FaultOf(topics.topics[*stream].kind, *message);
      }
      continue;
    }
    has_scans = has_scans || std::holds_alternative<RosLaserScan>(*parsed) ||
                std::holds_alternative<RosPointCloud>(*parsed);
    std::visit([&](const auto& read) { evidence.Add(*stream, message->time, read); }, *parsed);
    const bool long_enough = message->time > *begin + kLongestLook;
    if (!evidence.SilentScanner() && (long_enough || evidence.IsEnough())) break;
  }
  if (!has_scans) {
    throw InputError(
        path + ": holds no scan that can be read" +
        (malformed_scans > 0 ? ": all " + std::to_string(malformed_scans) + " are malformed" : "") +
        fault + DamageOf(*bag));
  }
  if (const std::optional<std::size_t> silent = evidence.SilentScanner()) {
    throw InputError(path + ": log.scan_topic: `" + topics.topics[*silent].name +
                     "` holds no scan that can be read");
  }
  const std::string missing = evidence.MissingOdometryFrame();
  if (!missing.empty()) throw InputError(path + ": " + missing);
  return evidence.Conclude();
}

}  // namespace masked_mapper
