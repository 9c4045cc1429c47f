// SPDX-License-Identifier: BSD-3-Clause
// From changes of floor, each with the height that it climbed, to levels with elevations: a floor
// met again is the one it was, by the step from the level left, never by absolute heights.
#pragma once

#include <optional>
#include <vector>

#include "masked_mapper/motion/floor_options.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

/// The robot was between floors from `start` (minus infinity: from before the log) to `end` (plus
/// infinity: past the end of the log).
struct FloorTransit {
  double start = 0.0;           ///< s
  double middle = 0.0;          ///< s, when it was half-way; before `start` or after `end`: those
  double end = 0.0;             ///< s
  std::optional<double> climb;  ///< m up (negative: down); empty: nobody knows
  double climb_sigma = 0.0;     ///< m
  FloorSources by = {};         ///< the sensors that noticed it
};

/// A climb smaller than this leads to no other floor (ours: a fifth below the smallest gap, for the
/// errors of one measurement).
inline double LeastClimb(const StoreyOptions& options) { return 0.8 * options.min_gap; }

/// How much higher one level is than another, as measured.
struct LevelStep {
  std::size_t from = 0;
  std::size_t to = 0;
  double climb = 0.0;  ///< m
  double sigma = 0.0;  ///< m, positive
};

struct LevelHeight {
  double elevation = 0.0;  ///< m above level `root`
  double sigma = 0.0;      ///< m
  std::size_t root = 0;    ///< the first level that steps lead here from
  bool measured = false;   ///< steps lead here from level 0
};

/// Elevations of `level_count` levels from all steps at once, by least squares.
std::vector<LevelHeight> EstimateLevelHeights(std::size_t level_count,
                                              const std::vector<LevelStep>& steps);

/// Elevations of a timeline's levels from the climbs of its intervals. Levels that no climb ties to
/// the first are laid above the others, at the heights that they were measured to have among
/// themselves, and which floors they are is not known.
void SettleElevations(const StoreyOptions& options, FloorTimeline& timeline);

/// `all`: transits in order, not overlapping.
FloorTimeline TimelineOfTransits(const std::vector<FloorTransit>& all,
                                 const StoreyOptions& options);

}  // namespace masked_mapper
