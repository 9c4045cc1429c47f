// SPDX-License-Identifier: BSD-3-Clause
// What the ranges of a scanner say of themselves, against what its messages claim of them: drivers
// are published that give millimetres for metres, or a least range beyond half of the room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ros_messages.hpp"

namespace masked_mapper {

struct ScannerRanges {
  double scale = 1.0;              ///< to metres
  bool believes_range_min = true;  ///< false: nearer ranges than the messages' least are right
};

/// Scans of one frame.
class ScannerEvidence {
 public:
  /// `least_range`: m, below which nothing is believed anyway.
  void Add(const RosLaserScan& scan, double least_range);

  /// Of a cloud nothing is known but that it has returns: its limits are nobody's claim.
  void AddCloud(std::size_t returns, double nearest) {
    ++scans_;
    nearest_of_clouds_ = std::min(nearest_of_clouds_, nearest);
    finite_ += returns;
    within_ += returns;
  }

  std::uint64_t scans() const { return scans_; }
  /// Whether any beam ever came back.
  bool HasReturns() const { return finite_ > 0; }
  ScannerRanges Find() const;
  /// Share of the ranges that lie within the limits which their messages state.
  double ShareWithinLimits() const;
  double range_min() const { return range_min_; }
  /// m, from the origin of the frame; infinite without a cloud.
  double nearest_of_clouds() const { return nearest_of_clouds_; }

 private:
  std::uint64_t scans_ = 0;
  std::uint64_t finite_ = 0;  ///< ranges that are a number above 0, as all below
  std::uint64_t within_ = 0;  ///< the limits of their message
  std::uint64_t near_ = 0;    ///< below range_min, and like their neighbour: a surface, no noise
  double range_min_ = 0.0;
  double nearest_of_clouds_ = std::numeric_limits<double>::infinity();
  std::uint64_t far_ = 0;       ///< farther away than the walls of any room
  std::vector<float> nearest_;  ///< per beam, of what is counted in near_
  std::vector<float> farthest_;
};

}  // namespace masked_mapper
