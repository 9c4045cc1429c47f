// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/doubt/doubt.hpp"
#include "piece_search.hpp"

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

/// Which levels may be one, from all that is known of them so far.
class Identities {
 public:
  Identities(const FloorTimeline& floors, const StoreyOptions& storeys)
      : changes_(ChangesOf(floors)), storeys_(storeys) {
    for (std::size_t level = 0; level < floors.levels.size(); ++level) is_level_.push_back(level);
    Settle();
  }

  const std::vector<std::size_t>& is_level() const { return is_level_; }
  bool IsKnown(std::size_t level) const { return heights_[is_level_[level]].measured; }

  /// Not those that the robot went to or from without a stop, nor those at a measured height.
  bool AreApart(std::size_t older, std::size_t newer) const {
    const std::size_t one = is_level_[older];
    const std::size_t other = is_level_[newer];
    return heights_[one].root == heights_[other].root ||
           std::any_of(changes_.begin(), changes_.end(), [&](const FloorChange& change) {
             const auto ends = std::minmax(is_level_[change.from], is_level_[change.to]);
             return change.from != change.to && ends == std::minmax(one, other);
           });
  }

  /// Of the older levels, one at least may be it.
  bool MayBeOlder(std::size_t level) const {
    for (std::size_t older = 0; older < level; ++older) {
      if (!AreApart(older, level)) return true;
    }
    return false;
  }

  /// With all that follows from their heights.
  void Join(std::size_t older, std::size_t newer) {
    Replace(is_level_[newer], is_level_[older]);
    Settle();
  }

 private:
  void Replace(std::size_t gone, std::size_t by) {
    std::replace(is_level_.begin(), is_level_.end(), std::max(gone, by), std::min(gone, by));
  }

  void Settle() {
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<LevelStep> steps;
      for (const FloorChange& change : changes_) {
        const std::size_t from = is_level_[change.from];
        const std::size_t to = is_level_[change.to];
        if (!change.climb || from == to) continue;
        steps.push_back({from, to, *change.climb, std::max(change.climb_sigma, kLeastSigma)});
      }
      heights_ = EstimateLevelHeights(is_level_.size(), steps);
      for (std::size_t b = 1; b < heights_.size() && !changed; ++b) {
        for (std::size_t a = 0; a < b && is_level_[b] == b && !changed; ++a) {
          if (is_level_[a] != a || heights_[a].root != heights_[b].root ||
              std::abs(heights_[a].elevation - heights_[b].elevation) > 0.5 * storeys_.min_gap) {
            continue;
          }
          Replace(b, a);
          changed = true;
        }
      }
    }
  }

  static constexpr double kLeastSigma = 1e-3;  // m

  std::vector<FloorChange> changes_;
  StoreyOptions storeys_;
  std::vector<std::size_t> is_level_;  ///< the first level that each is
  std::vector<LevelHeight> heights_;
};

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
FloorTimeline Merged(const FloorTimeline& floors, const std::vector<std::size_t>& is_level,
                     const StoreyOptions& storeys) {
  FloorTimeline merged;
  merged.levels.clear();
  std::vector<std::size_t> place(floors.levels.size());
  for (std::size_t level = 0; level < floors.levels.size(); ++level) {
    if (is_level[level] != level) continue;
    place[level] = merged.levels.size();
    merged.levels.push_back(floors.levels[level]);
  }
  merged.intervals = floors.intervals;
  merged.heard = floors.heard;
  for (FloorInterval& interval : merged.intervals) {
    interval.level = place[is_level[interval.level]];
  }
  SettleElevations(storeys, merged);
  for (FloorLevel& level : merged.levels) {
    if (level.identity_known) level.open.clear();  // another tied it
    level.identity_known = true;
  }
  return merged;
}

class Joiner {
 public:
  Joiner(const BuildingMap& map, const FloorTimeline& floors, const FloorJoinOptions& options,
         const StoreyOptions& storeys, const MatcherOptions& matcher)
      : map_(map),
        floors_(floors),
        options_(options),
        storeys_(storeys),
        matcher_(matcher),
        names_(FloorNames(floors.levels)) {}

  struct Outcome {
    FloorJoining joining;
    /// Levels that were joined with one that has a twin besides: another floor, for all that is
    /// known, that is as like it. What fits such a floor need not be it.
    std::vector<bool> twins;
  };

  /// Where no level is joined with those that have a twin.
  Outcome Join(const std::vector<bool>& has_twin) const {
    Identities identities(floors_, storeys_);
    FloorTimeline told = floors_;
    FloorJoining joining;
    std::vector<bool> twins = has_twin;
    std::vector<bool> was_joined(has_twin.size(), false);
    std::vector<bool> is_like_another(has_twin.size(), false);
    for (std::size_t level = 0; level < floors_.levels.size(); ++level) {
      if (identities.IsKnown(level) || !identities.MayBeOlder(level)) continue;
      const PieceSearchResult found =
          FindPiece(map_, QuestionOf(map_, level, identities.is_level(), options_.ride),
                    options_.places, matcher_);
      const std::vector<PiecePlacement> ways = ThoseThatWallsAllow(found.ways, level);
      for (const PiecePlacement& way : ways) {
        const std::size_t older = OlderLevel(way);
        if (identities.AreApart(older, level)) is_like_another[older] = true;
      }
      std::string reason = found.reason;
      if (ways.empty() && !found.ways.empty()) {
        reason = "it looks like another, but leads through walls of that one";
      }
      if (ways.size() == 1) {
        const std::size_t older = OlderLevel(ways.front());
        if (identities.AreApart(older, level)) {
          reason =
              "it looks like floor " + names_[older] + ", which it is not, for all that is known";
        } else if (has_twin[older]) {
          reason = "it looks like floor " + names_[older] + ", and so does another that is not it";
        } else {
          identities.Join(older, level);
          was_joined[identities.is_level()[older]] = true;
          joining.any_joined = true;
          joining.notes.push_back("floor " + names_[older] +
                                  " was met again: " + std::to_string(ways.front().fitting) +
                                  " of " + std::to_string(ways.front().within) +
                                  " places fit it, and no sensor tells floors apart");
          continue;
        }
      }
      told.levels[level].open = "no sensor tells, and " + reason;
    }
    for (std::size_t level = 0; level < twins.size(); ++level) {
      const std::size_t is = identities.is_level()[level];
      if (is_like_another[level] && was_joined[is]) twins[is] = true;
    }
    joining.floors = Merged(told, identities.is_level(), storeys_);
    joining.floors.joined = floors_.joined || joining.any_joined;
    return {std::move(joining), std::move(twins)};
  }

 private:
  static std::size_t OlderLevel(const PiecePlacement& way) {
    return static_cast<std::size_t>(way.older_floor_of.begin()->second);
  }

  /// Those that lead through no walls, and those that are no worse by more than may be a door.
  std::vector<PiecePlacement> ThoseThatWallsAllow(const std::vector<PiecePlacement>& ways,
                                                  std::size_t level) const {
    constexpr std::size_t kDoors = 1;
    std::vector<std::size_t> walls;
    for (const PiecePlacement& way : ways) {
      walls.push_back(WallsDrivenThrough(map_, way.older_floor_of.begin()->second,
                                         static_cast<FloorId>(level), way.T_older_newer));
    }
    std::vector<PiecePlacement> allowed;
    if (ways.empty()) return allowed;
    const std::size_t fewest = *std::min_element(walls.begin(), walls.end());
    if (fewest > kDoors) return allowed;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (walls[i] <= fewest + kDoors) allowed.push_back(ways[i]);
    }
    return allowed;
  }

  const BuildingMap& map_;
  const FloorTimeline& floors_;
  const FloorJoinOptions& options_;
  const StoreyOptions& storeys_;
  const MatcherOptions& matcher_;
  std::vector<std::string> names_;
};

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
                        const FloorJoinOptions& options, const StoreyOptions& storeys,
                        const MatcherOptions& matcher) {
  const Joiner joiner(map, floors, options, storeys, matcher);
  std::vector<bool> has_twin(floors.levels.size(), false);
  while (true) {
    Joiner::Outcome outcome = joiner.Join(has_twin);
    if (outcome.twins == has_twin) return std::move(outcome.joining);
    has_twin = std::move(outcome.twins);
  }
}

}  // namespace masked_mapper
