// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_labels.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "masked_mapper/log/carmen_line.hpp"
#include "masked_mapper/log/input_error.hpp"

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

/// What the sensor found at a change of labels.
struct Change {
  TimeSpan span;  ///< from the stay before to the stay after
  std::vector<FloorTransit> transits;
};

std::vector<Change> ChangesOf(const std::vector<Stay>& stays) {
  std::vector<Change> changes;
  for (std::size_t k = 0; k + 1 < stays.size(); ++k) {
    changes.push_back({{stays[k].span.end, stays[k + 1].span.start}, {}});
  }
  return changes;
}

/// A label that is a whole number, as floors in buildings are numbered.
std::optional<int> FloorNumber(const std::string& label) {
  int number = 0;
  const char* const end = label.data() + label.size();
  const auto [stop, error] = std::from_chars(label.data(), end, number);
  if (error != std::errc() || stop != end || std::abs(number) > 1000) return std::nullopt;
  return number;
}

/// Elevations where nothing measured them (ours): by the number on the label, from the nearest
/// numbered floor; floors without a number stand above all others.
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

/// Steps that all others contradict by half a storey, worst first, are taken out.
struct TrustedSteps {
  std::vector<LevelHeight> heights;
  std::size_t distrusted = 0;
};
TrustedSteps EstimateFromTrusted(std::size_t level_count, std::vector<LevelStep> steps,
                                 const StoreyOptions& storeys) {
  TrustedSteps result;
  for (;;) {
    result.heights = EstimateLevelHeights(level_count, steps);
    std::size_t worst = steps.size();
    double worst_error = 0.5 * storeys.min_gap;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const double error = std::abs(result.heights[steps[k].to].elevation -
                                    result.heights[steps[k].from].elevation - steps[k].climb);
      if (error <= worst_error) continue;
      worst_error = error;
      worst = k;
    }
    if (worst == steps.size()) return result;
    steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(worst));
    ++result.distrusted;
  }
}

std::string At(double stamp) {
  char text[48];
  std::snprintf(text, sizeof(text), "%.3f s", stamp);
  return text;
}

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
  const Stays said = StaysOf(labels);
  const std::vector<Stay>& stays = said.stays;
  std::vector<Change> changes = ChangesOf(stays);

  // Each transit goes to the change of labels nearest in time.
  std::vector<double> contradictions;
  for (const FloorTransit& transit : transits) {
    const auto nearest =
        std::min_element(changes.begin(), changes.end(), [&](const Change& a, const Change& b) {
          return Distance(transit, a.span) < Distance(transit, b.span);
        });
    if (nearest != changes.end() && Distance(transit, nearest->span) <= options.late_s) {
      nearest->transits.push_back(transit);
    } else if (!transit.climb || std::abs(*transit.climb) >= LeastClimb(storeys)) {
      contradictions.push_back(transit.start);
    }
  }

  // Heights.
  std::vector<LevelStep> steps;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    double climb = 0.0;
    double variance = 0.0;
    bool is_known = !changes[k].transits.empty();
    for (const FloorTransit& transit : changes[k].transits) {
      is_known &= transit.climb.has_value();
      climb += transit.climb.value_or(0.0);
      variance += transit.climb_sigma * transit.climb_sigma;
    }
    const bool same_level = stays[k].level == stays[k + 1].level;
    const bool same_height = std::abs(climb) < LeastClimb(storeys);
    if (!sensor.empty() && (is_known || changes[k].transits.empty()) && same_level != same_height) {
      contradictions.push_back(changes[k].span.start);
    }
    if (!is_known || same_level || same_height) continue;
    steps.push_back({stays[k].level, stays[k + 1].level, climb, std::sqrt(variance)});
  }
  const TrustedSteps trusted = EstimateFromTrusted(said.labels.size(), steps, storeys);

  LabelledTimeline result;
  FloorTimeline& timeline = result.timeline;
  timeline.levels.clear();
  for (std::size_t i = 0; i < said.labels.size(); ++i) {
    FloorLevel level;
    level.label = said.labels[i];
    level.elevation = trusted.heights[i].elevation;
    level.elevation_sigma = trusted.heights[i].sigma;
    level.elevation_measured = trusted.heights[i].measured;
    timeline.levels.push_back(level);
  }
  timeline.levels = WithAssumedHeights(std::move(timeline.levels), storeys);
  // With nothing measured at all, the first level's zero is no measurement either.
  if (steps.empty()) timeline.levels.front().elevation_measured = false;

  // Times.
  timeline.intervals.clear();
  if (stays.front().span.start > -kInfinity) timeline.intervals.push_back({-kInfinity, 0, true});
  for (std::size_t k = 0; k < stays.size(); ++k) {
    TimeSpan next = {stays[k].span.end, kInfinity};
    const double start = k == 0 ? stays[k].span.start : changes[k - 1].span.end;
    timeline.intervals.push_back({start, stays[k].level, false});
    if (k + 1 == stays.size()) {
      if (next.start < kInfinity) timeline.intervals.push_back({next.start, stays[k].level, true});
      break;
    }
    Change& change = changes[k];
    if (change.span.Duration() <= 0.0) {
      const double stamp = change.span.start;
      if (!change.transits.empty()) {
        change.span = {change.transits.front().start, change.transits.back().end};
      } else if (track.Travels()) {
        const TimeSpan rest = track.StayAround(stamp, options.cab_radius);
        if (rest.Duration() >= options.least_stay_s) change.span = rest;
      }
      // Never past the neighbouring changes of labels.
      change.span.start = std::max(change.span.start, start);
      change.span.end = std::min(change.span.end, stays[k + 1].span.end);
    }
    if (!(change.span.Duration() > 0.0)) continue;
    timeline.intervals.push_back({change.span.start, stays[k].level, true});
    if (stays[k].level == stays[k + 1].level) continue;
    double middle = 0.5 * (change.span.start + change.span.end);
    if (!change.transits.empty()) {
      middle = 0.5 * (change.transits.front().middle + change.transits.back().middle);
      middle = std::clamp(middle, change.span.start, change.span.end);
    }
    timeline.intervals.push_back({middle, stays[k + 1].level, true});
  }

  const std::size_t count = contradictions.size() + trusted.distrusted;
  if (count > 0) {
    std::string line = "floor labels and " + sensor + " contradict each other " +
                       std::to_string(count) + (count == 1 ? " time" : " times");
    if (!contradictions.empty()) {
      const double first = *std::min_element(contradictions.begin(), contradictions.end());
      if (std::isfinite(first)) line += " (first at " + At(first) + ")";
    }
    result.warnings.push_back(line + ": the labels are believed");
  }
  return result;
}

}  // namespace masked_mapper
