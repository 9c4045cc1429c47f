// SPDX-License-Identifier: BSD-3-Clause
#include "motion/floor_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace masked_mapper {
namespace {

FloorTransit Ride(double start, double end, std::optional<double> climb, double sigma,
                  FloorSource source) {
  FloorTransit ride{start, 0.5 * (start + end), end, climb, sigma, {}};
  ride.by.Add(source);
  return ride;
}

TEST(FloorEvidence, SpansArePartedByGaps) {
  const std::vector<TimeSpan> spans = SpansOf({1.0, 2.0, 9.0, 40.0, 41.0}, 10.0);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].start, 1.0);
  EXPECT_EQ(spans[0].end, 9.0);
  EXPECT_EQ(spans[1].start, 40.0);
  EXPECT_TRUE(SpansOf({}, 10.0).empty());
}

TEST(FloorEvidence, TwoSensorsOfOneRideAreWeighed) {
  const std::vector<FloorTransit> fused =
      Fused({{{Ride(100, 120, 3.9, 0.3, FloorSource::kPressure)}, {{0.0, 500.0}}},
             {{Ride(102, 118, 3.6, 0.1, FloorSource::kAcceleration)}, {{0.0, 500.0}}}});
  ASSERT_EQ(fused.size(), 1U);
  EXPECT_EQ(fused[0].start, 100.0);
  EXPECT_NEAR(*fused[0].climb, 3.63, 1e-9);
  EXPECT_NEAR(fused[0].climb_sigma, 0.3 * 0.1 / std::sqrt(0.1), 1e-9);
  EXPECT_TRUE(fused[0].by.Has(FloorSource::kPressure));
  EXPECT_TRUE(fused[0].by.Has(FloorSource::kAcceleration));
}

TEST(FloorEvidence, WhereTheyContradictTheBetterOneIsBelieved) {
  const std::vector<FloorTransit> fused =
      Fused({{{Ride(100, 120, 3.9, 0.1, FloorSource::kPressure)}, {{0.0, 500.0}}},
             {{Ride(102, 118, 30.0, 0.1, FloorSource::kAcceleration)}, {{0.0, 500.0}}}});
  ASSERT_EQ(fused.size(), 1U);
  EXPECT_EQ(*fused[0].climb, 3.9);
}

TEST(FloorEvidence, WhatABetterSensorHeardNothingOfIsNoRide) {
  EXPECT_TRUE(
      Fused({{{}, {{0.0, 500.0}}}, {{Ride(100, 120, {}, 0.0, FloorSource::kLidar)}, {}}}).empty());
}

TEST(FloorEvidence, WhereTheBetterOneWasSilentTheOthersDecide) {
  const FloorEvidence pressure{{Ride(100, 120, 4.0, 0.1, FloorSource::kPressure)}, {{0.0, 300.0}}};
  const FloorEvidence acceleration{{Ride(101, 119, 4.1, 0.3, FloorSource::kAcceleration),
                                    Ride(400, 420, -4.0, 0.2, FloorSource::kAcceleration)},
                                   {{0.0, 450.0}}};
  const FloorEvidence lidar{
      {Ride(100, 120, {}, 0.0, FloorSource::kLidar), Ride(200, 220, {}, 0.0, FloorSource::kLidar),
       Ride(400, 420, {}, 0.0, FloorSource::kLidar), Ride(600, 620, {}, 0.0, FloorSource::kLidar)},
      {}};
  const std::vector<FloorTransit> fused = Fused({pressure, acceleration, lidar});
  ASSERT_EQ(fused.size(), 3U);
  EXPECT_EQ(fused[1].start, 400.0);
  EXPECT_EQ(*fused[1].climb, -4.0);
  EXPECT_EQ(fused[2].start, 600.0);
  EXPECT_FALSE(fused[2].climb);
}

TEST(FloorEvidence, RidesInAGapOfTheBetterOneStandForItsStep) {
  const FloorEvidence pressure{{Ride(100, 400, 4.0, 0.1, FloorSource::kPressure)},
                               {{0.0, 100.0}, {400.0, 500.0}}};
  const std::vector<FloorTransit> one =
      Fused({pressure, {{Ride(200, 220, {}, 0.0, FloorSource::kLidar)}, {}}});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].start, 200.0);
  EXPECT_EQ(*one[0].climb, 4.0);
  const std::vector<FloorTransit> none = Fused({pressure, {{}, {}}});
  ASSERT_EQ(none.size(), 1U);
  EXPECT_EQ(none[0].start, 100.0);
  const std::vector<FloorTransit> two = Fused({pressure,
                                               {{Ride(150, 170, {}, 0.0, FloorSource::kLidar),
                                                 Ride(300, 320, {}, 0.0, FloorSource::kLidar)},
                                                {}}});
  ASSERT_EQ(two.size(), 2U);
  EXPECT_FALSE(two[0].climb);
}

}  // namespace
}  // namespace masked_mapper
