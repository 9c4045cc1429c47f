// SPDX-License-Identifier: BSD-3-Clause
#include "stamp_mender.hpp"

#include <algorithm>
#include <utility>

namespace masked_mapper {
namespace {

// All in seconds. The public logs have scans up to 0.5 s late, and pauses of minutes.
constexpr double kLatest = 5.0;
constexpr double kLongestPause = 60.0;
constexpr double kHeldStep = 1.0;
constexpr double kWrap = 4294.967296;  // 2^32 us
// That many observations in a row must agree before a clock is believed to have been set.
constexpr std::size_t kWitnesses = 3;
// Bounds the memory when stamps do not advance.
constexpr std::size_t kMostHeldBack = 4096;

void SetStamp(Observation* observation, double stamp) {
  std::visit([stamp](auto& reading) { reading.stamp = stamp; }, *observation);
}

bool IsLater(double stamp_a, std::uint64_t sequence_a, double stamp_b, std::uint64_t sequence_b) {
  return stamp_a > stamp_b || (stamp_a == stamp_b && sequence_a > sequence_b);
}

constexpr auto kLaterOnTopLast = [](const auto& a, const auto& b) {
  return IsLater(a.stamp, a.sequence, b.stamp, b.sequence);
};

}  // namespace

double StampMender::NewestOf(std::size_t stream) const {
  const auto known = newest_of_stream_.find(stream);
  return known == newest_of_stream_.end() ? -std::numeric_limits<double>::infinity()
                                          : known->second;
}

bool StampMender::FitsAfter(double stamp, std::size_t stream) const {
  return stamp >= newest_ - kLatest && stamp <= newest_ + kLongestPause &&
         stamp >= NewestOf(stream) - kHeldStep;
}

bool StampMender::TryWrap(double raw_stamp, std::size_t stream) {
  if (!FitsAfter(raw_stamp + offset_ + kWrap, stream)) return false;
  offset_before_ = offset_;
  offset_ += kWrap;
  ++jumps_;
  return true;
}

bool StampMender::ConfirmsNewClock(double raw_stamp) const {
  if (undecided_.empty()) return false;
  const double step = raw_stamp - Stamp(undecided_.back().observation);
  return step >= -kLatest && step <= kLongestPause;
}

void StampMender::Add(Observation observation, std::size_t stream) {
  const double raw_stamp = Stamp(observation);
  if (!has_stamp_) {
    has_stamp_ = true;
    newest_ = raw_stamp;
    Accept(std::move(observation), stream, raw_stamp);
  } else if (FitsAfter(raw_stamp + offset_, stream)) {
    HoldUndecided();
    Accept(std::move(observation), stream, raw_stamp + offset_);
  } else if (FitsAfter(raw_stamp + offset_before_, stream)) {
    HoldUndecided();
    Accept(std::move(observation), stream, raw_stamp + offset_before_);
  } else if (TryWrap(raw_stamp, stream)) {
    HoldUndecided();
    Accept(std::move(observation), stream, raw_stamp + offset_);
  } else {
    if (!ConfirmsNewClock(raw_stamp)) HoldUndecided();
    undecided_.push_back({stream, std::move(observation)});
    if (undecided_.size() >= kWitnesses) AdoptNewClock();
  }
}

void StampMender::Accept(Observation observation, std::size_t stream, double stamp) {
  if (stamp < NewestOf(stream)) {
    stamp = NewestOf(stream);
    ++jumps_;
  }
  if (stamp < newest_) ++reordered_;
  if (stamp > newest_) typical_step_ = std::min(stamp - newest_, kHeldStep);
  newest_of_stream_[stream] = stamp;
  newest_ = std::max(newest_, stamp);
  SetStamp(&observation, stamp);
  heap_.push_back({stamp, sequence_++, stream, std::move(observation)});
  std::push_heap(heap_.begin(), heap_.end(), kLaterOnTopLast);
}

void StampMender::Hold(Observation observation, std::size_t stream) {
  ++jumps_;
  const double stamp_of_stream = NewestOf(stream);
  const double stamp = stamp_of_stream >= newest_ - kLongestPause ? stamp_of_stream : newest_;
  Accept(std::move(observation), stream, stamp);
}

void StampMender::HoldUndecided() {
  for (Undecided& undecided : std::exchange(undecided_, {})) {
    Hold(std::move(undecided.observation), undecided.stream);
  }
}

void StampMender::AdoptNewClock() {
  std::vector<Undecided> witnesses = std::exchange(undecided_, {});
  double first = Stamp(witnesses.front().observation);
  for (const Undecided& witness : witnesses) first = std::min(first, Stamp(witness.observation));
  const double step = first + offset_ - newest_;
  if (step < 0.0) {
    ++jumps_;
    offset_before_ = offset_;
    offset_ = newest_ + typical_step_ - first;
  }
  if (step > 0.0 && sequence_ < kWitnesses) MoveAllTo(first + offset_);
  newest_ = first + offset_;
  for (Undecided& witness : witnesses) {
    const double stamp = Stamp(witness.observation) + offset_;
    Accept(std::move(witness.observation), witness.stream, stamp);
  }
}

/// The log began with a few stamps that nothing agrees with.
void StampMender::MoveAllTo(double stamp) {
  for (Queued& queued : heap_) {
    queued.stamp = stamp;
    SetStamp(&queued.observation, stamp);
    newest_of_stream_[queued.stream] = stamp;
    ++jumps_;
  }
  std::make_heap(heap_.begin(), heap_.end(), kLaterOnTopLast);
}

void StampMender::Finish() {
  HoldUndecided();
  finished_ = true;
}

std::optional<Observation> StampMender::Next() {
  if (heap_.empty()) return std::nullopt;
  const bool ready =
      finished_ || heap_.front().stamp <= newest_ - kLatest || heap_.size() > kMostHeldBack;
  if (!ready) return std::nullopt;
  std::pop_heap(heap_.begin(), heap_.end(), kLaterOnTopLast);
  Queued next = std::move(heap_.back());
  heap_.pop_back();
  last_stream_ = next.stream;
  // Only what came later than it may be is caught here.
  if (next.stamp < last_out_) SetStamp(&next.observation, last_out_);
  last_out_ = std::max(last_out_, next.stamp);
  return std::move(next.observation);
}

}  // namespace masked_mapper
