// SPDX-License-Identifier: BSD-3-Clause
#include "pressure_steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "masked_mapper/geometry/median.hpp"

namespace masked_mapper {
namespace {

/// How much higher the samples after a place are than those before it, and how sure that is.
struct Difference {
  double climb = 0.0;
  double sigma = 0.0;
};

/// Differences[i] is between sample i and i + 1. Windows hold two samples at least, where those are
/// not too long ago.
std::vector<Difference> Differences(const std::vector<HeightSample>& samples, double window,
                                    double sigma) {
  constexpr std::size_t kFewest = 2;
  constexpr double kTooLongAgo = 60.0;  // s
  const MeanHeights mean(samples);
  std::vector<Difference> differences(samples.empty() ? 0 : samples.size() - 1);
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    while (samples[first].stamp <= samples[i].stamp - window) ++first;
    while (end < samples.size() && samples[end].stamp < samples[i + 1].stamp + window) ++end;
    std::size_t before = std::min(first, i);
    std::size_t after = std::max(end, i + 2);
    while (before > 0 && i + 1 - before < kFewest &&
           samples[before - 1].stamp > samples[i].stamp - kTooLongAgo) {
      --before;
    }
    while (after < samples.size() && after - i - 1 < kFewest &&
           samples[after].stamp < samples[i + 1].stamp + kTooLongAgo) {
      ++after;
    }
    const auto count_before = static_cast<double>(i + 1 - before);
    const auto count_after = static_cast<double>(after - i - 1);
    differences[i] = {mean(i + 1, after) - mean(before, i + 1),
                      sigma * std::sqrt(1.0 / count_before + 1.0 / count_after)};
  }
  return differences;
}

double MedianHeight(const std::vector<HeightSample>& samples, std::size_t first, std::size_t end) {
  std::vector<double> heights;
  for (std::size_t i = first; i < end; ++i) heights.push_back(samples[i].height);
  return Median(std::move(heights));
}

/// Narrows [first, last], known to hold a step, to the samples between which the heights move.
PressureStep Narrowed(const std::vector<HeightSample>& samples, std::size_t first, std::size_t last,
                      double window, double sigma) {
  std::size_t before = first;
  while (before > 0 && first - before < 12 &&
         samples[before - 1].stamp > samples[first].stamp - window) {
    --before;
  }
  std::size_t after = last;
  while (after + 1 < samples.size() && after - last < 12 &&
         samples[after + 1].stamp < samples[last].stamp + window) {
    ++after;
  }
  const double low = MedianHeight(samples, before, first + 1);
  const double high = MedianHeight(samples, last, after + 1);
  PressureStep step{first, last, high - low};
  const double sign = step.climb < 0.0 ? -1.0 : 1.0;
  const double tolerance = std::min(std::max(0.3, 2.5 * sigma), 0.25 * std::abs(step.climb));
  const auto left = [&](std::size_t i) { return sign * (samples[i].height - low) > tolerance; };
  const auto arrived = [&](std::size_t i) {
    return sign * (high - samples[i].height) <= tolerance;
  };
  while (step.first + 1 < last && !(left(step.first + 1) && left(step.first + 2))) ++step.first;
  while (step.last > step.first + 1 && arrived(step.last - 1) && arrived(step.last - 2)) {
    --step.last;
  }
  return step;
}

/// Steps that a window of this length shows best, in order.
std::vector<PressureStep> FindSteps(const std::vector<HeightSample>& samples, double window,
                                    double sigma, const FloorPressureOptions& options) {
  const std::vector<Difference> differences = Differences(samples, window, sigma);
  const auto threshold = [&](std::size_t i, double height, double sigmas) {
    const double weather = 2.0 * options.drift_m_per_s * (samples[i + 1].stamp - samples[i].stamp);
    return std::max(height, sigmas * differences[i].sigma) + weather;
  };
  std::vector<PressureStep> steps;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const double sign = differences[i].climb < 0.0 ? -1.0 : 1.0;
    const auto moves = [&](std::size_t k) {
      return sign * differences[k].climb > threshold(k, options.moving_height, 3.0);
    };
    if (!moves(i)) continue;
    std::size_t end = i;
    while (end < differences.size() && moves(end)) ++end;
    // Where the log cuts a ride, half a step is as much as it may show.
    const bool is_cut = i == 0 || end == differences.size();
    const double height = is_cut ? 0.5 * options.step_height : options.step_height;
    bool is_step = false;
    for (std::size_t k = i; k < end; ++k) {
      is_step |= sign * differences[k].climb > threshold(k, height, 5.0);
    }
    if (is_step) steps.push_back(Narrowed(samples, i, end, window, sigma));
    i = end - 1;
  }
  return steps;
}

/// The heights as they were without the steps: each is bridged from rest to rest.
std::vector<HeightSample> WithoutSteps(const std::vector<HeightSample>& samples,
                                       const std::vector<PressureStep>& steps) {
  std::vector<HeightSample> flat = samples;
  double climbed = 0.0;
  std::size_t i = 0;
  for (const PressureStep& step : steps) {
    for (; i <= step.first; ++i) flat[i].height -= climbed;
    const double before = flat[step.first].height;
    climbed += step.climb;
    const double after = samples[step.last].height - climbed;
    const double duration = std::max(samples[step.last].stamp - samples[step.first].stamp, 1e-9);
    for (; i < step.last; ++i) {
      const double fraction = (samples[i].stamp - samples[step.first].stamp) / duration;
      flat[i].height = before + fraction * (after - before);
    }
  }
  for (; i < flat.size(); ++i) flat[i].height -= climbed;
  return flat;
}

/// Quick steps first; slower ones in what they leave.
std::vector<PressureStep> FindStepsOfAllSpeeds(const PressureHeights& heights,
                                               const FloorPressureOptions& options) {
  std::vector<PressureStep> steps;
  std::vector<HeightSample> samples = heights.samples;
  for (const double window : options.windows_s) {
    const std::vector<PressureStep> found = FindSteps(samples, window, heights.sigma, options);
    samples = WithoutSteps(samples, found);
    steps.insert(steps.end(), found.begin(), found.end());
  }
  std::sort(steps.begin(), steps.end(), [](const PressureStep& a, const PressureStep& b) {
    return a.first != b.first ? a.first < b.first : a.last < b.last;
  });
  return steps;
}

/// Parts of one motion, found by windows of different lengths, are one step.
std::vector<PressureStep> WithOverlapsJoined(const std::vector<PressureStep>& steps) {
  std::vector<PressureStep> joined;
  for (const PressureStep& step : steps) {
    if (joined.empty() || step.first >= joined.back().last) {
      joined.push_back(step);
    } else {
      joined.back().last = std::max(joined.back().last, step.last);
      joined.back().climb += step.climb;
    }
  }
  return joined;
}

}  // namespace

std::vector<PressureStep> FindPressureSteps(const PressureHeights& heights,
                                            const FloorPressureOptions& options) {
  return WithOverlapsJoined(FindStepsOfAllSpeeds(heights, options));
}

}  // namespace masked_mapper
