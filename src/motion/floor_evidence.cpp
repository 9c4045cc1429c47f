// SPDX-License-Identifier: BSD-3-Clause
#include "floor_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace masked_mapper {
namespace {

constexpr double kSlack = 5.0;  // s by which sensors differ about one ride

bool Overlap(const FloorTransit& a, const FloorTransit& b) {
  return a.start <= b.end + kSlack && b.start <= a.end + kSlack;
}

bool Hears(const FloorEvidence& sensor, double stamp) {
  return std::any_of(sensor.heard.begin(), sensor.heard.end(), [&](const TimeSpan& span) {
    return span.start <= stamp && stamp <= span.end;
  });
}

/// When the robot surely was between floors.
double MiddleOf(const FloorTransit& transit) {
  return std::clamp(transit.middle, transit.start, transit.end);
}

/// One ride as two sensors noticed it: the better one's times, and both heights, unless they
/// contradict each other.
void Fuse(const FloorTransit& other, FloorTransit& transit) {
  constexpr double kMostSigmas = 4.0;
  transit.by.Add(other.by);
  if (!other.climb) return;
  if (!transit.climb) {
    transit.climb = other.climb;
    transit.climb_sigma = other.climb_sigma;
    return;
  }
  const double variance = transit.climb_sigma * transit.climb_sigma;
  const double other_variance = other.climb_sigma * other.climb_sigma;
  const double apart = std::abs(*other.climb - *transit.climb);
  if (!(apart <= kMostSigmas * std::sqrt(variance + other_variance))) return;
  const double sum = std::max(variance + other_variance, 1e-12);
  transit.climb = (*transit.climb * other_variance + *other.climb * variance) / sum;
  transit.climb_sigma = std::sqrt(variance * other_variance / sum);
}

/// A sensor that went silent before a change and spoke again after it knows the whole climb, but
/// neither when nor in how many rides: what lesser sensors noticed meanwhile stands for it.
void FillGap(const FloorTransit& whole, const std::vector<FloorTransit>& parts,
             std::vector<FloorTransit>& transits) {
  if (parts.empty()) {
    transits.push_back(whole);
    return;
  }
  for (const FloorTransit& part : parts) {
    transits.push_back(part);
    if (parts.size() == 1) Fuse(whole, transits.back());
  }
}

/// What `lesser` noticed, less what `better` heard and did not.
std::vector<FloorTransit> FusedOfTwo(const FloorEvidence& better, const FloorEvidence& lesser) {
  std::vector<FloorTransit> transits;
  std::vector<bool> is_used(lesser.transits.size(), false);
  for (const FloorTransit& transit : better.transits) {
    std::vector<FloorTransit> parts;
    for (std::size_t i = 0; i < lesser.transits.size(); ++i) {
      if (is_used[i] || !Overlap(transit, lesser.transits[i])) continue;
      is_used[i] = true;
      parts.push_back(lesser.transits[i]);
    }
    if (!Hears(better, MiddleOf(transit))) {
      FillGap(transit, parts, transits);
      continue;
    }
    transits.push_back(transit);
    if (parts.size() == 1) Fuse(parts.front(), transits.back());
  }
  for (std::size_t i = 0; i < lesser.transits.size(); ++i) {
    const FloorTransit& transit = lesser.transits[i];
    if (!is_used[i] && !Hears(better, MiddleOf(transit))) transits.push_back(transit);
  }
  std::sort(transits.begin(), transits.end(), [](const FloorTransit& a, const FloorTransit& b) {
    return a.start != b.start ? a.start < b.start : a.end < b.end;
  });
  return transits;
}

std::vector<TimeSpan> Union(std::vector<TimeSpan> spans, const std::vector<TimeSpan>& more) {
  spans.insert(spans.end(), more.begin(), more.end());
  return spans;
}

}  // namespace

std::vector<TimeSpan> SpansOf(const std::vector<double>& stamps, double longest_gap_s) {
  std::vector<TimeSpan> spans;
  for (const double stamp : stamps) {
    if (spans.empty() || stamp - spans.back().end > longest_gap_s) {
      spans.push_back({stamp, stamp});
    } else {
      spans.back().end = stamp;
    }
  }
  return spans;
}

std::vector<FloorTransit> Fused(const std::vector<FloorEvidence>& evidence) {
  FloorEvidence all;
  for (const FloorEvidence& sensor : evidence) {
    all.transits = FusedOfTwo(all, sensor);
    all.heard = Union(std::move(all.heard), sensor.heard);
  }
  return all.transits;
}

}  // namespace masked_mapper
