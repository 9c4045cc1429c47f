// SPDX-License-Identifier: BSD-3-Clause
#include "localization/ride_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

/// Up, m, at a time: flights of 2.1 m in 12 s, with a landing of 12 s between them.
double HeightOnStairs(double t, double first_flight) {
  const double flight = 2.1;
  const double one = std::clamp((t - first_flight) / 12.0, 0.0, 1.0);
  const double two = std::clamp((t - first_flight - 24.0) / 12.0, 0.0, 1.0);
  return flight * (one + two);
}

/// What was told as over, summed up.
double ToldClimb(bool rides) {
  RideWatch watch{FloorOptions{}};
  double told = 0.0;
  for (int i = 0; i < 200 * 5; ++i) {
    const double t = 0.2 * i;
    const double height = rides ? HeightOnStairs(t, 80.0) : 0.0;
    const double noise = 1.5 * std::sin(1.7 * i) + 1.1 * std::cos(3.1 * i);
    watch.Observe(PressureReading{t, 101325.0 * std::exp(-height / 8430.0) + noise});
    watch.Observe(OdometryReading{t, Pose2{0.3 * t, 0.0, 0.0}});
    watch.NotePose({0.3 * t, 0.0, 0.0});
    if (!watch.IsDue()) continue;
    const std::optional<RideNews> news = watch.News();
    if (news && news->is_over && news->climb_m) told += *news->climb_m;
  }
  return told;
}

TEST(RideWatch, TellsAllOfAClimbWithALanding) { EXPECT_NEAR(ToldClimb(true), 4.2, 0.6); }

TEST(RideWatch, TellsNothingOnOneFloor) { EXPECT_DOUBLE_EQ(ToldClimb(false), 0.0); }

}  // namespace
}  // namespace masked_mapper
