// SPDX-License-Identifier: BSD-3-Clause
#include "motion/pressure_heights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "motion/floor_checks.hpp"

namespace masked_mapper {
namespace {

/// 100 s on one height, a step up of `climb`, 100 s more.
std::vector<PressureReading> Step(double climb, double rate, double sigma,
                                  double pa_per_unit = 1.0) {
  std::mt19937 random(7);
  std::vector<PressureReading> readings;
  for (double t = 0.0; t < 200.0; t += 1.0 / rate) {
    double noise = -6.0;
    for (int k = 0; k < 12; ++k) noise += static_cast<double>(random()) / 4294967295.0;
    const double height = (t < 100.0 ? 0.0 : climb) + sigma * noise;
    readings.push_back({t, (101'325.0 - 12.0 * height) / pa_per_unit});
  }
  return readings;
}

double Climb(const PressureHeights& heights) {
  double before = 0.0;
  double after = 0.0;
  int count_before = 0;
  int count_after = 0;
  for (const HeightSample& sample : heights.samples) {
    (sample.stamp < 100.0 ? before : after) += sample.height;
    ++(sample.stamp < 100.0 ? count_before : count_after);
  }
  return after / count_after - before / count_before;
}

TEST(PressureHeights, TwelvePascalAreAMetre) {
  for (const double rate : {0.2, 1.0, 10.0, 50.0}) {
    const PressureHeights heights = HeightsOf(Step(4.0, rate, 0.25));
    EXPECT_NEAR(Climb(heights), 4.0, 0.15) << "m at " << rate << " Hz";
    EXPECT_TRUE(heights.warnings.empty());
  }
}

TEST(PressureHeights, FastBarometersAreThinnedAndTheirNoiseShrinks) {
  const PressureHeights slow = HeightsOf(Step(4.0, 0.2, 0.25));
  const PressureHeights fast = HeightsOf(Step(4.0, 50.0, 0.25));
  EXPECT_NEAR(slow.sigma, 0.25, 0.12);
  EXPECT_LT(fast.sigma, 0.15);
  EXPECT_LE(fast.samples.size(), 501U);
}

TEST(PressureHeights, HectopascalsAreRecognisedAndSaidOnce) {
  const PressureHeights heights = HeightsOf(Step(4.0, 5.0, 0.25, 100.0));
  EXPECT_NEAR(Climb(heights), 4.0, 0.1);
  ASSERT_EQ(heights.warnings.size(), 1U);
  EXPECT_NE(heights.warnings[0].find("hectopascal"), std::string::npos);
}

TEST(PressureHeights, OnAMountainTheAirIsThinner) {
  std::vector<PressureReading> readings = Step(4.0, 5.0, 0.1);
  for (PressureReading& reading : readings) reading.pressure_pa *= 0.7;
  EXPECT_NEAR(Climb(HeightsOf(readings)), 4.0, 0.1);
}

TEST(PressureHeights, SpikesAndGarbageAreTakenOut) {
  std::vector<PressureReading> readings = Step(4.0, 2.0, 0.1);
  readings[50].pressure_pa += 400.0;
  readings[51].pressure_pa += 400.0;
  readings[0].pressure_pa -= 300.0;
  readings[120].pressure_pa = 0.0;
  readings[130].pressure_pa = std::numeric_limits<double>::quiet_NaN();
  readings[140].pressure_pa = 1e300;
  const PressureHeights heights = HeightsOf(readings);
  for (const HeightSample& sample : heights.samples) {
    const double truth =
        sample.stamp < 100.0 ? heights.samples[9].height : heights.samples[9].height + 4.0;
    if (std::abs(sample.stamp - 100.0) > 1.0) {
      EXPECT_NEAR(sample.height, truth, 1.0) << "at " << sample.stamp;
    }
  }
  ASSERT_EQ(heights.warnings.size(), 1U);
  EXPECT_NE(heights.warnings[0].find("3 of"), std::string::npos) << heights.warnings[0];
}

TEST(PressureHeights, ABarometerThatSaysNothingIsLeftOut) {
  for (const double value : {0.0, 101'325.0, 7.0, -1.0, 1e-320}) {
    std::vector<PressureReading> readings;
    for (int i = 0; i < 100; ++i) readings.push_back({0.1 * i, value});
    const PressureHeights heights = HeightsOf(readings);
    EXPECT_TRUE(heights.samples.empty()) << value;
    EXPECT_EQ(heights.warnings.size(), 1U) << value;
  }
  EXPECT_TRUE(HeightsOf({}).samples.empty());
  EXPECT_TRUE(HeightsOf({}).warnings.empty());
}

TEST(PressureHeights, MemoryGrowsWithSecondsAndNotWithReadings) {
  for (const double rate : {50.0, 1000.0}) {
    PressureTrack track;
    std::size_t most = 0;
    for (const PressureReading& reading : Step(4.0, rate, 0.25)) {
      track.Observe(reading);
      most = std::max(most, track.kept());
    }
    EXPECT_LT(most, 200.0 / 0.4 + 0.4 * rate + 300.0) << "at " << rate << " Hz";
  }
  PressureTrack stuck;
  for (int i = 0; i < 100'000; ++i) stuck.Observe({1.0, 101'325.0 + i % 7});
  EXPECT_LT(stuck.kept(), 11'000U) << "a clock that stands";
}

TEST(PressureHeights, FewReadingsAreNoHarm) {
  const std::vector<PressureReading> all = Step(4.0, 5.0, 0.1);
  for (std::size_t count = 1; count < 12; ++count) {
    const std::vector<PressureReading> some(all.begin(),
                                            all.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_LE(HeightsOf(some).samples.size(), count);
  }
}

}  // namespace
}  // namespace masked_mapper
