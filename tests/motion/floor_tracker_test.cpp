// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "masked_mapper/text/input_error.hpp"
#include "motion/floor_checks.hpp"
#include "motion/synthetic_drive.hpp"

namespace masked_mapper {
namespace {

void ObserveWheels(const SyntheticDrive& drive, FloorTracker* tracker) {
  for (const SyntheticDrive::State& state : drive.states()) {
    tracker->Observe(OdometryReading{state.stamp, state.T_odom_robot});
  }
}

FloorTimeline Track(const SyntheticDrive& drive, const std::vector<PressureReading>& pressure,
                    FloorTracker* tracker) {
  ObserveWheels(drive, tracker);
  for (const PressureReading& reading : pressure) tracker->Observe(reading);
  return tracker->Finish();
}

/// A long day in a tower: floors in any order, now and then by stairs.
SyntheticDrive DayInTower(unsigned seed, double hours) {
  std::mt19937 random(seed);
  std::vector<double> elevations = {0.0};
  for (int i = 1; i < 10; ++i) {
    elevations.push_back(elevations.back() + 2.8 + 0.1 * static_cast<double>(random() % 14));
  }
  std::size_t floor = random() % 10;
  SyntheticDrive drive(elevations, floor, seed);
  drive.Roam(60.0);
  while (drive.Duration() < 3600.0 * hours) {
    const bool by_stairs = random() % 5 == 0;
    std::size_t next = std::min<std::size_t>(9, random() % 10);
    if (by_stairs) next = floor == 9 ? 8 : floor + 1;
    if (next == floor) continue;
    if (by_stairs) {
      drive.TakeStairs(next);
    } else {
      drive.TakeElevator(next, random() % 2 == 0 ? 1.0 : 2.5);
    }
    drive.Roam(20.0 + static_cast<double>(random() % 400));
    floor = next;
  }
  return drive;
}

std::size_t FloorsVisited(const SyntheticDrive& drive) {
  std::set<std::size_t> floors;
  for (const SyntheticDrive::State& state : drive.states()) floors.insert(state.floor);
  return floors.size();
}

TEST(FloorTracker, KnowsTenFloorsInAnyOrderByPressureAlone) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const SyntheticDrive drive = DayInTower(seed, 2.5);
    FloorTracker tracker{FloorOptions{}};
    const FloorTimeline timeline = Track(drive, SyntheticBarometer{}.Read(drive, seed), &tracker);
    const FloorScore score = ScoreFloors(timeline, drive);
    EXPECT_EQ(tracker.source(), FloorSource::kPressure);
    EXPECT_EQ(score.levels, FloorsVisited(drive)) << "seed " << seed;
    EXPECT_GE(score.right_share, 0.999) << "seed " << seed;
    EXPECT_EQ(score.transits_missed, 0) << "seed " << seed << " of " << drive.rides().size();
    EXPECT_LT(score.worst_elevation, 0.3) << "m, seed " << seed;
    EXPECT_GT(score.cab_share, 0.97) << "seed " << seed;
    EXPECT_LT(score.lost_share, 0.08) << "seed " << seed;
    EXPECT_TRUE(tracker.warnings().empty());
  }
}

SyntheticDrive UpAndDown() {
  SyntheticDrive drive({0.0, 3.5}, 0, 1);
  drive.Roam(100.0);
  drive.TakeElevator(1);
  drive.Roam(100.0);
  drive.TakeElevator(0);
  drive.Roam(100.0);
  return drive;
}

TEST(FloorTracker, WithoutAnySourceThereIsOneFloor) {
  FloorTracker tracker{FloorOptions{}};
  const FloorTimeline timeline = Track(UpAndDown(), {}, &tracker);
  EXPECT_EQ(timeline.levels.size(), 1U);
  EXPECT_EQ(timeline.intervals.size(), 1U);
  EXPECT_EQ(tracker.source(), FloorSource::kNone);
  EXPECT_TRUE(tracker.warnings().empty());
}

TEST(FloorTracker, ASourceThatIsAskedForAndMissingIsSaid) {
  for (const FloorSource source : {FloorSource::kLabels, FloorSource::kPressure,
                                   FloorSource::kAcceleration, FloorSource::kLidar}) {
    FloorOptions options;
    options.source = source;
    FloorTracker tracker(options);
    EXPECT_EQ(Track(UpAndDown(), {}, &tracker).levels.size(), 1U);
    EXPECT_EQ(tracker.warnings().size(), 1U);
  }
}

TEST(FloorTracker, NoneMeansOneFloorWhateverTheLogHolds) {
  const SyntheticDrive drive = UpAndDown();
  FloorOptions options;
  options.source = FloorSource::kNone;
  FloorTracker tracker(options);
  tracker.Observe(FloorLabel{0.0, "a/b"});
  EXPECT_EQ(Track(drive, SyntheticBarometer{}.Read(drive, 1), &tracker).levels.size(), 1U);
}

TEST(FloorTracker, LabelsWinOverPressureAndTakeItsHeights) {
  const SyntheticDrive drive = UpAndDown();
  FloorTracker tracker{FloorOptions{}};
  tracker.Observe(FloorLabel{0.0, "EG"});
  tracker.Observe(FloorLabel{drive.rides()[0].end + 10.0, "OG"});
  tracker.Observe(FloorLabel{drive.rides()[1].end + 10.0, "EG"});
  const FloorTimeline timeline = Track(drive, SyntheticBarometer{}.Read(drive, 1), &tracker);
  EXPECT_EQ(tracker.source(), FloorSource::kLabels);
  EXPECT_TRUE(tracker.warnings().empty());
  ASSERT_EQ(timeline.levels.size(), 2U);
  EXPECT_EQ(timeline.levels[1].label, "OG");
  EXPECT_NEAR(timeline.levels[1].elevation, 3.5, 0.3);
  const FloorScore score = ScoreFloors(timeline, drive);
  EXPECT_EQ(score.right_share, 1.0);
  EXPECT_EQ(score.cab_share, 1.0);
}

TEST(FloorTracker, LabelsOfAFileStandForThoseOfTheLog) {
  FloorTracker tracker{FloorOptions{}};
  tracker.UseLabels({{0.0, "A"}, {50.0, "B"}});
  tracker.Observe(FloorLabel{0.0, "a/b"});
  EXPECT_EQ(tracker.Finish().levels[1].label, "B");
  EXPECT_THROW(tracker.UseLabels({{0.0, ".."}}), InputError);
}

TEST(FloorTracker, ALabelThatIsNoneIsRefused) {
  FloorTracker tracker{FloorOptions{}};
  EXPECT_THROW(tracker.Observe(FloorLabel{0.0, "../x"}), InputError);
}

TEST(FloorTracker, ZeroPressureIsSaidAndLeftOut) {
  FloorTracker tracker{FloorOptions{}};
  std::vector<PressureReading> zeros;
  for (int i = 0; i < 1000; ++i) zeros.push_back({0.3 * i, 0.0});
  EXPECT_EQ(Track(UpAndDown(), zeros, &tracker).levels.size(), 1U);
  EXPECT_EQ(tracker.warnings().size(), 1U);
  EXPECT_EQ(tracker.source(), FloorSource::kNone);
}

TEST(FloorTracker, NoElevatorMovesADrivingRobot) {
  LaserScan cab;
  cab.angle_step = 2.0 * kPi / 100.0;
  cab.max_range = 30.0F;
  cab.ranges.assign(100, 0.8F);
  FloorTracker restless{FloorOptions{}};
  for (int i = 0; i < 1000; ++i) {
    restless.Observe(OdometryReading{0.2 * i, {0.1 * i, 0.0, 0.0}});
    cab.stamp = 0.2 * i;
    restless.Observe(cab);
  }
  EXPECT_EQ(restless.Finish().levels.size(), 1U);
  EXPECT_EQ(restless.source(), FloorSource::kNone);
}

TEST(FloorTracker, TakesAccelerationWhereThereIsNoPressure) {
  const SyntheticDrive drive = UpAndDown();
  FloorTracker tracker{FloorOptions{}};
  ObserveWheels(drive, &tracker);
  std::size_t ride = 0;
  for (double t = 0.0; t < drive.Duration(); t += 0.02) {
    tracker.Observe(AccelerationReading{t, {0.0, 0.0, 9.81 + drive.AccelerationAt(t, &ride)}});
  }
  const FloorTimeline timeline = tracker.Finish();
  EXPECT_EQ(tracker.source(), FloorSource::kAcceleration);
  const FloorScore score = ScoreFloors(timeline, drive);
  EXPECT_EQ(score.levels, 2U);
  EXPECT_EQ(score.right_share, 1.0);
  EXPECT_LT(score.worst_elevation, 0.2) << "m";
}

TEST(FloorTracker, ABarometerThatStopsLeavesTheRestToTheOthers) {
  SyntheticDrive drive({0.0, 3.5, 7.0}, 0, 1);
  drive.Roam(200.0);
  drive.TakeElevator(1);
  drive.Roam(200.0);
  drive.TakeElevator(2);
  drive.Roam(200.0);
  drive.TakeElevator(0);
  drive.Roam(200.0);
  const double stop = 0.5 * (drive.rides()[0].end + drive.rides()[1].start);
  const double in_ride = 0.5 * (drive.rides()[1].start + drive.rides()[1].end);
  for (const double last : {stop, in_ride}) {
    FloorTracker tracker{FloorOptions{}};
    ObserveWheels(drive, &tracker);
    for (const PressureReading& reading : SyntheticBarometer{}.Read(drive, 1)) {
      if (reading.stamp < last) tracker.Observe(reading);
    }
    std::size_t ride = 0;
    for (double t = 0.0; t < drive.Duration(); t += 0.02) {
      tracker.Observe(AccelerationReading{t, {0.0, 0.0, 9.81 + drive.AccelerationAt(t, &ride)}});
    }
    const FloorTimeline timeline = tracker.Finish();
    const FloorScore score = ScoreFloors(timeline, drive);
    EXPECT_EQ(score.levels, 3U) << "stops at " << last;
    EXPECT_GT(score.right_share, 0.999) << "stops at " << last;
    EXPECT_LT(score.worst_elevation, 0.3) << "m, stops at " << last;
    const std::vector<FloorChange> changes = ChangesOf(timeline);
    ASSERT_EQ(changes.size(), 3U);
    EXPECT_TRUE(changes[0].by.Has(FloorSource::kPressure));
    EXPECT_TRUE(changes[0].by.Has(FloorSource::kAcceleration));
    EXPECT_FALSE(changes[2].by.Has(FloorSource::kPressure));
    EXPECT_NEAR(changes[2].height_m, -7.0, 0.3);
  }
}

TEST(FloorTracker, FinishingTwiceSaysTheSame) {
  const SyntheticDrive drive = UpAndDown();
  FloorTracker tracker{FloorOptions{}};
  SyntheticBarometer barometer;
  barometer.pa_per_unit = 100.0;
  const FloorTimeline first = Track(drive, barometer.Read(drive, 2), &tracker);
  const FloorTimeline second = tracker.Finish();
  EXPECT_EQ(tracker.warnings().size(), 1U);
  ASSERT_EQ(first.intervals.size(), second.intervals.size());
  for (std::size_t i = 0; i < first.intervals.size(); ++i) {
    EXPECT_EQ(first.intervals[i].start, second.intervals[i].start);
  }
}

}  // namespace
}  // namespace masked_mapper
