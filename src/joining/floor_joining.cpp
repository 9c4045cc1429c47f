// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace masked_mapper {
namespace {

/// Runs of items whose level is one of those asked for.
template <class Items, class LevelOf>
std::vector<IndexRange> RunsOf(const Items& items, const std::vector<bool>& is_asked,
                               LevelOf level_of) {
  std::vector<IndexRange> runs;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!is_asked[static_cast<std::size_t>(level_of(items[i]))]) continue;
    if (runs.empty() || runs.back().end != i) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

MapPart PartOn(const BuildingMap& map, const std::vector<bool>& levels) {
  return {RunsOf(map.graph.nodes(), levels, [](const Node& node) { return node.floor; }),
          RunsOf(map.trajectory, levels, [](const TrajectoryPose& pose) { return pose.floor; })};
}

// The level that the robot came from when it first reached `level`.
std::optional<std::size_t> ReachedFrom(const FloorTimeline& floors, std::size_t level) {
  for (std::size_t i = 1; i < floors.intervals.size(); ++i) {
    if (floors.intervals[i].level == level) return floors.intervals[i - 1].level;
  }
  return std::nullopt;
}

/// Of a level against all before it.
PieceQuestion QuestionOf(const BuildingMap& map, std::size_t level,
                         const std::vector<std::size_t>& is_level, PiecePrior ride) {
  std::vector<bool> is_older(map.graph.floors().size(), false);
  std::vector<bool> is_newer(map.graph.floors().size(), false);
  PieceQuestion question;
  for (std::size_t i = 0; i < is_older.size(); ++i) {
    is_older[i] = i < level;
    is_newer[i] = i == level;
    question.is_floor.push_back(static_cast<FloorId>(i < level ? is_level[i] : i));
  }
  question.older = PartOn(map, is_older);
  question.newer = PartOn(map, is_newer);
  if (!question.newer.nodes.empty()) {
    ride.T_world_anchor = map.graph.nodes()[question.newer.nodes.front().begin].T_world_robot;
  }
  question.prior = ride;
  return question;
}

// Levels that are another are taken out, and the rest count on without a gap.
FloorTimeline Merged(const FloorTimeline& floors, const std::vector<std::size_t>& is_level) {
  FloorTimeline merged;
  merged.levels.clear();
  std::vector<std::size_t> place(floors.levels.size());
  for (std::size_t level = 0; level < floors.levels.size(); ++level) {
    if (is_level[level] != level) continue;
    place[level] = merged.levels.size();
    merged.levels.push_back(floors.levels[level]);
    merged.levels.back().identity_known = true;
  }
  merged.intervals = floors.intervals;
  for (FloorInterval& interval : merged.intervals) {
    interval.level = place[is_level[interval.level]];
  }
  return merged;
}

}  // namespace

bool HasUnknownFloors(const FloorTimeline& floors) {
  return std::any_of(floors.levels.begin(), floors.levels.end(),
                     [](const FloorLevel& level) { return !level.identity_known; });
}

DriveJoinOptions FloorJoinOptions::PlacesOfOneDrive() {
  DriveJoinOptions places;
  places.place_spacing_m = 2.0;
  places.min_places = 3;
  places.min_share = 0.6;
  places.min_spread_m = 4.0;
  return places;
}

FloorJoining JoinFloors(const BuildingMap& map, const FloorTimeline& floors,
                        const FloorJoinOptions& options, const MatcherOptions& matcher) {
  const std::vector<std::string> names = FloorNames(floors.levels);
  std::vector<std::size_t> is_level;
  FloorJoining joining;
  FloorTimeline told = floors;
  for (std::size_t level = 0; level < floors.levels.size(); ++level) {
    is_level.push_back(level);
    const std::optional<std::size_t> from = ReachedFrom(floors, level);
    if (floors.levels[level].identity_known || !from) continue;
    const bool only_the_one_left =
        std::all_of(is_level.begin(), is_level.end() - 1,
                    [&](std::size_t older) { return older == is_level[*from]; });
    if (only_the_one_left) continue;
    const PieceSearchResult found =
        FindPiece(map, QuestionOf(map, level, is_level, options.ride), options.places, matcher);
    std::string reason = found.reason;
    if (found.placement) {
      const auto older = static_cast<std::size_t>(found.placement->older_floor_of.begin()->second);
      if (older != is_level[*from]) {
        is_level[level] = older;
        joining.any_joined = true;
        joining.notes.push_back("floor " + names[older] + " was met again: " + reason +
                                " it, and no sensor tells floors apart");
        continue;
      }
      reason = "it looks like floor " + names[older] + ", which was left for it";
    }
    told.levels[level].open = reason;
  }
  joining.floors = Merged(told, is_level);
  return joining;
}

}  // namespace masked_mapper
