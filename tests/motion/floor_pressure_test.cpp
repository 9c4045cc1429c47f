// SPDX-License-Identifier: BSD-3-Clause
#include "motion/floor_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/floor_checks.hpp"
#include "motion/synthetic_drive.hpp"

namespace masked_mapper {
namespace {

FloorTimeline Timeline(const std::vector<PressureReading>& pressure, const WheelTrack& track) {
  const StoreyOptions storeys;
  return TimelineOfTransits(TransitsOfPressure(HeightsOf(pressure), track, {}, storeys), storeys);
}

void ExpectRight(const FloorTimeline& timeline, const SyntheticDrive& drive, std::size_t levels) {
  const FloorScore score = ScoreFloors(timeline, drive);
  EXPECT_EQ(score.levels, levels);
  EXPECT_GE(score.right_share, 0.999);
  EXPECT_EQ(score.transits_missed, 0);
  EXPECT_LT(score.worst_elevation, 0.3) << "m";
}

TEST(FloorPressure, AnyRateWillDo) {
  for (const double rate : {0.2, 0.5, 1.0, 2.0, 5.0, 50.0}) {
    SCOPED_TRACE(std::to_string(rate) + " Hz");
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const SyntheticDrive drive = FourFloors(seed, 120.0);
      SyntheticBarometer barometer;
      barometer.rate = rate;
      ExpectRight(Timeline(barometer.Read(drive, seed), TrackOf(drive)), drive, 4);
    }
  }
}

TEST(FloorPressure, APerfectBarometerTellsTheSame) {
  const SyntheticDrive drive = FourFloors(1, 120.0);
  SyntheticBarometer barometer;
  barometer.sigma = 0.0;
  barometer.weather = 0.0;
  const FloorTimeline timeline = Timeline(barometer.Read(drive, 1), TrackOf(drive));
  ExpectRight(timeline, drive, 4);
  EXPECT_LT(ScoreFloors(timeline, drive).worst_elevation, 0.04) << "m";
}

TEST(FloorPressure, WithoutWheelsTheHeightsAloneTellWhen) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SyntheticDrive drive = FourFloors(seed, 120.0);
    ExpectRight(Timeline(SyntheticBarometer{}.Read(drive, seed), WheelTrack{}), drive, 4);
  }
}

TEST(FloorPressure, WeatherMakesNoFloors) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SyntheticDrive drive({0.0, 3.5}, 0, seed);
    drive.Roam(9000.0);
    SyntheticBarometer storm;
    storm.weather = 15.0;
    EXPECT_EQ(Timeline(storm.Read(drive, seed), TrackOf(drive)).intervals.size(), 1U) << seed;
    EXPECT_EQ(Timeline(storm.Read(drive, seed), WheelTrack{}).intervals.size(), 1U) << seed;
  }
}

TEST(FloorPressure, ADoorThatChangesThePressureIsNoFloor) {
  SyntheticDrive drive({0.0, 3.5}, 0, 4);
  drive.Roam(300.0);
  std::vector<PressureReading> readings = SyntheticBarometer{}.Read(drive, 4);
  // While the robot drives from 3 m before to 3 m behind it.
  double start = 100.0;
  const WheelTrack track = TrackOf(drive);
  while (track.Travel(start - 5.0, start + 5.0) < 5.9) start += 1.0;
  for (PressureReading& reading : readings) {
    if (reading.stamp > start) reading.pressure_pa -= 40.0;
  }
  EXPECT_EQ(Timeline(readings, track).intervals.size(), 1U);
}

TEST(FloorPressure, TransitIsTheTimeInTheClosedCab) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SyntheticDrive drive = FourFloors(seed, 120.0);
    const FloorScore score =
        ScoreFloors(Timeline(SyntheticBarometer{}.Read(drive, seed), TrackOf(drive)), drive);
    EXPECT_EQ(score.cab_share, 1.0);
    EXPECT_LT(score.lost_share, 0.08);
  }
}

TEST(FloorPressure, StairsAreTransitWithMotion) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SyntheticDrive drive({0.0, 3.5, 7.0}, 0, seed);
    drive.Roam(100.0);
    for (const std::size_t floor : {1U, 2U, 1U, 0U}) {
      drive.TakeStairs(floor);
      drive.Roam(100.0);
    }
    const FloorTimeline timeline = Timeline(SyntheticBarometer{}.Read(drive, seed), TrackOf(drive));
    ExpectRight(timeline, drive, 3);
    const FloorScore score = ScoreFloors(timeline, drive);
    EXPECT_GT(score.cab_share, 0.9) << seed;
    EXPECT_LT(score.lost_share, 0.03) << seed;
  }
}

TEST(FloorPressure, AStopOfACabThatTheRobotDoesNotLeaveIsNoFloor) {
  SyntheticDrive drive({0.0, 3.5, 7.0, 10.5}, 0, 3);
  drive.Roam(100.0);
  drive.EnterCab();
  drive.RideTo(1);
  drive.Rest(12.0);
  drive.RideTo(3);
  drive.Rest(1.0);
  drive.RideTo(2);
  drive.LeaveCab();
  drive.Roam(100.0);
  const FloorTimeline timeline = Timeline(SyntheticBarometer{}.Read(drive, 3), TrackOf(drive));
  ExpectRight(timeline, drive, 2);
  EXPECT_EQ(timeline.intervals.size(), 4U);
}

TEST(FloorPressure, ARideThatComesBackIsATransitToTheSameFloor) {
  SyntheticDrive drive({0.0, 3.5, 7.0}, 0, 3);
  drive.Roam(100.0);
  drive.EnterCab();
  drive.RideTo(2);
  drive.Rest(10.0);
  drive.RideTo(0);
  drive.LeaveCab();
  drive.Roam(100.0);
  const FloorTimeline timeline = Timeline(SyntheticBarometer{}.Read(drive, 3), TrackOf(drive));
  ExpectRight(timeline, drive, 1);
  EXPECT_EQ(timeline.intervals.size(), 3U);
}

TEST(FloorPressure, ALogMayBeginAndEndInTheElevator) {
  SyntheticDrive drive({0.0, 3.5, 7.0}, 0, 5);
  drive.RideTo(1);
  drive.LeaveCab();
  drive.Roam(200.0);
  drive.EnterCab();
  drive.RideTo(2);
  const FloorTimeline timeline = Timeline(SyntheticBarometer{}.Read(drive, 5), TrackOf(drive));
  ASSERT_EQ(timeline.levels.size(), 1U);
  ASSERT_EQ(timeline.intervals.size(), 3U);
  EXPECT_TRUE(timeline.At(0.0).in_transit);
  EXPECT_FALSE(timeline.At(100.0).in_transit);
  EXPECT_TRUE(timeline.At(1e9).in_transit);
}

TEST(FloorPressure, ALogMayBeginAndEndInMidRide) {
  const SyntheticDrive whole = FourFloors(6, 120.0);
  const double begin = 0.5 * (whole.rides().front().start + whole.rides().front().end);
  const double end = 0.5 * (whole.rides().back().start + whole.rides().back().end);
  WheelTrack track;
  for (const SyntheticDrive::State& state : whole.states()) {
    if (state.stamp < begin || state.stamp > end) continue;
    track.Observe({state.stamp, state.T_odom_robot});
  }
  std::vector<PressureReading> readings;
  for (const PressureReading& reading : SyntheticBarometer{}.Read(whole, 6)) {
    if (reading.stamp >= begin && reading.stamp <= end) readings.push_back(reading);
  }
  const FloorTimeline timeline = Timeline(readings, track);
  EXPECT_EQ(timeline.levels.size(), 4U);
  EXPECT_TRUE(timeline.At(begin).in_transit);
  EXPECT_FALSE(timeline.At(begin + 60.0).in_transit);
  EXPECT_EQ(timeline.At(begin + 60.0).level, 0U);
  EXPECT_TRUE(timeline.At(end).in_transit);
}

TEST(FloorPressure, GapsHideNoRide) {
  for (const double gap : {10.0, 60.0, 200.0}) {
    SCOPED_TRACE(std::to_string(gap) + " s");
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const SyntheticDrive drive = FourFloors(seed, 120.0);
      std::vector<PressureReading> readings;
      const double middle = 0.5 * (drive.rides()[1].start + drive.rides()[1].end);
      for (const PressureReading& reading : SyntheticBarometer{}.Read(drive, seed)) {
        if (std::abs(reading.stamp - middle) > 0.5 * gap) readings.push_back(reading);
      }
      const FloorTimeline timeline = Timeline(readings, TrackOf(drive));
      const FloorScore score = ScoreFloors(timeline, drive);
      EXPECT_EQ(score.levels, 4U) << seed;
      EXPECT_GT(score.right_share, gap > 100.0 ? 0.9 : 0.999) << seed;
      EXPECT_LT(score.worst_elevation, 0.5) << "m, " << seed;
    }
  }
}

TEST(FloorPressure, SpikesMakeNoFloors) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SyntheticDrive drive = FourFloors(seed, 120.0);
    std::vector<PressureReading> readings = SyntheticBarometer{}.Read(drive, seed);
    std::mt19937 random(seed);
    for (int k = 0; k < 300; ++k) {
      PressureReading& reading = readings[random() % readings.size()];
      reading.pressure_pa += k % 3 == 0 ? 90.0 : k % 3 == 1 ? -60.0 : -1e5;
    }
    ExpectRight(Timeline(readings, TrackOf(drive)), drive, 4);
  }
}

TEST(FloorPressure, TinyInputsAreNoHarm) {
  const SyntheticDrive drive = FourFloors(1, 120.0);
  const std::vector<PressureReading> all = SyntheticBarometer{}.Read(drive, 1);
  for (std::size_t count = 0; count < 20; ++count) {
    const std::vector<PressureReading> some(all.begin(),
                                            all.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_EQ(Timeline(some, TrackOf(drive)).levels.size(), 1U);
    EXPECT_EQ(Timeline(some, WheelTrack{}).levels.size(), 1U);
  }
}

}  // namespace
}  // namespace masked_mapper
