// SPDX-License-Identifier: BSD-3-Clause
#include "floor_acceleration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "cab_ride.hpp"
#include "masked_mapper/geometry/median.hpp"
#include "slope_heights.hpp"

namespace masked_mapper {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2

/// One push of the cab: samples [first, end).
struct Pulse {
  std::size_t first = 0;
  std::size_t end = 0;
  double speed_change = 0.0;  ///< m/s
};

/// A cab pushes softly; whoever takes the sensor in hand does not.
bool IsRough(const std::vector<VerticalSample>& samples, const Pulse& pulse, double most) {
  double changes = 0.0;
  for (std::size_t i = pulse.first + 1; i < pulse.end; ++i) {
    changes += std::abs(samples[i].value - samples[i - 1].value);
  }
  return changes > most * static_cast<double>(pulse.end - pulse.first);
}

/// Pulses among the samples [first, end), whose accelerations are above `zero`.
std::vector<Pulse> FindPulses(const std::vector<VerticalSample>& samples, std::size_t first,
                              std::size_t end, double zero, double threshold,
                              const FloorAccelerationOptions& options) {
  const auto smooth = [&](std::size_t i) {
    const std::size_t from = std::max(first, i < 2 ? 0 : i - 2);
    const std::size_t to = std::min(end, i + 3);
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) sum += samples[k].value - zero;
    return sum / static_cast<double>(to - from);
  };
  constexpr double kMostRough = 2.5;  // of the threshold, from sample to sample
  std::vector<Pulse> pulses;
  for (std::size_t i = first; i < end;) {
    const double sign = smooth(i) < 0.0 ? -1.0 : 1.0;
    Pulse pulse{i, i, 0.0};
    while (pulse.end < end && sign * smooth(pulse.end) > threshold) {
      if (pulse.end > first) {
        pulse.speed_change += smooth(pulse.end) * Step(samples, pulse.end);
      }
      ++pulse.end;
    }
    if (pulse.end == i) {
      ++i;
      continue;
    }
    if (samples[pulse.end - 1].stamp - samples[pulse.first].stamp >= options.pulse_s &&
        !IsRough(samples, pulse, kMostRough * threshold)) {
      pulses.push_back(pulse);
    }
    i = pulse.end;
  }
  return pulses;
}

/// Deviation of one sample's noise, from differences of neighbours.
double NoiseOf(const std::vector<VerticalSample>& samples, std::size_t first, std::size_t end) {
  std::vector<double> differences;
  for (std::size_t i = first + 1; i < end; ++i) {
    differences.push_back(std::abs(samples[i].value - samples[i - 1].value));
  }
  return differences.empty() ? 0.0 : Median(std::move(differences)) / 0.6745 / std::sqrt(2.0);
}

/// Rides among samples [first, end), through which the robot stays in one place.
std::vector<CabRide> RidesOfStay(const std::vector<VerticalSample>& samples, std::size_t first,
                                 std::size_t end, const FloorAccelerationOptions& options) {
  std::vector<CabRide> rides;
  if (end - first < 10) return rides;
  const double noise = NoiseOf(samples, first, end);
  std::vector<double> values;
  for (std::size_t i = first; i < end; ++i) values.push_back(samples[i].value);
  const double zero = Median(std::move(values));
  const double threshold = std::max(options.pulse, 4.0 * noise / std::sqrt(5.0));
  const std::vector<Pulse> pulses = FindPulses(samples, first, end, zero, threshold, options);
  constexpr std::size_t kMargin = 5;  // samples in which a pulse begins and ends softly
  for (std::size_t k = 0; k < pulses.size();) {
    double speed = 0.0;
    double highest = 0.0;
    std::optional<std::size_t> last;
    for (std::size_t m = k; m < pulses.size() && !last; ++m) {
      const double duration = samples[pulses[m].end - 1].stamp - samples[pulses[k].first].stamp;
      if (duration > options.longest_ride_s) break;
      speed += pulses[m].speed_change;
      highest = std::max(highest, std::abs(speed));
      const double rest = std::max(options.rest_speed, options.rest_share * highest);
      if (m > k && std::abs(speed) <= rest) last = m;
    }
    if (!last) {
      ++k;
      continue;
    }
    const std::size_t from = std::max(first, pulses[k].first - std::min(pulses[k].first, kMargin));
    const std::size_t to = std::min(end - 1, pulses[*last].end - 1 + kMargin);
    rides.push_back(Integrate(samples, from, to, zero, noise));
    k = *last + 1;
  }
  return Unfiltered(samples, end, rides, zero, noise, options.longest_ride_s);
}

FloorTransit TransitOf(const CabRide& ride) {
  return {ride.start, 0.5 * (ride.start + ride.end), ride.end, ride.climb, ride.sigma, {}};
}

/// Rides of a cab that the robot does not leave make one transit.
FloorTransit Joined(const FloorTransit& a, const FloorTransit& b) {
  FloorTransit joined = a;
  joined.middle = 0.5 * (a.middle + b.middle);
  joined.end = std::max(a.end, b.end);
  joined.climb = *a.climb + *b.climb;
  joined.climb_sigma = std::hypot(a.climb_sigma, b.climb_sigma);
  return joined;
}

/// Of the transits of stays in order: those that meet are one.
void Append(const FloorTransit& transit, std::vector<FloorTransit>& transits) {
  if (transits.empty() || transit.start > transits.back().end) {
    transits.push_back(transit);
  } else {
    transits.back() = Joined(transits.back(), transit);
  }
}

std::vector<FloorTransit> TransitsOf(const std::vector<VerticalSample>& samples,
                                     const WheelTrack& track,
                                     const FloorAccelerationOptions& options) {
  std::vector<TimeSpan> stays = {{samples.front().stamp, samples.back().stamp}};
  if (track.Travels()) stays = track.Stays(options.cab_radius, options.least_stay_s);
  std::vector<FloorTransit> transits;
  for (const TimeSpan& stay : stays) {
    const auto is_before = [](const VerticalSample& sample, double stamp) {
      return sample.stamp < stamp;
    };
    const auto first = std::lower_bound(samples.begin(), samples.end(), stay.start, is_before);
    const auto end = std::lower_bound(first, samples.end(), stay.end, is_before);
    for (const CabRide& ride :
         RidesOfStay(samples, static_cast<std::size_t>(first - samples.begin()),
                     static_cast<std::size_t>(end - samples.begin()), options)) {
      FloorTransit transit = TransitOf(ride);
      if (track.Travels()) {
        const TimeSpan whole = track.StayAround(transit.middle, options.cab_radius);
        transit.start = std::min(transit.start, whole.start);
        transit.end = std::max(transit.end, whole.end);
      }
      Append(transit, transits);
    }
  }
  return transits;
}

/// Both in order; where a cab's ride was felt, it was no stairs.
std::vector<FloorTransit> WithStairs(std::vector<FloorTransit> rides,
                                     const std::vector<FloorTransit>& stairs) {
  const std::size_t count = rides.size();
  for (const FloorTransit& transit : stairs) {
    const bool is_ride =
        std::any_of(rides.begin(), rides.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](const FloorTransit& ride) {
                      return ride.start <= transit.end && transit.start <= ride.end;
                    });
    if (!is_ride) rides.push_back(transit);
  }
  std::sort(rides.begin(), rides.end(),
            [](const FloorTransit& a, const FloorTransit& b) { return a.start < b.start; });
  return rides;
}

/// Gravity tells the unit: the factor that makes m/s^2 of the readings; 0: they are of no use.
double ScaleOf(double gravity, std::vector<std::string>& warnings) {
  if (gravity > 0.9 && gravity < 1.1) {
    warnings.emplace_back("acceleration is taken as multiples of gravity");
    return kGravity;
  }
  if (gravity >= 8.0 && gravity <= 12.0) return 1.0;
  warnings.emplace_back("acceleration without gravity is of no use for floors: left out");
  return 0.0;
}

}  // namespace

AccelerationTrack::Spell AccelerationTrack::Current() const {
  const double count = count_;
  return {first_stamp_ + stamps_ / count, sum_ / count};
}

void AccelerationTrack::Observe(const AccelerationReading& reading) {
  if (!std::isfinite(reading.stamp) || !reading.acceleration_in_robot.allFinite()) return;
  if (count_ > 0 && reading.stamp < last_stamp_) return;
  if (count_ > 0 && reading.stamp >= first_stamp_ + options_.spell_s) {
    spells_.push_back(Current());
    count_ = 0;
  }
  if (count_ == 0) {
    first_stamp_ = reading.stamp;
    stamps_ = 0.0;
    sum_.setZero();
  }
  last_stamp_ = reading.stamp;
  stamps_ += reading.stamp - first_stamp_;
  sum_ += reading.acceleration_in_robot;
  ++count_;
}

std::vector<double> AccelerationTrack::Stamps() const {
  std::vector<double> stamps;
  for (const Spell& spell : spells_) stamps.push_back(spell.stamp);
  if (count_ > 0) stamps.push_back(last_stamp_);
  return stamps;
}

AccelerationTrack::Rides AccelerationTrack::FindRides(const WheelTrack& track,
                                                      const StoreyOptions& storeys) const {
  Rides result;
  if (IsEmpty()) return result;
  std::vector<Spell> spells = spells_;
  if (count_ > 0) spells.push_back(Current());
  Eigen::Vector3d up(0.0, 0.0, 0.0);  // as gravity tells it
  std::vector<double> norms;
  for (const Spell& spell : spells) {
    norms.push_back(spell.acceleration_in_robot.norm());
    up += spell.acceleration_in_robot / std::max(norms.back(), 1e-9);
  }
  const double scale = ScaleOf(Median(std::move(norms)), result.warnings);
  if (scale == 0.0) return result;
  result.usable = true;
  up.normalize();
  std::vector<VerticalSample> samples;
  samples.reserve(spells.size());
  for (const Spell& spell : spells) {
    samples.push_back({spell.stamp, scale * up.dot(spell.acceleration_in_robot)});
  }
  std::vector<TiltSample> tilts;
  for (const Spell& spell : spells)
    tilts.push_back({spell.stamp, scale * spell.acceleration_in_robot});
  const PressureHeights slopes = SlopeHeights(tilts, up, track);
  result.transits = TransitsOf(samples, track, options_);
  if (!slopes.samples.empty()) {
    result.transits = WithStairs(std::move(result.transits),
                                 TransitsOfPressure(slopes, track, options_.stairs, storeys));
  }
  const auto is_small = [&](const FloorTransit& transit) {
    return std::abs(*transit.climb) < LeastClimb(storeys) && std::isfinite(transit.start) &&
           std::isfinite(transit.end);
  };
  result.transits.erase(std::remove_if(result.transits.begin(), result.transits.end(), is_small),
                        result.transits.end());
  return result;
}

}  // namespace masked_mapper
