// SPDX-License-Identifier: BSD-3-Clause
#include "motion/wheel_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

/// 10 s at rest, 10 m in 10 s, 20 s of turning on the spot with some slip, 10 m in 10 s, rest.
WheelTrack StopAndGo() {
  WheelTrack track;
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.1 * i;
    Pose2 pose;
    pose.x = std::clamp(t - 10.0, 0.0, 10.0) + std::clamp(t - 40.0, 0.0, 10.0);
    if (t > 20.0 && t < 40.0) pose.y = 0.1 * std::sin(t - 20.0);
    pose.theta = t;
    track.Observe({t, pose});
  }
  return track;
}

TEST(WheelTrack, WithoutReadingsTheRobotMayBeAnywhere) {
  const WheelTrack track;
  EXPECT_FALSE(track.Travels());
  EXPECT_EQ(track.Travel(0.0, 10.0), 0.0);
  EXPECT_TRUE(std::isinf(track.StayAround(5.0, 0.5).Duration()));
  EXPECT_TRUE(track.Stays(0.5, 1.0).empty());
}

TEST(WheelTrack, ARobotThatGetsNowhereHasNoWheels) {
  WheelTrack track;
  for (int i = 0; i < 100; ++i) track.Observe({1.0 * i, {0.001 * (i % 3), 0.0, 0.1}});
  EXPECT_FALSE(track.Travels());
}

TEST(WheelTrack, MeasuresTravelBetweenAnyTwoMoments) {
  const WheelTrack track = StopAndGo();
  EXPECT_TRUE(track.Travels());
  EXPECT_NEAR(track.Travel(0.0, 10.0), 0.0, 1e-9);
  EXPECT_NEAR(track.Travel(12.5, 17.25), 4.75, 0.03);
  EXPECT_NEAR(track.Travel(-5.0, 19.9), 9.9, 0.03);
}

TEST(WheelTrack, AStayLastsFromTravelToTravel) {
  const WheelTrack track = StopAndGo();
  const TimeSpan stay = track.StayAround(30.0, 0.5);
  EXPECT_NEAR(stay.start, 19.5, 0.15);
  EXPECT_NEAR(stay.end, 40.5, 0.15);
}

TEST(WheelTrack, AStayAtAnEndOfTheLogHasNoEnd) {
  const WheelTrack track = StopAndGo();
  EXPECT_EQ(track.StayAround(5.0, 0.5).start, -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(track.StayAround(5.0, 0.5).end, 10.5, 0.15);
  EXPECT_EQ(track.StayAround(58.0, 0.5).end, std::numeric_limits<double>::infinity());
}

TEST(WheelTrack, FindsTheLongestStayOfASpan) {
  const WheelTrack track = StopAndGo();
  const TimeSpan stay = track.LongestStay(8.0, 45.0, 0.5);
  EXPECT_NEAR(stay.start, 19.5, 0.5);
  EXPECT_NEAR(stay.end, 40.5, 0.5);
}

TEST(WheelTrack, FallsApartIntoStays) {
  const std::vector<TimeSpan> stays = StopAndGo().Stays(0.5, 5.0);
  ASSERT_EQ(stays.size(), 3U);
  EXPECT_NEAR(stays[1].start, 19.7, 0.4);
  EXPECT_NEAR(stays[1].end, 40.3, 0.4);
}

TEST(WheelTrack, LeavesOutWhatIsNoReading) {
  WheelTrack track = StopAndGo();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  track.Observe({nan, {0.0, 0.0, 0.0}});
  track.Observe({100.0, {nan, 0.0, 0.0}});
  track.Observe({3.0, {500.0, 0.0, 0.0}});
  EXPECT_NEAR(track.Travel(0.0, 200.0), StopAndGo().Travel(0.0, 200.0), 1e-9);
}

}  // namespace
}  // namespace masked_mapper
