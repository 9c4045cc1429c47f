// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/sweep_check.hpp"

#include <gtest/gtest.h>

#include "sensor/sweeping_scanner.hpp"

namespace masked_mapper {
namespace {

constexpr double kTurn = 2.0 * kPi;  // rad

/// Stands, then turns one way; stands, then turns the other way, with a wander about the room.
Pose2 StopAndTurn(double time) {
  const double cycle = std::fmod(time, 8.0);
  const double up = std::clamp(cycle - 1.5, 0.0, 2.0);
  const double down = std::clamp(cycle - 5.5, 0.0, 2.0);
  const double turned =
      0.6 * (1.0 - std::cos(0.5 * kPi * up)) - 0.6 * (1.0 - std::cos(0.5 * kPi * down));
  return {0.5 * std::sin(0.05 * time), 0.3 * std::sin(0.07 * time), WrapAngle(turned)};
}

struct Drive {
  double sweep_s = 0.2;
  double stated_s = 0.2;
  double period_s = 0.2;
  double seconds = 120.0;
  double span_deg = 360.0;
  bool with_wheels = true;
  bool moves = true;
};

SweepCheck::Verdict VerdictOf(const Drive& drive) {
  SweepingScanner scanner;
  scanner.beams = 360;
  scanner.noise_m = 0.01;
  scanner.span_deg = drive.span_deg;
  scanner.sweep_s = drive.sweep_s * drive.span_deg / 360.0;
  scanner.T_room_robot = [&](double time) { return drive.moves ? StopAndTurn(time) : Pose2{}; };
  SweepCheck check{MotionOptions{}};
  for (double time = 0.0; time < drive.seconds; time += drive.period_s) {
    LaserScan scan = scanner.Scan(time);
    scan.beam_time = drive.stated_s / kTurn * scan.angle_step;
    if (drive.with_wheels) scan.T_odom_robot = scanner.T_room_robot(time);
    check.Observe(scan);
  }
  return check.Find();
}

TEST(SweepCheck, BelievesWhatIsStatedAndRight) {
  const SweepCheck::Verdict verdict = VerdictOf({});
  EXPECT_NEAR(verdict.seconds_per_rad * kTurn, 0.2, 1e-6);
  EXPECT_FALSE(verdict.finding);
}

TEST(SweepCheck, FindsASweepThatIsNotStated) {
  Drive drive;
  drive.stated_s = 0.0;
  const SweepCheck::Verdict verdict = VerdictOf(drive);
  EXPECT_NEAR(verdict.seconds_per_rad * kTurn, 0.2, 0.01);
  ASSERT_TRUE(verdict.finding);
  EXPECT_NEAR(verdict.finding->value, 0.2, std::max(0.01, 4.0 * verdict.finding->sigma));
}

TEST(SweepCheck, FindsASweepOfAScannerWithoutWheels) {
  Drive drive;
  drive.stated_s = 0.0;
  drive.with_wheels = false;
  EXPECT_NEAR(VerdictOf(drive).seconds_per_rad * kTurn, 0.2, 0.02);
}

TEST(SweepCheck, FindsTheSenseOfASweep) {
  Drive drive;
  drive.sweep_s = -0.2;
  const SweepCheck::Verdict verdict = VerdictOf(drive);
  EXPECT_NEAR(verdict.seconds_per_rad * kTurn, -0.2, 0.01);
  ASSERT_TRUE(verdict.finding);
  EXPECT_NE(verdict.finding->consequence.find("last beam first"), std::string::npos);
}

TEST(SweepCheck, SeesThatTheDriverHasStraightenedItsScans) {
  Drive drive;
  drive.sweep_s = 0.0;
  const SweepCheck::Verdict verdict = VerdictOf(drive);
  EXPECT_EQ(verdict.seconds_per_rad, 0.0);
  EXPECT_TRUE(verdict.finding);
}

TEST(SweepCheck, DoesNotBelieveWhatCannotBe) {
  for (const double stated : {-0.2, 5.0}) {
    Drive drive;
    drive.stated_s = stated;
    EXPECT_NEAR(VerdictOf(drive).seconds_per_rad * kTurn, 0.2, 0.01) << stated;
    drive.moves = false;
    EXPECT_EQ(VerdictOf(drive).seconds_per_rad, 0.0) << stated;
  }
}

TEST(SweepCheck, SaysNothingOfScansTakenAtOnce) {
  Drive drive;
  drive.sweep_s = drive.stated_s = 0.0;
  EXPECT_EQ(VerdictOf(drive).seconds_per_rad, 0.0);
  EXPECT_FALSE(VerdictOf(drive).finding);
}

TEST(SweepCheck, BelievesTheLogWhereTheRobotDoesNotTurn) {
  Drive drive;
  drive.moves = false;
  const SweepCheck::Verdict verdict = VerdictOf(drive);
  EXPECT_NEAR(verdict.seconds_per_rad * kTurn, 0.2, 1e-6);
  EXPECT_FALSE(verdict.finding);
}

TEST(SweepCheck, IsRightOfASpanOf240Degrees) {
  Drive drive;
  drive.stated_s = 0.0;
  drive.span_deg = 240.0;
  EXPECT_NEAR(VerdictOf(drive).seconds_per_rad * kTurn, 0.2, 0.02);
}

}  // namespace
}  // namespace masked_mapper
