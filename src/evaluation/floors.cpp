// SPDX-License-Identifier: BSD-3-Clause
#include "floors.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace masked_mapper {
namespace {

using LabelPair = std::pair<std::string, std::string>;  ///< the map's, the true one
using Agreement = std::map<LabelPair, std::size_t>;     ///< scans of each pair

Agreement CountPairs(const std::vector<StampedPose>& trajectory,
                     const std::vector<MappedFloor>& floors, const std::vector<FloorLabel>& truth) {
  Agreement scans_of;
  for (const StampedPose& pose : trajectory) {
    const auto after =
        std::upper_bound(truth.begin(), truth.end(), pose.stamp,
                         [](double stamp, const FloorLabel& floor) { return stamp < floor.stamp; });
    if (after == truth.begin() || std::prev(after)->label == "-") continue;
    ++scans_of[{floors[NearestFloor(floors, pose.z)].label, std::prev(after)->label}];
  }
  return scans_of;
}

}  // namespace

std::optional<FloorIdentity> CompareFloors(const std::vector<StampedPose>& trajectory,
                                           const std::vector<MappedFloor>& floors,
                                           const std::vector<FloorLabel>& truth) {
  if (floors.empty()) return std::nullopt;
  const Agreement scans_of = CountPairs(trajectory, floors, truth);
  if (scans_of.empty()) return std::nullopt;
  FloorIdentity identity;
  std::vector<std::pair<LabelPair, std::size_t>> ranked(scans_of.begin(), scans_of.end());
  for (const auto& [labels, scans] : ranked) {
    identity.scans += scans;
    if (labels.first == labels.second) identity.same_label += scans;
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    const auto rank = [](const auto& entry) {
      return std::make_tuple(entry.second, entry.first.first == entry.first.second);
    };
    return rank(a) > rank(b);
  });
  std::set<std::string> taken;
  for (const auto& [labels, scans] : ranked) {
    if (identity.renaming.count(labels.first) || !taken.insert(labels.second).second) continue;
    identity.renaming.insert(labels);
    identity.right += scans;
  }
  return identity;
}

}  // namespace masked_mapper
