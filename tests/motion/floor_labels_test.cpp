// SPDX-License-Identifier: BSD-3-Clause
#include "motion/floor_labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

LabelledTimeline Timeline(const std::vector<FloorLabel>& labels,
                          const std::vector<FloorTransit>& transits = {},
                          const std::string& sensor = "", const WheelTrack& track = {}) {
  return TimelineOfLabels(labels, transits, sensor, track, {}, {});
}

TEST(FloorLabels, OnlyFileNamesAreAllowed) {
  for (const char* good : {"0", "-1", "EG", "B.2", "east_wing-3", "-", "..."}) {
    EXPECT_NO_THROW(CheckFloorLabel({1.0, good})) << good;
  }
  for (const std::string& bad :
       {std::string(), std::string("."), std::string(".."), std::string("a/b"), std::string("a b"),
        std::string("\xc3\xa4"), std::string("a\0b", 3), std::string(1000, 'x')}) {
    EXPECT_THROW(CheckFloorLabel({1.0, bad}), InputError) << bad;
  }
}

TEST(FloorLabels, SayFloorsAndTransits) {
  const FloorTimeline timeline =
      Timeline({{10, "1"}, {100, "-"}, {120, "3"}, {130, "3"}, {200, "-"}, {215, "1"}, {300, "-"}})
          .timeline;
  ASSERT_EQ(timeline.levels.size(), 2U);
  EXPECT_EQ(timeline.levels[0].label, "1");
  EXPECT_EQ(timeline.levels[1].label, "3");
  EXPECT_EQ(timeline.levels[1].elevation, 7.0);
  EXPECT_FALSE(timeline.levels[0].elevation_measured);
  EXPECT_FALSE(timeline.levels[1].elevation_measured);
  EXPECT_EQ(timeline.At(-1e9).level, 0U);
  EXPECT_FALSE(timeline.At(-1e9).in_transit);
  EXPECT_TRUE(timeline.At(100.0).in_transit);
  EXPECT_EQ(timeline.At(125.0).level, 1U);
  EXPECT_FALSE(timeline.At(199.9).in_transit);
  EXPECT_TRUE(timeline.At(210.0).in_transit);
  EXPECT_EQ(timeline.At(250.0).level, 0U);
  EXPECT_TRUE(timeline.At(1e9).in_transit);
}

TEST(FloorLabels, ALogMayBeginInTransit) {
  const FloorTimeline timeline = Timeline({{10, "-"}, {20, "EG"}}).timeline;
  EXPECT_TRUE(timeline.At(0.0).in_transit);
  EXPECT_FALSE(timeline.At(20.0).in_transit);
  EXPECT_EQ(timeline.levels[0].label, "EG");
}

TEST(FloorLabels, AFloorOfOneSecondIsAFloor) {
  const FloorTimeline timeline = Timeline({{0, "0"}, {100, "1"}, {101, "2"}}).timeline;
  ASSERT_EQ(timeline.levels.size(), 3U);
  EXPECT_EQ(timeline.At(100.5).level, 1U);
  EXPECT_EQ(timeline.At(102.0).level, 2U);
}

TEST(FloorLabels, HeightsComeFromTheSensor) {
  const LabelledTimeline labelled =
      Timeline({{0, "EG"}, {100, "-"}, {120, "OG"}, {200, "-"}, {220, "EG"}},
               {{95, 110, 125, 4.3, 0.1}, {195, 210, 222, -4.1, 0.1}}, "pressure");
  EXPECT_NEAR(labelled.timeline.levels[1].elevation, 4.2, 1e-9);
  EXPECT_TRUE(labelled.timeline.levels[1].elevation_measured);
  EXPECT_TRUE(labelled.timeline.levels[0].elevation_measured);
  EXPECT_TRUE(labelled.warnings.empty());
  // The labels' own times stand.
  EXPECT_FALSE(labelled.timeline.At(97.0).in_transit);
  EXPECT_FALSE(labelled.timeline.At(121.0).in_transit);
}

TEST(FloorLabels, LateLabelsTakeTheTransitsOfTheSensor) {
  const FloorTimeline timeline =
      Timeline({{0, "0"}, {140, "1"}}, {{95, 110, 125, 3.4, 0.1}}, "pressure").timeline;
  EXPECT_FALSE(timeline.At(94.0).in_transit);
  EXPECT_TRUE(timeline.At(96.0).in_transit);
  EXPECT_FALSE(timeline.At(126.0).in_transit);
  EXPECT_EQ(timeline.At(126.0).level, 1U);
}

TEST(FloorLabels, WithoutASensorAChangeLastsWhileTheWheelsRest) {
  WheelTrack track;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.1 * i;
    track.Observe({t, {t < 90.0 ? t : std::max(90.0, t - 30.0), 0.0, 0.0}});
  }
  const FloorTimeline timeline = Timeline({{0, "0"}, {118, "1"}}, {}, "", track).timeline;
  EXPECT_FALSE(timeline.At(89.0).in_transit);
  EXPECT_TRUE(timeline.At(95.0).in_transit);
  EXPECT_TRUE(timeline.At(119.0).in_transit);
  EXPECT_FALSE(timeline.At(121.0).in_transit);
}

TEST(FloorLabels, WinOverPressureAndSaySoOnce) {
  // Pressure sees a ride inside floor 0 and none between 1 and 2.
  const LabelledTimeline labelled =
      Timeline({{0, "0"}, {300, "-"}, {320, "1"}, {400, "2"}},
               {{100, 110, 120, 3.5, 0.1}, {300, 310, 320, 3.5, 0.1}}, "pressure");
  EXPECT_EQ(labelled.timeline.At(200.0).level, 0U);
  EXPECT_EQ(labelled.timeline.At(500.0).level, 2U);
  ASSERT_EQ(labelled.timeline.levels.size(), 3U);
  EXPECT_FALSE(labelled.timeline.levels[2].elevation_measured);
  EXPECT_NEAR(labelled.timeline.levels[2].elevation, 7.0, 1e-9);
  ASSERT_EQ(labelled.warnings.size(), 1U);
  EXPECT_NE(labelled.warnings[0].find("2 times"), std::string::npos) << labelled.warnings[0];
  EXPECT_NE(labelled.warnings[0].find("100.000 s"), std::string::npos) << labelled.warnings[0];
}

TEST(FloorLabels, IntervalsStayInOrderWhateverIsClaimed) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<FloorLabel> labels = {{0.0, "0"}};
    double stamp = 0.0;
    for (int k = 0; k < 12; ++k) {
      stamp += static_cast<double>(random() % 60);
      labels.push_back({stamp, random() % 4 == 0 ? "-" : std::to_string(random() % 4)});
    }
    std::vector<FloorTransit> transits;
    stamp = 0.0;
    for (int k = 0; k < 6; ++k) {
      stamp += static_cast<double>(random() % 100);
      transits.push_back({stamp, stamp + 10.0, stamp + 30.0,
                          3.5 * (static_cast<double>(random() % 5) - 2.0), 0.1});
      stamp += 30.0;
    }
    const FloorTimeline timeline = Timeline(labels, transits, "pressure").timeline;
    for (std::size_t i = 0; i < timeline.intervals.size(); ++i) {
      ASSERT_LT(timeline.intervals[i].level, timeline.levels.size());
      if (i > 0) {
        ASSERT_GE(timeline.intervals[i].start, timeline.intervals[i - 1].start) << trial;
      }
    }
  }
}

TEST(FloorLabels, MoreFloorsThanAnyBuildingAreRefused) {
  std::vector<FloorLabel> labels;
  for (int k = 0; k < 2000; ++k) labels.push_back({1.0 * k, std::to_string(k)});
  EXPECT_THROW(Timeline(labels), InputError);
}

TEST(FloorLabels, OneWrongClimbDoesNotMoveTheFloors) {
  std::vector<FloorLabel> labels;
  std::vector<FloorTransit> transits;
  for (int k = 0; k < 8; ++k) {
    labels.push_back({100.0 * k, k % 2 == 0 ? "0" : "1"});
    if (k > 0)
      transits.push_back({100.0 * k - 5, 100.0 * k - 2, 100.0 * k, k % 2 == 0 ? -3.5 : 3.5, 0.1});
  }
  transits[3].climb = 3.5;  // to floor 0, which is below
  const LabelledTimeline labelled = Timeline(labels, transits, "pressure");
  EXPECT_NEAR(labelled.timeline.levels[1].elevation, 3.5, 1e-9);
  EXPECT_EQ(labelled.warnings.size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
