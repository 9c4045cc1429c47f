// SPDX-License-Identifier: BSD-3-Clause
#include "log/stamp_mender.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

OdometryReading Odometry(double stamp, double x = 0.0) { return {stamp, {x, 0.0, 0.0}}; }
PressureReading Pressure(double stamp) { return {stamp, 1e5}; }

std::vector<Observation> Drain(StampMender* mender) {
  std::vector<Observation> result;
  mender->Finish();
  while (std::optional<Observation> next = mender->Next()) result.push_back(*next);
  return result;
}

std::vector<double> Mended(const std::vector<Observation>& observations, StampMender* mender) {
  for (const Observation& observation : observations) mender->Add(observation);
  std::vector<double> stamps;
  for (const Observation& observation : Drain(mender)) stamps.push_back(Stamp(observation));
  return stamps;
}

void ExpectStamps(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(StampMenderTest, LeavesGoodStampsAlone) {
  StampMender mender;
  ExpectStamps(Mended({Odometry(1.0), Pressure(1.0), Odometry(2.0)}, &mender), {1.0, 1.0, 2.0});
  EXPECT_EQ(mender.jumps(), 0U);
  EXPECT_EQ(mender.reordered(), 0U);
}

TEST(StampMenderTest, MergesKindsThatComeLate) {
  StampMender mender;
  ExpectStamps(
      Mended({Odometry(1.0), Odometry(1.2), Pressure(1.1), Odometry(1.4), Pressure(1.3)}, &mender),
      {1.0, 1.1, 1.2, 1.3, 1.4});
  EXPECT_EQ(mender.jumps(), 0U);
  EXPECT_EQ(mender.reordered(), 2U);
}

TEST(StampMenderTest, HandsOutWhatNothingCanOvertake) {
  StampMender mender;
  mender.Add(Odometry(1.0));
  EXPECT_FALSE(mender.Next());
  mender.Add(Odometry(7.0));
  EXPECT_EQ(Stamp(*mender.Next()), 1.0);
  EXPECT_FALSE(mender.Next());
}

TEST(StampMenderTest, HoldsSmallBackwardSteps) {
  StampMender mender;
  ExpectStamps(Mended({Odometry(1.0), Odometry(1.5), Odometry(1.3), Odometry(1.6)}, &mender),
               {1.0, 1.5, 1.5, 1.6});
  EXPECT_EQ(mender.jumps(), 1U);
}

TEST(StampMenderTest, UnwrapsAMicrosecondCounterTwice) {
  constexpr double kWrap = 4294.967296;
  StampMender mender;
  std::vector<Observation> observations;
  std::vector<double> expected;
  for (int i = 0; i < 1000; ++i) {
    const double true_stamp = 4000.0 + 10.0 * i;
    observations.emplace_back(Odometry(std::fmod(true_stamp, kWrap)));
    expected.push_back(true_stamp);
  }
  ExpectStamps(Mended(observations, &mender), expected);
  EXPECT_EQ(mender.jumps(), 3U);
}

TEST(StampMenderTest, StragglersFromBeforeAWrapStayBefore) {
  constexpr double kWrap = 4294.967296;
  StampMender mender;
  ExpectStamps(Mended({Odometry(4294.0), Pressure(4294.0), Odometry(0.05), Pressure(4294.5),
                       Odometry(0.15), Pressure(0.1)},
                      &mender),
               {4294.0, 4294.0, 4294.5, kWrap + 0.05, kWrap + 0.1, kWrap + 0.15});
  EXPECT_EQ(mender.jumps(), 1U);
}

TEST(StampMenderTest, HoldsSingleStampsFarOff) {
  for (const double far_off : {0.0, -5e8, 9e9, 960.0}) {
    StampMender mender;
    ExpectStamps(Mended({Odometry(1000.0), Odometry(1000.1), Odometry(far_off), Odometry(1000.2),
                         Odometry(1000.3)},
                        &mender),
                 {1000.0, 1000.1, 1000.1, 1000.2, 1000.3});
    EXPECT_EQ(mender.jumps(), 1U) << far_off;
  }
}

TEST(StampMenderTest, GoesOnWhenTheClockIsSetBack) {
  StampMender mender;
  ExpectStamps(Mended({Odometry(1000.0), Odometry(1000.1), Odometry(500.0), Odometry(500.1),
                       Odometry(500.2), Odometry(500.3)},
                      &mender),
               {1000.0, 1000.1, 1000.2, 1000.3, 1000.4, 1000.5});
  EXPECT_EQ(mender.jumps(), 1U);
}

TEST(StampMenderTest, BelievesAPause) {
  StampMender mender;
  ExpectStamps(Mended({Odometry(9.9), Odometry(10.0), Odometry(10.1), Odometry(5000.0),
                       Odometry(5000.1), Odometry(5000.2)},
                      &mender),
               {9.9, 10.0, 10.1, 5000.0, 5000.1, 5000.2});
  EXPECT_EQ(mender.jumps(), 0U);
}

TEST(StampMenderTest, WrongStampsAtTheVeryBeginningAreMovedToTheRest) {
  StampMender mender;
  ExpectStamps(
      Mended({Odometry(0.0), Odometry(1e9), Odometry(1e9 + 0.1), Odometry(1e9 + 0.2)}, &mender),
      {1e9, 1e9, 1e9 + 0.1, 1e9 + 0.2});
  EXPECT_EQ(mender.jumps(), 1U);
}

TEST(StampMenderTest, KeepsTheOrderOfOneKindAndLosesNothing) {
  // Stamps all over the place: whatever comes out is in order and complete.
  std::uint32_t state = 12345;
  for (int round = 0; round < 50; ++round) {
    StampMender mender;
    std::vector<Observation> observations;
    for (int i = 0; i < 300; ++i) {
      state = state * 1664525U + 1013904223U;
      const double jitter = static_cast<double>(state >> 8U) / 16777216.0;
      const double scale = std::pow(10.0, static_cast<double>(state % 12U) - 4.0);
      observations.emplace_back(Odometry(0.1 * i + jitter * scale, i));
    }
    for (const Observation& observation : observations) mender.Add(observation);
    const std::vector<Observation> mended = Drain(&mender);
    ASSERT_EQ(mended.size(), observations.size());
    for (std::size_t i = 0; i < mended.size(); ++i) {
      EXPECT_EQ(std::get<OdometryReading>(mended[i]).T_odom_robot.x, static_cast<double>(i));
      EXPECT_GE(Stamp(mended[i]), Stamp(mended[i > 0 ? i - 1 : 0]));
    }
  }
}

TEST(StampMenderTest, BoundsWhatItHoldsBack) {
  StampMender mender;
  int out = 0;
  for (int i = 0; i < 10000; ++i) {
    mender.Add(Odometry(0.0));
    while (mender.Next()) ++out;
  }
  EXPECT_GE(out, 10000 - 4096);
}

}  // namespace
}  // namespace masked_mapper
