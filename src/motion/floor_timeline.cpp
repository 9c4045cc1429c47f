// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace masked_mapper {

const FloorInterval& FloorTimeline::At(double stamp) const {
  const auto after = std::upper_bound(
      intervals.begin() + 1, intervals.end(), stamp,
      [](double value, const FloorInterval& interval) { return value < interval.start; });
  return *(after - 1);
}

std::vector<std::string> FloorNames(const std::vector<FloorLevel>& levels) {
  std::vector<std::size_t> by_elevation(levels.size());
  std::iota(by_elevation.begin(), by_elevation.end(), std::size_t{0});
  std::stable_sort(by_elevation.begin(), by_elevation.end(), [&](std::size_t a, std::size_t b) {
    return levels[a].elevation < levels[b].elevation;
  });
  const auto first = std::find(by_elevation.begin(), by_elevation.end(), std::size_t{0});
  std::set<std::string> taken;
  for (const FloorLevel& level : levels) taken.insert(level.label);
  std::vector<std::string> names(levels.size());
  for (auto it = by_elevation.begin(); it != by_elevation.end(); ++it) {
    std::string& name = names[*it];
    name = levels[*it].label;
    if (!name.empty()) continue;
    name = std::to_string(it - first);
    while (!taken.insert(name).second) name += '_';
  }
  return names;
}

}  // namespace masked_mapper
