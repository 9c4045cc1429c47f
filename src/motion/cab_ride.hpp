// SPDX-License-Identifier: BSD-3-Clause
// One ride of a cab by its vertical acceleration.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "floor_acceleration.hpp"

namespace masked_mapper {

struct VerticalSample {
  double stamp = 0.0;  ///< s
  double value = 0.0;  ///< m/s^2 up
};

struct CabRide {
  std::size_t first = 0;  ///< of the samples
  std::size_t last = 0;
  double start = 0.0;  ///< s
  double end = 0.0;
  double climb = 0.0;  ///< m
  double sigma = 0.0;  ///< m
};

/// s to sample i from the one before; a gap is no push.
inline double Step(const std::vector<VerticalSample>& samples, std::size_t i) {
  return std::min(samples[i].stamp - samples[i - 1].stamp, 1.0);
}

/// Speed and height from zero to zero speed: what is left of it at the end is a constant error of
/// the acceleration. `noise`: sigma of one sample.
CabRide Integrate(const std::vector<VerticalSample>& samples, std::size_t first, std::size_t last,
                  double zero, double noise);

/// Rides with the ends of one put together again where the sensor had filtered out what lasts:
/// then a ride looks like a hop at its start and the same hop back at its end. `end`: of the
/// samples in the cab.
std::vector<CabRide> Unfiltered(const std::vector<VerticalSample>& samples, std::size_t end,
                                const std::vector<CabRide>& rides, double zero, double noise,
                                double longest_ride_s);

}  // namespace masked_mapper
