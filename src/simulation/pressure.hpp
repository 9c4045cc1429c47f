// SPDX-License-Identifier: BSD-3-Clause
// A barometer on a robot in a building: height, weather, ventilation, noise.
#pragma once

#include <cstdint>

#include "masked_mapper/simulation/simulation.hpp"
#include "random_generator.hpp"

namespace masked_mapper {

/// Pressure of the standard atmosphere at a height, Pa; 12 Pa less per metre.
double PressureAt(double height, double sea_level);

class PressureSimulation {
 public:
  PressureSimulation(const PressureOptions& options, const PressureNoise& noise,
                     std::uint64_t seed);

  /// Pascal at a time (s, rising from call to call) and height (m).
  double Measure(double time, double height);

 private:
  struct Wave {
    double frequency = 0.0;  ///< rad/s
    double phase = 0.0;
  };
  PressureOptions options_;
  PressureNoise noise_;
  RandomGenerator random_;
  Wave waves_[3];
  double ventilation_ = 0.0;  ///< m
  double last_time_ = 0.0;
};

}  // namespace masked_mapper
