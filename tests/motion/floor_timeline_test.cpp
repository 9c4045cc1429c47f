// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(FloorTimeline, WithoutAnythingKnownThereIsOneFloorForEver) {
  const FloorTimeline timeline;
  for (const double stamp : {-1e9, 0.0, 1e12}) {
    EXPECT_EQ(timeline.At(stamp).level, 0U);
    EXPECT_FALSE(timeline.At(stamp).in_transit);
  }
}

TEST(FloorTimeline, IntervalsBeginAtTheirStart) {
  FloorTimeline timeline;
  timeline.levels.resize(2);
  timeline.intervals = {{10.0, 0, false}, {20.0, 0, true}, {30.0, 1, false}};
  EXPECT_FALSE(timeline.At(5.0).in_transit);
  EXPECT_FALSE(timeline.At(19.999).in_transit);
  EXPECT_TRUE(timeline.At(20.0).in_transit);
  EXPECT_EQ(timeline.At(29.0).level, 0U);
  EXPECT_EQ(timeline.At(30.0).level, 1U);
  EXPECT_EQ(timeline.At(1e9).level, 1U);
}

TEST(FloorNames, CountFromTheFirstFloorOfTheLog) {
  std::vector<FloorLevel> levels(4);
  levels[1].elevation = -3.5;
  levels[2].elevation = 7.0;
  levels[3].elevation = 3.4;
  EXPECT_EQ(FloorNames(levels), (std::vector<std::string>{"0", "-1", "2", "1"}));
}

TEST(FloorNames, LabelsWinAndAreNotTakenTwice) {
  std::vector<FloorLevel> levels(3);
  levels[0].label = "1";
  levels[1].elevation = 3.5;
  levels[2].elevation = 7.0;
  EXPECT_EQ(FloorNames(levels), (std::vector<std::string>{"1", "1_", "2"}));
}

TEST(NoteTravel, GivesTheWholeWayToEveryIntervalOfATransit) {
  FloorTimeline timeline;
  timeline.levels.resize(2);
  timeline.intervals = {
      {-1e300, 0, false}, {10.0, 0, true}, {15.0, 1, true}, {20.0, 1, false}, {30.0, 1, true}};
  std::vector<TravelledWay> way;
  for (int i = 0; i <= 40; ++i) way.push_back({1.0 * i, 0.5 * i});
  NoteTravel(way, timeline);
  EXPECT_DOUBLE_EQ(timeline.intervals[0].travelled_m, 0.0);
  EXPECT_DOUBLE_EQ(timeline.intervals[1].travelled_m, 5.0);
  EXPECT_DOUBLE_EQ(timeline.intervals[2].travelled_m, 5.0);
  EXPECT_DOUBLE_EQ(timeline.intervals[3].travelled_m, 0.0);
  EXPECT_DOUBLE_EQ(timeline.intervals[4].travelled_m, 5.0) << "to the end of the log";
}

TEST(NoteTravel, WithoutWheelsNothingTravels) {
  FloorTimeline timeline;
  timeline.intervals = {{0.0, 0, true}};
  NoteTravel({}, timeline);
  EXPECT_DOUBLE_EQ(timeline.intervals[0].travelled_m, 0.0);
}

}  // namespace
}  // namespace masked_mapper
