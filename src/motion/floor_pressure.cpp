// SPDX-License-Identifier: BSD-3-Clause
#include "floor_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pressure_steps.hpp"

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What one step or several say about a transit.
struct Candidate {
  PressureStep step;           ///< from the first of them to the last
  double largest_climb = 0.0;  ///< m, without sign
  bool by_elevator = false;
  TimeSpan span;  ///< as the wheels have it
};

/// When slow motion began and ended. It is seen late, when it leaves the noise, so its line is
/// drawn out from where it is surely under way to the heights at rest.
TimeSpan DrawnOut(const PressureStep& step, const std::vector<HeightSample>& samples,
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

/// The longest silence in a step, if it is most of it: when the height changed in it, nobody knows.
std::optional<TimeSpan> SilenceOf(const PressureStep& step,
                                  const std::vector<HeightSample>& samples) {
  constexpr double kLeast = 15.0;  // s
  constexpr double kMost = 120.0;  // s: in a longer one the robot does more than change the floor
  TimeSpan longest{samples[step.first].stamp, samples[step.first].stamp};
  for (std::size_t i = step.first; i < step.last; ++i) {
    const TimeSpan silence{samples[i].stamp, samples[i + 1].stamp};
    if (silence.Duration() > longest.Duration()) longest = silence;
  }
  const double whole = samples[step.last].stamp - samples[step.first].stamp;
  if (longest.Duration() < std::max(kLeast, 0.5 * whole) || longest.Duration() > kMost) {
    return std::nullopt;
  }
  return longest;
}

/// What the wheels make of a step; empty when they say that it cannot have been a change of floor.
std::optional<Candidate> Explained(const PressureStep& step,
                                   const std::vector<HeightSample>& samples,
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
  // A rest in a silence may be a ride or none: scans or an accelerometer may have heard it.
  if (const std::optional<TimeSpan> silence = SilenceOf(step, samples); silence && !is_cut) {
    candidate.by_elevator = true;
    candidate.span = *silence;
    return candidate;
  }
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
  for (const PressureStep& step : FindPressureSteps(heights, options)) {
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
