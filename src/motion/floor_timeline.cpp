// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace masked_mapper {

const FloorInterval& FloorTimeline::At(double stamp) const {
  const auto after = std::upper_bound(
      intervals.begin() + 1, intervals.end(), stamp,
      [](double value, const FloorInterval& interval) { return value < interval.start; });
  return *(after - 1);
}

void NoteTravel(const std::vector<TravelledWay>& way, FloorTimeline& timeline) {
  const auto travelled_by = [&](double stamp) {
    const auto after = std::upper_bound(
        way.begin(), way.end(), stamp,
        [](double value, const TravelledWay& point) { return value < point.stamp; });
    return after == way.begin() ? 0.0 : (after - 1)->travelled_m;
  };
  std::vector<FloorInterval>& intervals = timeline.intervals;
  for (std::size_t first = 0; first < intervals.size(); ++first) {
    if (!intervals[first].in_transit) continue;
    std::size_t end = first + 1;
    while (end < intervals.size() && intervals[end].in_transit) ++end;
    const double last_stamp =
        end < intervals.size() ? intervals[end].start : std::numeric_limits<double>::infinity();
    const double travelled_m = travelled_by(last_stamp) - travelled_by(intervals[first].start);
    for (; first < end; ++first) intervals[first].travelled_m = travelled_m;
  }
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
