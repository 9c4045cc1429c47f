// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/pressure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

TEST(Pressure, FallsByTwelvePascalPerMetre) {
  PressureSimulation pressure({}, PressureNoise::None(), 1);
  EXPECT_NEAR(pressure.Measure(0.0, 0.0) - pressure.Measure(1.0, 1.0), 12.0, 0.1) << "Pa";
}

TEST(Pressure, WeatherMovesItByMetresOverHoursButNotWithinAMinute) {
  PressureNoise noise = PressureNoise::None();
  noise.weather = PressureNoise().weather;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    PressureSimulation pressure({}, noise, seed);
    double low = 1e9;
    double high = 0.0;
    double last = pressure.Measure(0.0, 0.0);
    for (double time = 60.0; time < 9'000.0; time += 60.0) {
      const double now = pressure.Measure(time, 0.0);
      EXPECT_LT(std::abs(now - last) / 12.0, 0.25) << "m in a minute";
      low = std::min(low, now);
      high = std::max(high, now);
      last = now;
    }
    EXPECT_GT((high - low) / 12.0, 1.0) << "m";
    EXPECT_LT((high - low) / 12.0, 10.0) << "m";
  }
}

TEST(Pressure, NoiseHasItsDeviation) {
  PressureNoise noise = PressureNoise::None();
  noise.sigma = 0.25;
  PressureSimulation pressure({}, noise, 1);
  double squares = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    squares += std::pow((pressure.Measure(i, 0.0) - 101'325.0) / 12.01, 2.0);
  }
  EXPECT_NEAR(std::sqrt(squares / 10'000.0), 0.25, 0.01) << "m";
}

}  // namespace
}  // namespace masked_mapper
