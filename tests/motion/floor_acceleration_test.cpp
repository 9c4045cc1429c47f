// SPDX-License-Identifier: BSD-3-Clause
#include "motion/floor_acceleration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/floor_checks.hpp"
#include "motion/synthetic_drive.hpp"

namespace masked_mapper {
namespace {

struct Accelerometer {
  double rate = 50.0;     ///< Hz
  double sigma = 0.03;    ///< m/s^2
  double bias = 0.04;     ///< m/s^2
  double tilt = 0.02;     ///< rad
  double gravity = 9.81;  ///< m/s^2
  double unit = 1.0;      ///< m/s^2
};

AccelerationTrack Feel(const SyntheticDrive& drive, const Accelerometer& sensor, unsigned seed) {
  AccelerationTrack track{FloorAccelerationOptions{}};
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sensor.sigma);
  std::size_t ride = 0;
  for (double t = 0.0; t < drive.Duration(); t += 1.0 / sensor.rate) {
    const double up = sensor.gravity + sensor.bias + drive.AccelerationAt(t, &ride);
    const double pitch = sensor.tilt + std::asin(drive.SlopeAt(t));
    const Eigen::Vector3d value(std::sin(pitch) * up + noise(random), noise(random),
                                std::cos(pitch) * up + noise(random));
    track.Observe({t, value / sensor.unit});
  }
  return track;
}

FloorTimeline Timeline(const AccelerationTrack& acceleration, const WheelTrack& track) {
  return TimelineOfTransits(acceleration.FindRides(track, {}).transits, {});
}

TEST(FloorAcceleration, KnowsTheFloorsByTwoPulses) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SyntheticDrive drive = FourFloors(seed, 100.0);
    const FloorTimeline timeline = Timeline(Feel(drive, {}, seed), TrackOf(drive));
    const FloorScore score = ScoreFloors(timeline, drive);
    EXPECT_EQ(score.levels, 4U) << seed;
    EXPECT_EQ(score.right_share, 1.0) << seed;
    EXPECT_EQ(score.transits_missed, 0) << seed;
    EXPECT_EQ(score.cab_share, 1.0) << seed;
    EXPECT_LT(score.worst_elevation, 0.3) << "m, seed " << seed;
  }
}

TEST(FloorAcceleration, StairsAreSeenByThePitchAndTheWheels) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SyntheticDrive drive({0.0, 3.4, 7.4}, 0, seed);
    drive.Roam(100.0);
    drive.TakeStairs(1);
    drive.Roam(100.0);
    drive.TakeElevator(2);
    drive.Roam(100.0);
    drive.TakeStairs(1);
    drive.Roam(60.0);
    const AccelerationTrack acceleration = Feel(drive, {}, seed);
    const FloorScore score = ScoreFloors(Timeline(acceleration, TrackOf(drive)), drive);
    EXPECT_EQ(score.levels, 3U) << seed;
    EXPECT_EQ(score.transits_missed, 0) << seed;
    EXPECT_GE(score.right_share, 0.99) << seed;
    EXPECT_LT(score.worst_elevation, 0.3) << "m, seed " << seed;
    // A phone that no wheels carry has no way along which it is pitched.
    EXPECT_EQ(acceleration.FindRides({}, {}).transits.size(), 1U) << seed;
  }
}

TEST(FloorAcceleration, SigmaFitsTheErrors) {
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SyntheticDrive drive({0.0, 30.0}, 0, seed);
    drive.Roam(50.0);
    drive.TakeElevator(1);
    drive.Roam(50.0);
    const auto rides = Feel(drive, {}, seed).FindRides(TrackOf(drive), {});
    ASSERT_EQ(rides.transits.size(), 1U);
    squares += std::pow((*rides.transits[0].climb - 30.0) / rides.transits[0].climb_sigma, 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 1.5);
}

TEST(FloorAcceleration, WithoutWheelsItTellsTheSame) {
  const SyntheticDrive drive = FourFloors(1, 100.0);
  const FloorScore score = ScoreFloors(Timeline(Feel(drive, {}, 1), WheelTrack{}), drive);
  EXPECT_EQ(score.levels, 4U);
  EXPECT_GT(score.right_share, 0.999);
  EXPECT_EQ(score.transits_missed, 0);
}

TEST(FloorAcceleration, GravityTellsTheUnit) {
  Accelerometer sensor;
  sensor.unit = 9.80665;
  const SyntheticDrive drive = FourFloors(2, 100.0);
  const auto rides = Feel(drive, sensor, 2).FindRides(TrackOf(drive), {});
  EXPECT_TRUE(rides.usable);
  EXPECT_EQ(rides.transits.size(), 6U);
  EXPECT_EQ(rides.warnings.size(), 1U);
}

TEST(FloorAcceleration, WithoutGravityItIsLeftOutAndSaid) {
  Accelerometer sensor;
  sensor.gravity = 0.0;
  const SyntheticDrive drive = FourFloors(2, 100.0);
  const auto rides = Feel(drive, sensor, 2).FindRides(TrackOf(drive), {});
  EXPECT_FALSE(rides.usable);
  EXPECT_TRUE(rides.transits.empty());
  EXPECT_EQ(rides.warnings.size(), 1U);
}

TEST(FloorAcceleration, APhoneThatFiltersWhatLastsStillTellsTheHeight) {
  // As phones do that take gravity out by a filter: of a push they leave its beginning and an echo.
  for (const double tau : {0.4, 0.55, 0.8}) {
    SyntheticDrive drive({0.0, 30.0, 12.0}, 0, 4);
    drive.Roam(60.0);
    drive.TakeElevator(1, 2.4);
    drive.Roam(60.0);
    drive.TakeElevator(2, 2.4);
    drive.Roam(60.0);
    AccelerationTrack track{FloorAccelerationOptions{}};
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::size_t ride = 0;
    double passed = 0.0;
    constexpr double kPeriod = 0.005;
    for (int i = 0; i * kPeriod < drive.Duration(); ++i) {
      const double acceleration = drive.AccelerationAt(i * kPeriod, &ride);
      passed += kPeriod / tau * (acceleration - passed);
      if (i % 8 != 0) continue;
      track.Observe({i * kPeriod, {0.0, 0.0, 9.81 + acceleration - passed + noise(random)}});
    }
    const auto rides = track.FindRides(TrackOf(drive), {});
    ASSERT_EQ(rides.transits.size(), 2U) << "tau " << tau;
    EXPECT_NEAR(*rides.transits[0].climb, 30.0, 3.0) << "tau " << tau;
    EXPECT_NEAR(*rides.transits[1].climb, -18.0, 1.8) << "tau " << tau;
  }
}

TEST(FloorAcceleration, DrivingAndRestingMakesNoFloors) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SyntheticDrive drive({0.0, 3.5}, 0, seed);
    drive.Roam(2000.0);
    Accelerometer rough;
    rough.sigma = 0.5;
    EXPECT_TRUE(Feel(drive, rough, seed).FindRides(TrackOf(drive), {}).transits.empty());
  }
}

TEST(FloorAcceleration, SeveralRidesInOneCabAreOneTransit) {
  SyntheticDrive drive({0.0, 3.5, 7.0, 10.5}, 0, 3);
  drive.Roam(100.0);
  drive.EnterCab();
  drive.RideTo(1);
  drive.Rest(12.0);
  drive.RideTo(3);
  drive.Rest(3.0);
  drive.RideTo(2);
  drive.LeaveCab();
  drive.Roam(100.0);
  const auto rides = Feel(drive, {}, 3).FindRides(TrackOf(drive), {});
  ASSERT_EQ(rides.transits.size(), 1U);
  EXPECT_NEAR(*rides.transits[0].climb, 7.0, 0.3);
}

TEST(FloorAcceleration, TinyAndBrokenInputsAreNoHarm) {
  AccelerationTrack track{FloorAccelerationOptions{}};
  EXPECT_TRUE(track.IsEmpty());
  EXPECT_FALSE(track.FindRides({}, {}).usable);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  track.Observe({nan, {0.0, 0.0, 9.8}});
  track.Observe({0.0, {0.0, nan, 9.8}});
  EXPECT_TRUE(track.IsEmpty());
  track.Observe({1.0, {0.0, 0.0, 9.8}});
  track.Observe({0.5, {0.0, 0.0, 9.8}});
  EXPECT_TRUE(track.FindRides({}, {}).usable);
  EXPECT_TRUE(track.FindRides({}, {}).transits.empty());
}

}  // namespace
}  // namespace masked_mapper
