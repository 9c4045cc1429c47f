// SPDX-License-Identifier: BSD-3-Clause
#include "clock_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::size_t kMostSamples = 4000;
constexpr double kMost = 0.5;             // share of headers that settle a clock
constexpr std::size_t kFewestWhole = 20;  // headers
constexpr double kLeastRate = 1.5;        // Hz; slower topics may well be stamped on the second
constexpr double kLatestOfWholeSeconds = 0.99;  // quantile: of a floored clock, the truth is above

}  // namespace

void ClockEvidence::Add(double header, double recorded) {
  if (!(header > 0.0)) return;
  first_ = seen_ == 0 ? header : std::min(first_, header);
  last_ = seen_ == 0 ? header : std::max(last_, header);
  whole_ += header == std::floor(header) ? 1 : 0;
  if (seen_++ % stride_ != 0) return;
  samples_.push_back({recorded, header - recorded});
  if (samples_.size() < kMostSamples) return;
  for (std::size_t i = 0; 2 * i < samples_.size(); ++i) samples_[i] = samples_[2 * i];
  samples_.resize((samples_.size() + 1) / 2);
  stride_ *= 2;
}

double ClockEvidence::Quantile(double share) const {
  std::vector<double> offsets;
  offsets.reserve(samples_.size());
  for (const Sample& sample : samples_) offsets.push_back(sample.offset);
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(offsets.size() - 1));
  std::nth_element(offsets.begin(), offsets.begin() + at, offsets.end());
  return offsets[static_cast<std::size_t>(at)];
}

TopicClock ClockEvidence::Find() const {
  TopicClock clock;
  if (samples_.empty()) return clock;
  clock.whole_seconds = whole_ == seen_ && seen_ >= kFewestWhole &&
                        static_cast<double>(seen_) > kLeastRate * (last_ - first_ + 1.0);
  clock.offset = Quantile(clock.whole_seconds ? kLatestOfWholeSeconds : 0.5);
  clock.is_steady = FindStrays(clock).share < 1.0 - kMost;
  return clock;
}

ClockEvidence::Strays ClockEvidence::FindStrays(const TopicClock& clock) const {
  Strays strays;
  double count = 0.0;
  for (const Sample& sample : samples_) {
    if (std::abs(sample.offset - clock.offset.value_or(0.0)) <= kStray) continue;
    strays.first = count == 0.0 ? sample.recorded : std::min(strays.first, sample.recorded);
    strays.last = count == 0.0 ? sample.recorded : std::max(strays.last, sample.recorded);
    ++count;
  }
  if (!samples_.empty()) strays.share = count / static_cast<double>(samples_.size());
  return strays;
}

}  // namespace masked_mapper
