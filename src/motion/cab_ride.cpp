// SPDX-License-Identifier: BSD-3-Clause
#include "cab_ride.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::size_t kDying = 20;  // samples in which an echo dies away, behind the last pulse

/// A phone that takes gravity out of its acceleration takes out with it whatever lasts: of a push
/// it leaves the beginning, and an echo of the other sign that dies away. A ride then looks like a
/// hop of a metre at the start, and the same hop back where it ends, which no cab makes.
bool AreEndsOfOneRide(const CabRide& departure, const CabRide& arrival, double longest_ride_s) {
  constexpr double kLeastHop = 0.3;  // m
  constexpr double kAlike = 0.25;    // of the hop
  return std::abs(departure.climb) >= kLeastHop &&
         std::abs(departure.climb + arrival.climb) <= kAlike * std::abs(departure.climb) &&
         arrival.end - departure.start <= longest_ride_s;
}

/// Samples without what was taken out of them by a filter of this time constant: y = a - Y / tau,
/// with Y the integral of y, so a = y + Y / tau.
std::vector<VerticalSample> Restored(const std::vector<VerticalSample>& samples, std::size_t first,
                                     std::size_t last, double zero, double tau) {
  std::vector<double> sums = {0.0};
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double mean = 0.5 * (samples[i - 1].value + samples[i].value) - zero;
    sums.push_back(sums.back() + mean * Step(samples, i));
  }
  const double drift = sums.back() / static_cast<double>(std::max<std::size_t>(last - first, 1));
  std::vector<VerticalSample> restored;
  for (std::size_t i = first; i <= last; ++i) {
    const double sum = sums[i - first] - drift * static_cast<double>(i - first);
    restored.push_back({samples[i].stamp, samples[i].value - zero + sum / tau});
  }
  return restored;
}

/// The filter's time constant by the echo of a departure: once the cab has its speed, what is left
/// dies away as y = -Y / tau. (A cab arrives slowly: there it is not alone.) 0: it does not show.
double TimeConstantOf(const std::vector<VerticalSample>& samples, const CabRide& departure,
                      std::size_t end, double zero) {
  constexpr std::size_t kSurely = 2;  // samples behind the strongest of the echo
  const std::size_t last = std::min(departure.last + kDying, end - 1);
  const double sign = departure.climb < 0.0 ? -1.0 : 1.0;
  std::vector<double> sums = {0.0};
  std::size_t strongest = departure.first;
  for (std::size_t i = departure.first + 1; i <= last; ++i) {
    sums.push_back(sums.back() +
                   0.5 * (samples[i - 1].value + samples[i].value - 2.0 * zero) * Step(samples, i));
    if (sign * samples[i].value < sign * samples[strongest].value) strongest = i;
  }
  const double drift = sums.back() / static_cast<double>(sums.size());
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = strongest + kSurely; i <= last; ++i) {
    const std::size_t k = i - departure.first;
    const double sum = sums[k] - drift * static_cast<double>(k);
    if (sign * sum < 0.02) break;  // m/s
    squares += sum * sum;
    products -= sum * (samples[i].value - zero);
  }
  return products > 0.0 ? squares / products : 0.0;
}

}  // namespace

CabRide Integrate(const std::vector<VerticalSample>& samples, std::size_t first, std::size_t last,
                  double zero, double noise) {
  std::vector<double> speeds = {0.0};
  double duration = 0.0;
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double mean = 0.5 * (samples[i - 1].value + samples[i].value) - zero;
    speeds.push_back(speeds.back() + mean * Step(samples, i));
    duration += Step(samples, i);
  }
  const double bias = duration > 0.0 ? speeds.back() / duration : 0.0;
  CabRide ride{first, last, samples[first].stamp, samples[last].stamp, 0.0, 0.0};
  double elapsed = 0.0;
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double step = Step(samples, i);
    const double before = speeds[i - first - 1] - bias * elapsed;
    elapsed += step;
    ride.climb += 0.5 * step * (before + speeds[i - first] - bias * elapsed);
  }
  // A bridge of white noise, some per cent of scale, and what no model has.
  const double period = duration / static_cast<double>(std::max<std::size_t>(last - first, 1));
  const double bridge = noise * std::sqrt(period * duration * duration * duration / 12.0);
  ride.sigma = std::sqrt(bridge * bridge + std::pow(0.02 * ride.climb, 2) + 0.1 * 0.1);
  return ride;
}

std::vector<CabRide> Unfiltered(const std::vector<VerticalSample>& samples, std::size_t end,
                                const std::vector<CabRide>& rides, double zero, double noise,
                                double longest_ride_s) {
  constexpr double kTauShare = 0.08;  // by which echoes err
  std::vector<CabRide> whole;
  for (std::size_t k = 0; k < rides.size(); ++k) {
    const bool is_departure =
        k + 1 < rides.size() && AreEndsOfOneRide(rides[k], rides[k + 1], longest_ride_s);
    const double tau =
        is_departure ? TimeConstantOf(samples, rides[k], rides[k + 1].first, zero) : 0.0;
    if (tau <= 0.0) {
      whole.push_back(rides[k]);
      continue;
    }
    const std::size_t first = rides[k].first;
    const std::size_t next = k + 2 < rides.size() ? rides[k + 2].first : end;
    const std::size_t last = std::min(rides[k + 1].last + kDying, next - 1);
    const std::vector<VerticalSample> restored = Restored(samples, first, last, zero, tau);
    CabRide ride = Integrate(restored, 0, restored.size() - 1, 0.0, noise);
    ride.first = first;
    ride.last = last;
    ride.sigma = std::hypot(ride.sigma, kTauShare * ride.climb);
    whole.push_back(ride);
    ++k;
  }
  return whole;
}

}  // namespace masked_mapper
