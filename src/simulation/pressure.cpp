// SPDX-License-Identifier: BSD-3-Clause
#include "pressure.hpp"

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

PressureNoise PressureNoise::None() {
  PressureNoise noise;
  noise.sigma = noise.weather = noise.ventilation = 0.0;
  return noise;
}

double PressureAt(double height, double sea_level) {
  constexpr double kScaleHeight = 8434.0;  // m, of an atmosphere of 15 deg C
  return sea_level * std::exp(-height / kScaleHeight);
}

PressureSimulation::PressureSimulation(const PressureOptions& options, const PressureNoise& noise,
                                       std::uint64_t seed)
    : options_(options), noise_(noise), random_(seed, "pressure") {
  for (Wave& wave : waves_) {
    wave.frequency = 2.0 * kPi / random_.Uniform(7200.0, 28800.0);
    wave.phase = random_.Uniform(0.0, 2.0 * kPi);
  }
  ventilation_ = noise.ventilation * random_.Normal();
}

double PressureSimulation::Measure(double time, double height) {
  const double seconds = time - last_time_;
  last_time_ = time;
  const double keep =
      noise_.ventilation_seconds > 0.0 ? 1.0 / (1.0 + seconds / noise_.ventilation_seconds) : 0.0;
  ventilation_ =
      keep * ventilation_ + std::sqrt(1.0 - keep * keep) * noise_.ventilation * random_.Normal();
  double apparent = height + ventilation_;
  for (const Wave& wave : waves_) {
    apparent += noise_.weather * std::sin(wave.frequency * time + wave.phase);
  }
  apparent += noise_.sigma * random_.Normal();
  return PressureAt(apparent, options_.sea_level);
}

}  // namespace masked_mapper
