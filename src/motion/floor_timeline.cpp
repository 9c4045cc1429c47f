// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

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
    const double last_stamp = end < intervals.size() ? intervals[end].start : kInfinity;
    const double travelled_m = travelled_by(last_stamp) - travelled_by(intervals[first].start);
    for (; first < end; ++first) intervals[first].travelled_m = travelled_m;
  }
}

std::vector<FloorChange> ChangesOf(const FloorTimeline& timeline) {
  const std::vector<FloorInterval>& intervals = timeline.intervals;
  std::vector<FloorChange> changes;
  for (std::size_t first = 0; first < intervals.size(); ++first) {
    if (!intervals[first].in_transit) continue;
    FloorChange change;
    change.t_out = first == 0 ? -kInfinity : intervals[first].start;
    change.from = first == 0 ? intervals[first].level : intervals[first - 1].level;
    for (; first < intervals.size() && intervals[first].in_transit; ++first) {
      change.to = intervals[first].level;
      change.by.Add(intervals[first].by);
      change.climb = intervals[first].climb;
      change.climb_sigma = intervals[first].climb_sigma;
    }
    change.t_in = first < intervals.size() ? intervals[first].start : kInfinity;
    if (first < intervals.size()) change.to = intervals[first].level;
    if (change.from != change.to) {
      const FloorLevel& from = timeline.levels[change.from];
      const FloorLevel& to = timeline.levels[change.to];
      change.height_m = to.elevation - from.elevation;
      change.sigma_m = std::hypot(from.elevation_sigma, to.elevation_sigma);
      if (change.climb) change.sigma_m = std::min(change.sigma_m, change.climb_sigma);
    }
    changes.push_back(change);
  }
  return changes;
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
