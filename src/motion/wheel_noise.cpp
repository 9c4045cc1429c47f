// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_noise.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {

WheelNoise::WheelNoise(const WheelNoiseOptions& options, const DeadReckoningOptions& wheels)
    : options_(options), wheels_(wheels) {
  travel_.windows = turn_.windows = options.first_windows;
}

void WheelNoise::Restart() {
  runs_ = false;
  travelled_m_ = turned_rad_ = error_rad_ = 0.0;
}

void WheelNoise::Observe(const Pose2& by_wheels, const Pose2& corrected, double scan_sigma_rad) {
  travelled_m_ += std::hypot(by_wheels.x, by_wheels.y);
  turned_rad_ += std::abs(by_wheels.theta);
  error_rad_ += WrapAngle(corrected.theta - by_wheels.theta);
  if (!(scan_sigma_rad <= DegToRad(options_.sure_sigma_deg))) return;
  if (!runs_) {
    Restart();
    runs_ = true;
    return;
  }
  if (travelled_m_ < options_.window_m && turned_rad_ < DegToRad(options_.window_deg)) return;
  const auto square = [](double sigma_deg) { return DegToRad(sigma_deg) * DegToRad(sigma_deg); };
  const double by_travel = square(wheels_.sigma_heading_deg_per_sqrt_m) * travelled_m_;
  const double by_turn = square(wheels_.sigma_heading_deg_per_sqrt_rad) * turned_rad_;
  // A window tells about what it held most of, and is charged with all of its error.
  if (turned_rad_ >= 0.5 * DegToRad(options_.window_deg)) {
    Learn(error_rad_ * error_rad_, by_turn, turn_);
  } else if (turned_rad_ < DegToRad(5.0)) {
    Learn(error_rad_ * error_rad_, by_travel, travel_);
  }
  Restart();
  runs_ = true;
}

void WheelNoise::Learn(double squared_error, double expected, Ratio& ratio) const {
  if (!(expected > 0.0)) return;
  ratio.windows = std::min(ratio.windows + 1.0, options_.remembered_windows);
  // A slip or a wrong match is not the noise: its say is bounded at three sigmas.
  ratio.mean += (std::min(squared_error / expected, 9.0) - ratio.mean) / ratio.windows;
}

WheelScales WheelNoise::scales() const {
  const auto scale = [&](const Ratio& ratio) {
    return std::clamp(std::sqrt(ratio.mean), options_.least_scale, 1.0);
  };
  return {scale(travel_), scale(turn_)};
}

}  // namespace masked_mapper
