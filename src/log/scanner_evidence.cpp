// SPDX-License-Identifier: BSD-3-Clause
#include "scanner_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

constexpr std::uint64_t kFirstScans = 50;  // all are looked at, then one of kStride
constexpr std::uint64_t kStride = 8;
// No room has half of its walls farther away than this, and no scanner sees as far.
constexpr float kNoMetres = 100.0F;
constexpr double kNearShare = 0.05;    // of all ranges
constexpr double kVaries = 0.3;        // m; what is part of the robot stays where it is
constexpr double kSameSurface = 0.05;  // m, and share of the range

}  // namespace

void ScannerEvidence::Add(const RosLaserScan& scan, double least_range) {
  if (scans_++ >= kFirstScans && scans_ % kStride != 0) return;
  range_min_ = std::max(range_min_, scan.range_min);
  const std::size_t beams = scan.ranges.size();
  if (nearest_.size() < beams) {
    nearest_.resize(beams, std::numeric_limits<float>::max());
    farthest_.resize(beams, 0.0F);
  }
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const float range = scan.ranges[beam];
    if (!std::isfinite(range) || !(range > 0.0F)) continue;
    ++finite_;
    far_ += range > kNoMetres ? 1 : 0;
    if (range >= scan.range_min && range < scan.range_max) ++within_;
    if (range >= scan.range_min || range < least_range) continue;
    const float next = scan.ranges[(beam + 1) % beams];
    if (!(std::abs(next - range) < kSameSurface * (1.0 + range))) continue;
    ++near_;
    nearest_[beam] = std::min(nearest_[beam], range);
    farthest_[beam] = std::max(farthest_[beam], range);
  }
}

double ScannerEvidence::ShareWithinLimits() const {
  return finite_ == 0 ? 1.0 : static_cast<double>(within_) / static_cast<double>(finite_);
}

ScannerRanges ScannerEvidence::Find() const {
  ScannerRanges ranges;
  if (finite_ == 0) return ranges;
  const auto all = static_cast<double>(finite_);
  constexpr double kMillimetre = 0.001;  // m
  if (2 * far_ > finite_) {
    ranges.scale = kMillimetre;
    return ranges;
  }
  std::size_t seen = 0;
  std::size_t varying = 0;
  for (std::size_t beam = 0; beam < nearest_.size(); ++beam) {
    if (farthest_[beam] == 0.0F) continue;
    ++seen;
    varying += farthest_[beam] - nearest_[beam] > kVaries ? 1 : 0;
  }
  ranges.believes_range_min =
      !(static_cast<double>(near_) > kNearShare * all && 2 * varying > seen);
  return ranges;
}

}  // namespace masked_mapper
