// SPDX-License-Identifier: BSD-3-Clause
// What writer and reader of the saved map must agree on, beyond its tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

constexpr std::size_t kPosesPerRow = 1024;
/// stamp f64, floor i32, in_transit u8, node_before i32, T_odom_robot 3 f64, T_world_robot 3 f64
constexpr std::size_t kPoseBytes = 8 + 4 + 1 + 4 + 24 + 24;
constexpr std::size_t kCovarianceBytes = 9 * sizeof(double);

struct LogCount {
  const char* key;
  std::uint64_t LogStatistics::*field;
};
constexpr std::array<LogCount, 12> kLogCounts = {{
    {"lines", &LogStatistics::lines},
    {"scans", &LogStatistics::scans},
    {"odometry", &LogStatistics::odometry},
    {"pressure", &LogStatistics::pressure},
    {"acceleration", &LogStatistics::acceleration},
    {"floor_labels", &LogStatistics::floor_labels},
    {"bad_lines", &LogStatistics::bad_lines},
    {"invalid_ranges", &LogStatistics::invalid_ranges},
    {"empty_scans", &LogStatistics::empty_scans},
    {"stamp_jumps", &LogStatistics::stamp_jumps},
    {"reordered", &LogStatistics::reordered},
    {"trailing_bytes", &LogStatistics::trailing_bytes},
}};

struct LogMeasure {
  const char* key;
  double LogStatistics::*field;
};
constexpr std::array<LogMeasure, 3> kLogMeasures = {{
    {"max_range", &LogStatistics::max_range},
    {"first_stamp", &LogStatistics::first_stamp},
    {"last_stamp", &LogStatistics::last_stamp},
}};

}  // namespace masked_mapper
