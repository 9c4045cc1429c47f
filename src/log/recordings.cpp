// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_source.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "masked_mapper/log/live_log.hpp"
#include "open_bag.hpp"

namespace masked_mapper {
namespace {

// A recorder that goes on with the next file misses next to nothing; one that is started again, by
// hand, takes longer.
constexpr double kLongestGap = 3.0;  // s
constexpr double kOverlap = 1.0;     // s, of messages that arrived while the file was changed

struct Span {
  std::size_t place = 0;  ///< among the files given
  double begin = 0.0;     ///< s, of recording
  double end = 0.0;
  std::set<std::string> topics;
};

/// Topics that speak all the time: what is said but once is in the first part alone.
std::set<std::string> TopicsOf(const RosBag& bag) {
  std::set<std::string> topics;
  for (const auto& [id, connection] : bag.Connections()) {
    if (connection.type.find("LaserScan") != std::string::npos) topics.insert(connection.topic);
  }
  return topics;
}

std::optional<Span> SpanOf(const std::string& file, std::size_t place) {
  if (Spool::IsStream(file) || !IsBag(file)) return std::nullopt;
  const std::unique_ptr<RosBag> bag = OpenBag(file);
  const std::optional<BagMessage> first = bag->Next();
  if (!first) return std::nullopt;
  Span span{place, first->time, first->time, {}};
  if (const std::optional<double> end = bag->EndTime()) {
    span.end = *end;
  } else {
    while (const std::optional<BagMessage> message = bag->Next()) {
      span.end = std::max(span.end, message->time);
    }
  }
  span.topics = TopicsOf(*bag);
  return span;
}

bool GoesOn(const Span& before, const Span& after) {
  return before.topics == after.topics && after.begin > before.begin &&
         after.begin >= before.end - kOverlap && after.begin <= before.end + kLongestGap;
}

}  // namespace

std::vector<std::vector<std::string>> RecordingsOf(const std::vector<std::string>& files) {
  std::vector<std::vector<std::string>> recordings;
  if (files.size() < 2) {
    for (const std::string& file : files) recordings.push_back({file});
    return recordings;
  }
  std::vector<Span> spans;
  std::vector<std::vector<std::size_t>> chains;  ///< places of the files
  for (std::size_t place = 0; place < files.size(); ++place) {
    if (std::optional<Span> span = SpanOf(files[place], place)) {
      spans.push_back(std::move(*span));
    } else {
      chains.push_back({place});
    }
  }
  std::stable_sort(spans.begin(), spans.end(),
                   [](const Span& a, const Span& b) { return a.begin < b.begin; });
  std::vector<std::pair<Span, std::vector<std::size_t>>> open;
  for (const Span& span : spans) {
    const auto before = std::find_if(
        open.begin(), open.end(), [&span](const auto& chain) { return GoesOn(chain.first, span); });
    if (before == open.end()) {
      open.push_back({span, {span.place}});
    } else {
      before->first = span;
      before->second.push_back(span.place);
    }
  }
  for (auto& [last, chain] : open) chains.push_back(std::move(chain));
  std::sort(chains.begin(), chains.end(), [](const auto& a, const auto& b) {
    return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
  });
  for (const std::vector<std::size_t>& chain : chains) {
    recordings.emplace_back();
    for (const std::size_t place : chain) recordings.back().push_back(files[place]);
  }
  return recordings;
}

std::unique_ptr<LogSource> OpenRecording(const std::vector<std::string>& files,
                                         const LogOptions& options) {
  if (files.size() == 1) return std::make_unique<LogSource>(files.front(), options);
  return std::make_unique<LogSource>(files, options);
}

}  // namespace masked_mapper
