// SPDX-License-Identifier: BSD-3-Clause
#include "assumed_heights.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

namespace masked_mapper {
namespace {

/// A label that is a whole number, as floors in buildings are numbered.
std::optional<int> FloorNumber(const std::string& label) {
  int number = 0;
  const char* const end = label.data() + label.size();
  const auto [stop, error] = std::from_chars(label.data(), end, number);
  if (error != std::errc() || stop != end || std::abs(number) > 1000) return std::nullopt;
  return number;
}

}  // namespace

std::vector<FloorLevel> WithAssumedHeights(std::vector<FloorLevel> levels,
                                           const StoreyOptions& storeys) {
  double highest = 0.0;
  for (const FloorLevel& level : levels) highest = std::max(highest, level.elevation);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    FloorLevel& level = levels[i];
    if (level.elevation_measured) continue;
    level.elevation = highest + storeys.typical_height;
    level.elevation_sigma = storeys.typical_height;
    const std::optional<int> number = FloorNumber(level.label);
    int fewest = std::numeric_limits<int>::max();
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const bool has_height = k < i || levels[k].elevation_measured;
      const std::optional<int> other = FloorNumber(levels[k].label);
      if (!number || !other || !has_height || std::abs(*number - *other) >= fewest) continue;
      fewest = std::abs(*number - *other);
      level.elevation = levels[k].elevation + (*number - *other) * storeys.typical_height;
    }
    highest = std::max(highest, level.elevation);
  }
  return levels;
}

}  // namespace masked_mapper
