// SPDX-License-Identifier: BSD-3-Clause
#include "floor_labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "assumed_heights.hpp"
#include "masked_mapper/log/floor_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr char kInTransit[] = "-";

/// The robot was on a floor. Infinite ends: from before the log, past its end.
struct Stay {
  TimeSpan span;
  std::size_t level = 0;
};

struct Stays {
  std::vector<Stay> stays;
  std::vector<std::string> labels;  ///< of levels, in order of first visit
};

/// What the labels say and nothing else: stays in order; where one ends before the next begins, the
/// labels say that the robot was in transit.
Stays StaysOf(const std::vector<FloorLabel>& labels) {
  Stays result;
  std::map<std::string, std::size_t> level_of_label;
  bool is_open = false;
  for (const FloorLabel& label : labels) {
    if (is_open) result.stays.back().span.end = label.stamp;
    if (label.label == kInTransit) {
      is_open = false;
      continue;
    }
    const auto [entry, is_new] = level_of_label.emplace(label.label, level_of_label.size());
    if (is_new) result.labels.push_back(label.label);
    const double start =
        labels.front().stamp == label.stamp && result.stays.empty() ? -kInfinity : label.stamp;
    if (is_open && result.stays.back().level == entry->second) {
      result.stays.back().span.end = kInfinity;  // said again
    } else {
      result.stays.push_back({{start, kInfinity}, entry->second});
    }
    is_open = true;
  }
  return result;
}

double Distance(const FloorTransit& transit, const TimeSpan& change) {
  return std::max({0.0, change.start - transit.end, transit.start - change.end});
}

/// From one stay to the next, with what a sensor found there.
struct Change {
  TimeSpan span;  ///< in which the robot was in transit, or the moment of the label
  std::vector<FloorTransit> transits;

  /// Empty when no sensor measured it.
  std::optional<double> Climb() const {
    double climb = 0.0;
    for (const FloorTransit& transit : transits) {
      if (!transit.climb) return std::nullopt;
      climb += *transit.climb;
    }
    return transits.empty() ? std::nullopt : std::optional<double>(climb);
  }
  double ClimbSigma() const {
    double variance = 0.0;
    for (const FloorTransit& transit : transits) {
      variance += transit.climb_sigma * transit.climb_sigma;
    }
    return std::sqrt(variance);
  }
};

/// Where labels and sensor do not go together.
struct Contradictions {
  std::size_t count = 0;
  double first = kInfinity;  ///< s

  void Add(double stamp) {
    ++count;
    if (std::isfinite(stamp)) first = std::min(first, stamp);
  }
};

/// Each transit goes to the change of labels nearest in time.
std::vector<Change> ChangesOf(const std::vector<Stay>& stays,
                              const std::vector<FloorTransit>& transits,
                              const FloorLabelOptions& options, const StoreyOptions& storeys,
                              Contradictions& contradictions) {
  std::vector<Change> changes;
  for (std::size_t k = 0; k + 1 < stays.size(); ++k) {
    changes.push_back({{stays[k].span.end, stays[k + 1].span.start}, {}});
  }
  for (const FloorTransit& transit : transits) {
    // Changes are in order of time: the nearest is the first that ends after the transit's start,
    // or the one before or behind that.
    const auto later = std::lower_bound(
        changes.begin(), changes.end(), transit.start,
        [](const Change& change, double start) { return change.span.end < start; });
    auto nearest = changes.end();
    for (auto it = later == changes.begin() ? later : later - 1;
         it != changes.end() && it - later <= 1; ++it) {
      if (nearest == changes.end() ||
          Distance(transit, it->span) < Distance(transit, nearest->span)) {
        nearest = it;
      }
    }
    if (nearest != changes.end() && Distance(transit, nearest->span) <= options.late_s) {
      nearest->transits.push_back(transit);
    } else if (!transit.climb || std::abs(*transit.climb) >= LeastClimb(storeys)) {
      contradictions.Add(transit.start);
    }
  }
  return changes;
}

/// Elevations from the steps that the others do not contradict by half a storey. Round by round
/// the worst go, and those nearly as bad.
std::vector<LevelHeight> HeightsOfTrusted(std::size_t level_count, std::vector<LevelStep> steps,
                                          const StoreyOptions& storeys,
                                          Contradictions& contradictions) {
  for (;;) {
    std::vector<LevelHeight> heights = EstimateLevelHeights(level_count, steps);
    const auto error = [&](const LevelStep& step) {
      return std::abs(heights[step.to].elevation - heights[step.from].elevation - step.climb);
    };
    double worst = 0.0;
    for (const LevelStep& step : steps) worst = std::max(worst, error(step));
    if (worst <= 0.5 * storeys.min_gap) return heights;
    const auto bad = std::remove_if(steps.begin(), steps.end(), [&](const LevelStep& step) {
      return error(step) > std::max(0.5 * storeys.min_gap, 0.8 * worst);
    });
    for (auto it = bad; it != steps.end(); ++it) contradictions.Add(kInfinity);
    steps.erase(bad, steps.end());
  }
}

std::vector<FloorLevel> LevelsOf(const Stays& said, const std::vector<Change>& changes,
                                 bool has_sensor, const StoreyOptions& storeys,
                                 Contradictions& contradictions) {
  std::vector<LevelStep> steps;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const std::optional<double> climb = changes[k].Climb();
    const std::size_t from = said.stays[k].level;
    const std::size_t to = said.stays[k + 1].level;
    const bool same_height = std::abs(climb.value_or(0.0)) < LeastClimb(storeys);
    const bool is_seen = climb || (has_sensor && changes[k].transits.empty());
    if (is_seen && (from == to) != same_height) contradictions.Add(changes[k].span.start);
    if (climb && from != to && !same_height) {
      steps.push_back({from, to, *climb, std::max(changes[k].ClimbSigma(), 1e-3)});
    }
  }
  const std::vector<LevelHeight> heights =
      HeightsOfTrusted(said.labels.size(), steps, storeys, contradictions);
  std::vector<FloorLevel> levels;
  for (std::size_t i = 0; i < said.labels.size(); ++i) {
    FloorLevel level;
    level.label = said.labels[i];
    level.elevation = heights[i].elevation;
    level.elevation_sigma = heights[i].sigma;
    level.elevation_measured = heights[i].measured;
    levels.push_back(level);
  }
  levels = WithAssumedHeights(std::move(levels), storeys);
  // With nothing measured at all, the first level's zero is no measurement either.
  if (steps.empty()) levels.front().elevation_measured = false;
  return levels;
}

/// When the robot was in transit at a change for which no label says so: as the sensor found it, or
/// while the wheels rest around the label. Between `earliest` and `latest`, where other floors are.
TimeSpan UnsaidTransit(const Change& change, double earliest, double latest,
                       const WheelTrack& track, const FloorLabelOptions& options) {
  TimeSpan span = change.span;
  if (!change.transits.empty()) {
    span = {change.transits.front().start, change.transits.back().end};
  } else if (track.Travels()) {
    const TimeSpan rest = track.StayAround(change.span.start, options.cab_radius);
    if (rest.Duration() >= options.least_stay_s) span = rest;
  }
  span = {std::max(span.start, earliest), std::min(span.end, latest)};
  return span.end > span.start ? span : change.span;
}

std::vector<FloorInterval> IntervalsOf(const std::vector<Stay>& stays,
                                       const std::vector<Change>& changes, const WheelTrack& track,
                                       const FloorLabelOptions& options) {
  std::vector<FloorInterval> intervals;
  double start = stays.front().span.start;
  if (start > -kInfinity) intervals.push_back({-kInfinity, 0, true});
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const std::size_t left = stays[k].level;
    const std::size_t reached = stays[k + 1].level;
    intervals.push_back({start, left, false});
    const Change& change = changes[k];
    TimeSpan span = change.span;
    if (span.Duration() <= 0.0) {
      span = UnsaidTransit(change, start, stays[k + 1].span.end, track, options);
    }
    start = span.end;
    if (span.Duration() <= 0.0) continue;
    FloorSources by;
    by.Add(FloorSource::kLabels);
    for (const FloorTransit& transit : change.transits) by.Add(transit.by);
    const FloorInterval on_the_way{span.start,         left, true, 0.0, by, change.Climb(),
                                   change.ClimbSigma()};
    intervals.push_back(on_the_way);
    if (left == reached) continue;
    double middle = 0.5 * (span.start + span.end);
    if (!change.transits.empty()) {
      middle = 0.5 * (change.transits.front().middle + change.transits.back().middle);
      middle = std::clamp(middle, span.start, span.end);
    }
    intervals.push_back(on_the_way);
    intervals.back().start = middle;
    intervals.back().level = reached;
  }
  intervals.push_back({start, stays.back().level, false});
  if (stays.back().span.end < kInfinity) {
    intervals.push_back({stays.back().span.end, stays.back().level, true});
  }
  return intervals;
}

std::string At(double stamp) { return FixedText(stamp, 3) + " s"; }

}  // namespace

void CheckFloorLabel(const FloorLabel& label) {
  if (IsFloorLabel(label.label)) return;
  throw InputError("floor label '" + label.label.substr(0, 64) + "' at " + At(label.stamp) +
                   ": labels become file names and are up to 64 of A-Z a-z 0-9 _ . -");
}

LabelledTimeline TimelineOfLabels(const std::vector<FloorLabel>& labels,
                                  const std::vector<FloorTransit>& transits,
                                  const std::string& sensor, const WheelTrack& track,
                                  const FloorLabelOptions& options, const StoreyOptions& storeys) {
  constexpr std::size_t kMostFloors = 500;
  const Stays said = StaysOf(labels);
  if (said.labels.size() > kMostFloors) {
    throw InputError("more than " + std::to_string(kMostFloors) + " different floor labels");
  }
  Contradictions contradictions;
  const std::vector<Change> changes =
      ChangesOf(said.stays, transits, options, storeys, contradictions);
  LabelledTimeline result;
  result.timeline.levels = LevelsOf(said, changes, !sensor.empty(), storeys, contradictions);
  result.timeline.intervals = IntervalsOf(said.stays, changes, track, options);
  if (contradictions.count > 0) {
    std::string line = "floor labels and " + sensor + " contradict each other " +
                       std::to_string(contradictions.count) +
                       (contradictions.count == 1 ? " time" : " times");
    if (std::isfinite(contradictions.first)) {
      line += " (first at " + At(contradictions.first) + ")";
    }
    result.warnings.push_back(line + ": the labels are believed");
  }
  return result;
}

}  // namespace masked_mapper
