// SPDX-License-Identifier: BSD-3-Clause
// When the robot was on which floor: what every floor source ends in, and what mapping asks.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

enum class FloorSource {
  kAuto,          ///< all that the log holds
  kLabels,        ///< FLOOR lines, or a file of labels
  kPressure,      ///< a barometer
  kAcceleration,  ///< an accelerometer: elevators only
  kLidar,         ///< the scans: elevators only, and never which floor
  kNone,          ///< one floor
};

constexpr std::array<const char*, 6> NamesOf(FloorSource /*any*/) {
  return {"auto", "labels", "pressure", "acceleration", "lidar", "none"};
}

/// Several of them, one bit each.
struct FloorSources {
  unsigned bits = 0;

  void Add(FloorSource source) { bits |= 1U << static_cast<unsigned>(source); }
  void Add(FloorSources others) { bits |= others.bits; }
  bool Has(FloorSource source) const { return (bits >> static_cast<unsigned>(source) & 1U) != 0; }
};

struct FloorLevel {
  std::string label;                ///< as said by the log; empty: see FloorNames()
  double elevation = 0.0;           ///< m above the first level of the log
  double elevation_sigma = 0.0;     ///< m
  bool elevation_measured = false;  ///< false: a typical storey height was assumed
  /// False: a change of floor was noticed, but not to which. The level may be one of the others,
  /// which only the map itself can tell.
  bool identity_known = true;
  std::string open;  ///< why the map could not tell either; empty: it could, or was not asked
};

/// From `start` to the next interval's start the robot is on `level`, or between levels.
struct FloorInterval {
  double start = 0.0;     ///< s; the first interval counts from the beginning of time
  std::size_t level = 0;  ///< in transit: the level left, from the middle on the one reached
  bool in_transit = false;
  /// By wheels, of the whole way between two floors (the same for each of its intervals): a cab
  /// goes nowhere, stairs do. Known to none of the sources; NoteTravel() fills it in.
  double travelled_m = 0.0;
  FloorSources by = {};  ///< in transit: what told it
  /// m up, of the whole transit, as sensors measured it; empty: none did.
  std::optional<double> climb = std::nullopt;
  double climb_sigma = 0.0;  ///< m
};

struct FloorTimeline {
  std::vector<FloorLevel> levels = {FloorLevel{}};  ///< in order of first visit, never empty
  std::vector<FloorInterval> intervals = {FloorInterval{}};  ///< in order of start, never empty
  /// In which labels or a sensor of heights were listening: no change goes unnoticed within one.
  std::vector<TimeSpan> heard = {};
  bool joined = false;  ///< whether a map has said that levels are one

  const FloorInterval& At(double stamp) const;
};

/// From one floor to another, or back to the same.
struct FloorChange {
  double t_out = 0.0;  ///< s; minus infinity: the log begins in it
  double t_in = 0.0;   ///< s; plus infinity: the log ends in it
  std::size_t from = 0;
  std::size_t to = 0;
  double height_m = 0.0;  ///< up, from the one floor to the other
  double sigma_m = 0.0;
  std::optional<double> climb;  ///< m up, as it was measured there and then
  double climb_sigma = 0.0;     ///< m
  FloorSources by;
};

/// In order.
std::vector<FloorChange> ChangesOf(const FloorTimeline& timeline);

/// The way of wheels up to a stamp.
struct TravelledWay {
  double stamp = 0.0;
  double travelled_m = 0.0;  ///< since the start of the log
};

/// Sets `travelled_m` of all intervals in transit; `way` in order of stamps.
void NoteTravel(const std::vector<TravelledWay>& way, FloorTimeline& timeline);

/// What each level is called: its label, else its place in the order of elevations, where the first
/// level is `0`. Names differ: an underscore is added where a label took the place already.
std::vector<std::string> FloorNames(const std::vector<FloorLevel>& levels);

// From changes of floor, each with the height that it climbed, to levels with elevations: a floor
// met again is the one it was, by the step from the level left, never by absolute heights.

struct StoreyOptions {
  double min_gap = 2.4;         ///< m between two floors at least
  double typical_height = 3.5;  ///< m between floors, where nothing measures it
};

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

/// The transits of a timeline whose levels no map has joined.
std::vector<FloorTransit> TransitsOf(const FloorTimeline& timeline);

}  // namespace masked_mapper
