// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The heights move between the samples `first` and `last`, which themselves are at rest.
struct Step {
  std::size_t first = 0;
  std::size_t last = 0;
  double climb = 0.0;  ///< m, roughly
};

/// What one step or several say about a transit.
struct Candidate {
  Step step;                   ///< from the first of them to the last
  double largest_climb = 0.0;  ///< m, without sign
  bool by_elevator = false;
  TimeSpan span;  ///< as the wheels have it
};

/// Means of heights over spans of samples in constant time.
class MeanHeights {
 public:
  explicit MeanHeights(const std::vector<HeightSample>& samples) : sums_{0.0} {
    sums_.reserve(samples.size() + 1);
    for (const HeightSample& sample : samples) sums_.push_back(sums_.back() + sample.height);
  }
  /// Of [first, end).
  double operator()(std::size_t first, std::size_t end) const {
    return (sums_[end] - sums_[first]) / static_cast<double>(end - first);
  }

 private:
  std::vector<double> sums_;
};

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
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

/// Narrows [first, last], known to hold a step, to the samples between which the heights move.
Step Narrowed(const std::vector<HeightSample>& samples, std::size_t first, std::size_t last,
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
  Step step{first, last, high - low};
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
std::vector<Step> FindSteps(const std::vector<HeightSample>& samples, double window, double sigma,
                            const FloorPressureOptions& options) {
  const std::vector<Difference> differences = Differences(samples, window, sigma);
  const auto threshold = [&](std::size_t i, double height, double sigmas) {
    const double weather = 2.0 * options.drift_m_per_s * (samples[i + 1].stamp - samples[i].stamp);
    return std::max(height, sigmas * differences[i].sigma) + weather;
  };
  std::vector<Step> steps;
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
                                       const std::vector<Step>& steps) {
  std::vector<HeightSample> flat = samples;
  double climbed = 0.0;
  std::size_t i = 0;
  for (const Step& step : steps) {
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
std::vector<Step> FindStepsOfAllSpeeds(const PressureHeights& heights,
                                       const FloorPressureOptions& options) {
  std::vector<Step> steps;
  std::vector<HeightSample> samples = heights.samples;
  for (const double window : options.windows_s) {
    const std::vector<Step> found = FindSteps(samples, window, heights.sigma, options);
    samples = WithoutSteps(samples, found);
    steps.insert(steps.end(), found.begin(), found.end());
  }
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return a.first != b.first ? a.first < b.first : a.last < b.last;
  });
  return steps;
}

/// Parts of one motion, found by windows of different lengths, are one step.
std::vector<Step> WithOverlapsJoined(const std::vector<Step>& steps) {
  std::vector<Step> joined;
  for (const Step& step : steps) {
    if (joined.empty() || step.first >= joined.back().last) {
      joined.push_back(step);
    } else {
      joined.back().last = std::max(joined.back().last, step.last);
      joined.back().climb += step.climb;
    }
  }
  return joined;
}

/// When slow motion began and ended. It is seen late, when it leaves the noise, so its line is
/// drawn out from where it is surely under way to the heights at rest.
TimeSpan DrawnOut(const Step& step, const std::vector<HeightSample>& samples,
                  const MeanHeights& mean) {
  constexpr double kEarly = 0.15;  // shares of the climb
  constexpr double kLate = 0.4;
  constexpr double kMost = 0.3;  // of the motion's duration is added at either end
  const TimeSpan seen{samples[step.first].stamp, samples[step.last].stamp};
  const std::size_t half = (step.last - step.first) / 16;
  const auto smooth = [&](std::size_t i) {
    return mean(i < half ? 0 : i - half, std::min(i + half + 1, samples.size()));
  };
  const double low = mean(step.first < 4 * half ? 0 : step.first - 4 * half, step.first + 1);
  const double high = mean(step.last, std::min(step.last + 4 * half + 1, samples.size()));
  const auto share = [&](std::size_t i) { return (smooth(i) - low) / (high - low); };
  const auto first_above = [&](double wanted) {
    std::size_t i = step.first;
    while (i < step.last && share(i) < wanted) ++i;
    return samples[i].stamp;
  };
  const auto last_below = [&](double wanted) {
    std::size_t i = step.last;
    while (i > step.first && share(i) > wanted) --i;
    return samples[i].stamp;
  };
  constexpr double kDraw = kEarly / (kLate - kEarly);
  const double start = first_above(kEarly) - kDraw * (first_above(kLate) - first_above(kEarly));
  const double end =
      last_below(1.0 - kEarly) + kDraw * (last_below(1.0 - kEarly) - last_below(1.0 - kLate));
  const double most = kMost * seen.Duration();
  return {std::clamp(start, seen.start - most, seen.start),
          std::clamp(end, seen.end, seen.end + most)};
}

/// What the wheels make of a step; empty when they say that it cannot have been a change of floor.
std::optional<Candidate> Explained(const Step& step, const std::vector<HeightSample>& samples,
                                   const MeanHeights& mean, const WheelTrack& track,
                                   const FloorPressureOptions& options) {
  constexpr double kSlack = 2.0;  // s, by which barometers lag
  const TimeSpan widest{samples[step.first].stamp, samples[step.last].stamp};
  // Heights that move when the log begins or ends.
  const TimeSpan drawn_out = DrawnOut(step, samples, mean);
  const TimeSpan moving{step.first == 0 ? -kInfinity : drawn_out.start,
                        step.last + 1 == samples.size() ? kInfinity : drawn_out.end};
  Candidate candidate{step, std::abs(step.climb), false, moving};
  // Less than a step counts where the log cuts a ride, and the robot stays in the cab.
  const bool is_cut = candidate.largest_climb < options.step_height;
  if (!track.Travels()) return is_cut ? std::nullopt : std::optional<Candidate>(candidate);
  // The heights certainly move from `narrowest.start` to `narrowest.end`, if that is a time at all.
  const TimeSpan narrowest{samples[step.first + 1].stamp, samples[step.last - 1].stamp};
  const TimeSpan stay = track.LongestStay(widest.start, widest.end, options.cab_radius);
  const double stayed = std::min(stay.end, widest.end) - std::max(stay.start, widest.start);
  if (stay.Duration() >= options.least_stay_s &&
      stayed >= std::max(0.6 * narrowest.Duration(), std::min(2.0, 0.6 * widest.Duration()))) {
    candidate.by_elevator = true;
    candidate.span = {std::min(stay.start, narrowest.start + kSlack),
                      std::max(stay.end, narrowest.end - kSlack)};
    return candidate;
  }
  const double travel = track.Travel(widest.start, widest.end);
  if (is_cut || travel < options.least_travel_per_m * candidate.largest_climb) return std::nullopt;
  return candidate;
}

/// Rides of a cab that the robot did not leave, and flights of the same stairs, are one.
bool BelongTogether(const Candidate& a, const Candidate& b, double landing_s) {
  if (b.span.start <= a.span.end) return true;
  return !a.by_elevator && !b.by_elevator && a.step.climb * b.step.climb > 0.0 &&
         b.span.start - a.span.end < landing_s;
}

std::vector<Candidate> Joined(const std::vector<Candidate>& candidates, double landing_s) {
  std::vector<Candidate> joined;
  for (const Candidate& candidate : candidates) {
    if (joined.empty() || !BelongTogether(joined.back(), candidate, landing_s)) {
      joined.push_back(candidate);
      continue;
    }
    Candidate& last = joined.back();
    last.step.last = candidate.step.last;
    last.step.climb += candidate.step.climb;
    last.largest_climb =
        std::max({last.largest_climb, candidate.largest_climb, std::abs(last.step.climb)});
    last.by_elevator |= candidate.by_elevator;
    last.span.end = std::max(last.span.end, candidate.span.end);
  }
  return joined;
}

/// The height at one end of a transit, by samples of one floor whose weight falls with their
/// distance in time from it: neither noise nor the weather's wandering should rule.
struct EndHeight {
  double height = 0.0;    ///< m
  double stamp = 0.0;     ///< s, to which it belongs
  double variance = 0.0;  ///< m^2
};
EndHeight HeightAtEnd(const std::vector<HeightSample>& samples, std::size_t first, std::size_t end,
                      double stamp, double decay_s, double sigma) {
  double weights = 0.0;
  double squares = 0.0;
  double heights = 0.0;
  double stamps = 0.0;
  for (std::size_t i = first; i < end; ++i) {
    const double weight = std::exp(-std::abs(samples[i].stamp - stamp) / decay_s);
    weights += weight;
    squares += weight * weight;
    heights += weight * samples[i].height;
    stamps += weight * (samples[i].stamp - stamp);
  }
  return {heights / weights, stamp + stamps / weights,
          sigma * sigma * squares / (weights * weights)};
}

/// A straight line's slope through the samples, as a sum of information and of information times
/// slope, so that sides may be added.
struct Drift {
  double information = 0.0;  ///< s^2/m^2
  double weighted = 0.0;
};
Drift DriftOf(const std::vector<HeightSample>& samples, std::size_t first, std::size_t end,
              double sigma, double wander) {
  const MeanHeights mean({samples.begin() + static_cast<std::ptrdiff_t>(first),
                          samples.begin() + static_cast<std::ptrdiff_t>(end)});
  const double middle = 0.5 * (samples[first].stamp + samples[end - 1].stamp);
  const double duration = samples[end - 1].stamp - samples[first].stamp;
  double stamps = 0.0;
  for (std::size_t i = first; i < end; ++i) stamps += samples[i].stamp - middle;
  const double mean_stamp = middle + stamps / static_cast<double>(end - first);
  const double mean_height = mean(0, end - first);
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = first; i < end; ++i) {
    const double stamp = samples[i].stamp - mean_stamp;
    squares += stamp * stamp;
    products += stamp * (samples[i].height - mean_height);
  }
  if (!(squares > 0.0)) return {};
  // A random walk bends a line's slope by 6/5 of its variance per second over the duration.
  const double variance = sigma * sigma / squares + 1.2 * wander * wander / duration;
  return {1.0 / variance, products / squares / variance};
}

/// The climb of a transit from the heights of the floors before and after, `begin` to `end`.
FloorTransit Measured(const PressureHeights& heights, std::size_t begin, const Candidate& candidate,
                      std::size_t end, const FloorPressureOptions& options) {
  constexpr double kLeastSigma = 0.03;  // m: no climb is better known
  const std::vector<HeightSample>& samples = heights.samples;
  const double start = samples[candidate.step.first].stamp;
  const double stop = samples[candidate.step.last].stamp;
  while (samples[begin].stamp < start - options.drift_window_s) ++begin;
  while (samples[end - 1].stamp > stop + options.drift_window_s) --end;
  const std::size_t before_end = candidate.step.first + 1;
  const std::size_t after_begin = candidate.step.last;

  const double sigma = std::max(heights.sigma, 0.01);
  const double wander = options.wander_m_per_sqrt_s;
  const Drift before = DriftOf(samples, begin, before_end, sigma, wander);
  const Drift after = DriftOf(samples, after_begin, end, sigma, wander);
  const double prior = 1.0 / (options.drift_m_per_s * options.drift_m_per_s);
  const double drift_variance = 1.0 / (prior + before.information + after.information);
  const double drift = (before.weighted + after.weighted) * drift_variance;

  // Noise and wandering weigh the same at this decay.
  const auto count = static_cast<double>(before_end - begin + end - after_begin - 1);
  const double period =
      (start - samples[begin].stamp + samples[end - 1].stamp - stop) / std::max(1.0, count - 1.0);
  const double decay_s = std::clamp(sigma * std::sqrt(period) / wander, 5.0, 60.0);
  const EndHeight low = HeightAtEnd(samples, begin, before_end, start, decay_s, sigma);
  const EndHeight high = HeightAtEnd(samples, after_begin, end, stop, decay_s, sigma);
  const double apart = high.stamp - low.stamp;

  FloorTransit transit;
  transit.start = candidate.span.start;
  transit.middle = 0.5 * (start + stop);
  transit.end = candidate.span.end;
  transit.climb = high.height - low.height - drift * apart;
  transit.climb_sigma = std::sqrt(low.variance + high.variance + drift_variance * apart * apart +
                                  wander * wander * apart + kLeastSigma * kLeastSigma);
  return transit;
}

}  // namespace

std::vector<FloorTransit> TransitsOfPressure(const PressureHeights& heights,
                                             const WheelTrack& track,
                                             const FloorPressureOptions& options,
                                             const StoreyOptions& storeys) {
  const std::vector<HeightSample>& samples = heights.samples;
  const MeanHeights mean(samples);
  std::vector<Candidate> explained;
  for (const Step& step : WithOverlapsJoined(FindStepsOfAllSpeeds(heights, options))) {
    const std::optional<Candidate> candidate = Explained(step, samples, mean, track, options);
    if (candidate) explained.push_back(*candidate);
  }
  const std::vector<Candidate> candidates = Joined(explained, options.landing_s);
  std::vector<FloorTransit> transits;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const bool is_cut = std::isinf(candidates[k].span.start) || std::isinf(candidates[k].span.end);
    if (candidates[k].largest_climb < LeastClimb(storeys) && !is_cut) continue;
    const std::size_t begin = k == 0 ? 0 : candidates[k - 1].step.last;
    const std::size_t end =
        k + 1 == candidates.size() ? samples.size() : candidates[k + 1].step.first + 1;
    transits.push_back(Measured(heights, begin, candidates[k], end, options));
  }
  return transits;
}

}  // namespace masked_mapper
