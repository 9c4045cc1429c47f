// SPDX-License-Identifier: BSD-3-Clause
// When the robot was on which floor: what every floor source ends in, and what mapping asks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace masked_mapper {

struct FloorLevel {
  std::string label;                ///< as said by the log; empty: named by its place in elevation
  double elevation = 0.0;           ///< m above the first level of the log
  double elevation_sigma = 0.0;     ///< m
  bool elevation_measured = false;  ///< false: a typical storey height was assumed
};

/// From `start` to the next interval's start the robot is on `level`, or between levels.
struct FloorInterval {
  double start = 0.0;     ///< s; the first interval counts from the beginning of time
  std::size_t level = 0;  ///< in transit: the level left last
  bool in_transit = false;
};

struct FloorTimeline {
  std::vector<FloorLevel> levels = {FloorLevel{}};  ///< in order of first visit, never empty
  std::vector<FloorInterval> intervals = {FloorInterval{}};  ///< in order of start, never empty

  const FloorInterval& At(double stamp) const;
};

}  // namespace masked_mapper
