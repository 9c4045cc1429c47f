// SPDX-License-Identifier: BSD-3-Clause
#include "unpadded_stamps.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::int64_t kPerSecond = 1000000;
// One fraction in ten begins with a zero: by chance so many have none with a probability of 3e-5.
constexpr std::uint64_t kFewestFractions = 100;
constexpr std::uint64_t kFewestStepsBack = 3;
constexpr std::uint64_t kStepsMendedPerLeft = 10;

}  // namespace

// Zeros at the end may belong to the number or may have filled it up, so that one fraction may mean
// up to six times. Lines stand in the order in which they were written: of the times that are not
// before the stream's last one, the nearest to the line before is it.
double UnpaddedStamps::Meant(double stamp, std::size_t stream) {
  const double whole = std::floor(stamp);
  std::int64_t fraction = std::llround((stamp - whole) * static_cast<double>(kPerSecond));
  const bool has_fraction = fraction > 0 && fraction < kPerSecond;
  if (has_fraction) {
    ++with_fraction_;
    padded_ += 10 * fraction < kPerSecond ? 1 : 0;
  }
  const auto newest = newest_.find(stream);
  const bool is_first = newest == newest_.end();
  double meant = stamp;
  bool fits = is_first || stamp >= newest->second.meant;
  while (has_fraction && fraction % 10 == 0) {
    fraction /= 10;
    const double other = whole + static_cast<double>(fraction) / static_cast<double>(kPerSecond);
    if (!is_first && other < newest->second.meant) break;
    if (std::abs(other - last_) < std::abs(meant - last_)) meant = other;
  }
  steps_back_as_meant_ += fits ? 0 : 1;
  steps_back_ += !is_first && stamp < newest->second.written ? 1 : 0;
  mended_ += meant != stamp ? 1 : 0;
  newest_[stream] = {stamp, meant};
  last_ = meant;
  return meant;
}

bool UnpaddedStamps::IsFound() const {
  return padded_ == 0 && with_fraction_ >= kFewestFractions && steps_back_ >= kFewestStepsBack &&
         kStepsMendedPerLeft * steps_back_as_meant_ <= steps_back_;
}

}  // namespace masked_mapper
