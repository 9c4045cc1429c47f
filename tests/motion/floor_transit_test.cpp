// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Rides of 20 s every 100 s with these climbs.
std::vector<FloorTransit> Rides(const std::vector<double>& climbs) {
  std::vector<FloorTransit> transits;
  for (std::size_t k = 0; k < climbs.size(); ++k) {
    const double start = 100.0 * static_cast<double>(k + 1);
    transits.push_back({start, start + 12.0, start + 20.0, climbs[k], 0.1});
  }
  return transits;
}

TEST(EstimateLevelHeights, IsTheLeastSquaresSolution) {
  // Two ways to level 2: 3 + 4 with variance 2, and 7.6 with variance 1.
  const std::vector<LevelHeight> heights =
      EstimateLevelHeights(3, {{0, 1, 3.0, 1.0}, {1, 2, 4.0, 1.0}, {0, 2, 7.6, 1.0}});
  EXPECT_NEAR(heights[2].elevation, (7.0 / 2.0 + 7.6) / 1.5, 1e-12);
  EXPECT_NEAR(heights[2].sigma, std::sqrt(1.0 / 1.5), 1e-12);
  EXPECT_EQ(heights[0].elevation, 0.0);
  EXPECT_EQ(heights[0].sigma, 0.0);
}

TEST(EstimateLevelHeights, SigmaIsThatOfManyTrials) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.2);
  double squares = 0.0;
  double sigma = 0.0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::vector<LevelHeight> heights =
        EstimateLevelHeights(3, {{0, 1, 3.0 + noise(random), 0.2},
                                 {1, 2, 3.0 + noise(random), 0.2},
                                 {2, 0, -6.0 + noise(random), 0.2}});
    squares += std::pow(heights[2].elevation - 6.0, 2) / 2000.0;
    sigma = heights[2].sigma;
  }
  EXPECT_NEAR(std::sqrt(squares), sigma, 0.01);
}

TEST(EstimateLevelHeights, WhatNoStepReachesIsNotMeasured) {
  const std::vector<LevelHeight> heights =
      EstimateLevelHeights(4, {{0, 1, 3.0, 0.1}, {2, 3, 4.0, 0.1}});
  EXPECT_TRUE(heights[0].measured);
  EXPECT_TRUE(heights[1].measured);
  EXPECT_FALSE(heights[2].measured);
  EXPECT_FALSE(heights[3].measured);
  EXPECT_TRUE(EstimateLevelHeights(0, {}).empty());
}

TEST(TimelineOfTransits, AFloorMetAgainIsTheOneItWas) {
  const FloorTimeline timeline =
      TimelineOfTransits(Rides({3.6, 3.4, -7.1, 7.0, -3.3, -3.7, -3.0}), {});
  ASSERT_EQ(timeline.levels.size(), 4U);
  const std::size_t expected[] = {0, 1, 2, 0, 2, 1, 0, 3};
  for (std::size_t k = 0; k < 8; ++k) {
    const FloorInterval& interval = timeline.At(100.0 * static_cast<double>(k) + 50.0);
    EXPECT_EQ(interval.level, expected[k]) << "after ride " << k;
    EXPECT_FALSE(interval.in_transit);
    if (k < 7) {
      EXPECT_TRUE(timeline.At(100.0 * static_cast<double>(k) + 110.0).in_transit);
    }
  }
  EXPECT_NEAR(timeline.levels[1].elevation, 3.5, 0.2);
  EXPECT_NEAR(timeline.levels[3].elevation, -3.0, 0.05);
  EXPECT_TRUE(timeline.levels[3].elevation_measured);
  EXPECT_EQ(FloorNames(timeline.levels), (std::vector<std::string>{"0", "1", "2", "-1"}));
}

TEST(TransitsOf, AreThoseThatTheTimelineWasMadeOf) {
  std::vector<FloorTransit> transits = Rides({3.6, 3.4, -7.1});
  transits[1].climb.reset();
  transits[2].by.Add(FloorSource::kLidar);
  for (std::size_t count = 0; count <= transits.size(); ++count) {
    const std::vector<FloorTransit> first(
        transits.begin(), std::next(transits.begin(), static_cast<std::ptrdiff_t>(count)));
    const std::vector<FloorTransit> found = TransitsOf(TimelineOfTransits(first, {}));
    ASSERT_EQ(found.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(found[i].start, transits[i].start);
      EXPECT_EQ(found[i].middle, transits[i].middle);
      EXPECT_EQ(found[i].end, transits[i].end);
      EXPECT_EQ(found[i].climb, transits[i].climb);
      EXPECT_EQ(found[i].by.bits, transits[i].by.bits);
    }
  }
}

TEST(TransitsOf, OneThatTheLogBeginsOrEndsInIsKept) {
  std::vector<FloorTransit> transits = Rides({3.6, 3.4, -7.1});
  transits.front().start = -kInfinity;
  transits.back().end = kInfinity;
  const FloorTimeline timeline = TimelineOfTransits(transits, {});
  const FloorTimeline again = TimelineOfTransits(TransitsOf(timeline), {});
  ASSERT_EQ(again.intervals.size(), timeline.intervals.size());
  for (std::size_t i = 0; i < again.intervals.size(); ++i) {
    EXPECT_EQ(again.intervals[i].start, timeline.intervals[i].start);
    EXPECT_EQ(again.intervals[i].level, timeline.intervals[i].level);
    EXPECT_EQ(again.intervals[i].in_transit, timeline.intervals[i].in_transit);
  }
}

TEST(TimelineOfTransits, HalfWayTheOtherFloorIsNearer) {
  const FloorTimeline timeline = TimelineOfTransits(Rides({3.5}), {});
  EXPECT_EQ(timeline.At(111.0).level, 0U);
  EXPECT_EQ(timeline.At(113.0).level, 1U);
  EXPECT_TRUE(timeline.At(113.0).in_transit);
}

TEST(TimelineOfTransits, ErrorsDoNotAddUpOverAThousandRides) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.15);
  std::vector<double> climbs;
  std::vector<int> floors = {0};
  for (int k = 0; k < 1000; ++k) {
    int next = static_cast<int>(random() % 20);
    if (next == floors.back()) next = (next + 1) % 20;
    climbs.push_back(2.6 * (next - floors.back()) + noise(random));
    floors.push_back(next);
  }
  const FloorTimeline timeline = TimelineOfTransits(Rides(climbs), {});
  ASSERT_EQ(timeline.levels.size(), 20U);
  for (std::size_t k = 0; k < floors.size(); ++k) {
    const FloorLevel& level =
        timeline.levels[timeline.At(100.0 * static_cast<double>(k) + 50.0).level];
    EXPECT_NEAR(level.elevation, 2.6 * floors[k], 0.2) << "m after ride " << k;
  }
}

TEST(TimelineOfTransits, ARideThatComesBackLeavesTheFloorAsItIs) {
  const FloorTimeline timeline = TimelineOfTransits(Rides({0.3, 3.5}), {});
  ASSERT_EQ(timeline.levels.size(), 2U);
  EXPECT_TRUE(timeline.At(110.0).in_transit);
  EXPECT_EQ(timeline.At(150.0).level, 0U);
}

TEST(TimelineOfTransits, ALogMayBeginAndEndBetweenFloors) {
  std::vector<FloorTransit> transits = Rides({3.5, 3.5, 3.5});
  transits.front().start = -kInfinity;
  transits.back().end = kInfinity;
  const FloorTimeline timeline = TimelineOfTransits(transits, {});
  ASSERT_EQ(timeline.levels.size(), 2U);
  EXPECT_TRUE(timeline.At(-1e9).in_transit);
  EXPECT_FALSE(timeline.At(150.0).in_transit);
  EXPECT_EQ(timeline.At(150.0).level, 0U);
  EXPECT_EQ(timeline.At(250.0).level, 1U);
  EXPECT_TRUE(timeline.At(1e9).in_transit);
}

TEST(TimelineOfTransits, ALogWhollyInACabIsAllTransit) {
  const FloorTimeline timeline = TimelineOfTransits({{-kInfinity, 0.0, kInfinity, 3.5, 0.1}}, {});
  ASSERT_EQ(timeline.levels.size(), 1U);
  EXPECT_TRUE(timeline.At(0.0).in_transit);
}

TEST(TimelineOfTransits, NoiseMakesNoEndlessTower) {
  std::mt19937 random(9);
  std::vector<double> climbs;
  for (int k = 0; k < 3000; ++k) climbs.push_back(static_cast<double>(random() % 100000) - 5e4);
  EXPECT_LE(TimelineOfTransits(Rides(climbs), {}).levels.size(), 200U);
}

TEST(TimelineOfTransits, UnknownClimbsOpenLevelsThatMayBeAny) {
  std::vector<FloorTransit> transits = Rides({0.0, 0.0});
  for (FloorTransit& transit : transits) transit.climb.reset();
  const FloorTimeline timeline = TimelineOfTransits(transits, {});
  ASSERT_EQ(timeline.levels.size(), 3U);
  EXPECT_TRUE(timeline.levels[0].identity_known);
  EXPECT_FALSE(timeline.levels[1].identity_known);
  EXPECT_FALSE(timeline.levels[2].identity_known);
  EXPECT_FALSE(timeline.levels[2].elevation_measured);
  EXPECT_NEAR(timeline.levels[1].elevation, 3.5, 1e-12);
  EXPECT_NEAR(timeline.levels[2].elevation, 7.0, 1e-12);
}

TEST(TimelineOfTransits, BehindAnUnknownClimbHeightsCountFromALevelOfTheirOwn) {
  std::vector<FloorTransit> transits = Rides({0.0, 3.0, 4.0, -4.0});
  transits[0].climb.reset();
  const FloorTimeline timeline = TimelineOfTransits(transits, {});
  ASSERT_EQ(timeline.levels.size(), 4U);
  for (std::size_t level = 1; level < 4; ++level) {
    EXPECT_FALSE(timeline.levels[level].identity_known);
    EXPECT_FALSE(timeline.levels[level].elevation_measured);
  }
  EXPECT_NEAR(timeline.levels[1].elevation, 3.5, 1e-9);
  EXPECT_NEAR(timeline.levels[2].elevation, 6.5, 1e-9);
  EXPECT_NEAR(timeline.levels[3].elevation, 10.5, 1e-9);
  EXPECT_EQ(timeline.At(450.0).level, 2U);
  const std::vector<FloorChange> changes = ChangesOf(timeline);
  ASSERT_EQ(changes.size(), 4U);
  EXPECT_FALSE(changes[0].climb);
  EXPECT_NEAR(*changes[1].climb, 3.0, 1e-9);
  EXPECT_NEAR(changes[1].height_m, 3.0, 1e-9);
  EXPECT_LT(changes[1].sigma_m, 1.0) << "measured there, whatever is known of the first";
}

}  // namespace
}  // namespace masked_mapper
