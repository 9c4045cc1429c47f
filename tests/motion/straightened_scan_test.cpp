// SPDX-License-Identifier: BSD-3-Clause
#include "motion/straightened_scan.hpp"

#include <gtest/gtest.h>

#include "sensor/sweeping_scanner.hpp"

namespace masked_mapper {
namespace {

Pose2 Circling(double time) {
  const double turned = 1.2 * time;
  return {0.4 * std::sin(turned), 0.4 * (1.0 - std::cos(turned)), WrapAngle(turned)};
}

SweepingScanner Scanner(const std::function<Pose2(double)>& motion) {
  SweepingScanner scanner;
  scanner.T_room_robot = motion;
  return scanner;
}

MotionInSweep From(const SweepingScanner& scanner, double stamp) {
  return [&scanner, stamp](double seconds) {
    return Between(scanner.T_room_robot(stamp), scanner.T_room_robot(stamp + seconds));
  };
}

/// Beams that are not where a scan taken at once has them; edges are met or missed by one beam.
std::size_t BeamsOff(const LaserScan& scan, const LaserScan& at_once) {
  std::size_t off = 0;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    off += !(std::abs(scan.ranges[beam] - at_once.ranges[beam]) < 0.01F);
  }
  return off;
}

TEST(StraightenedScan, IsWhatAScanTakenAtOnceWouldBe) {
  for (const double sweep : {0.18, -0.18}) {
    for (const double span : {360.0, 240.0}) {
      SweepingScanner scanner = Scanner(Circling);
      scanner.sweep_s = sweep;
      scanner.span_deg = span;
      const LaserScan bent = scanner.Scan(1.0);
      const LaserScan straight = Straightened(bent, From(scanner, 1.0));
      scanner.sweep_s = 0.0;
      const LaserScan at_once = scanner.Scan(1.0);
      EXPECT_EQ(straight.beam_time, 0.0);
      EXPECT_GT(BeamsOff(bent, at_once), 400u);
      // Beside edges: a gap of 12 deg that a full circle leaves when the robot turns against it, or
      // the end of a lesser span.
      EXPECT_LT(BeamsOff(straight, at_once), 45u) << sweep << " s, " << span << " deg";
    }
  }
}

TEST(StraightenedScan, LeavesDirectionsThatNoBeamMetInvalid) {
  SweepingScanner scanner = Scanner([](double time) { return Pose2{0.0, 0.0, -1.2 * time}; });
  const LaserScan straight = Straightened(scanner.Scan(0.0), From(scanner, 0.0));
  std::size_t unknown = 0;
  for (const float range : straight.ranges) unknown += std::isnan(range);
  EXPECT_NEAR(static_cast<double>(unknown), 1.2 * 0.18 / straight.angle_step, 2.0);
}

TEST(StraightenedScan, KeepsWhatIsFreeAndWhatIsUnknown) {
  SweepingScanner scanner = Scanner([](double time) { return Pose2{0.0, 0.0, 1.2 * time}; });
  LaserScan bent = scanner.Scan(0.0);
  for (std::size_t beam = 100; beam < 140; ++beam) bent.ranges[beam] = kNoReturn;
  for (std::size_t beam = 300; beam < 340; ++beam) bent.ranges[beam] = kInvalidRange;
  const LaserScan straight = Straightened(bent, From(scanner, 0.0));
  std::size_t free = 0;
  std::size_t unknown = 0;
  for (const float range : straight.ranges) {
    free += std::isinf(range);
    unknown += std::isnan(range);
  }
  EXPECT_NEAR(static_cast<double>(free), 41.4, 2.0);  // spread by the turn
  EXPECT_NEAR(static_cast<double>(unknown), 40.4, 3.0);
}

TEST(StraightenedScan, OfARobotAtRestIsTheSame) {
  SweepingScanner scanner = Scanner([](double) { return Pose2{0.3, -0.4, 1.0}; });
  const LaserScan bent = scanner.Scan(0.0);
  EXPECT_EQ(BeamsOff(Straightened(bent, From(scanner, 0.0)), bent), 0u);
}

TEST(StraightenedScan, WithoutTimesIsLeftAlone) {
  SweepingScanner scanner = Scanner(Circling);
  LaserScan scan = scanner.Scan(0.0);
  scan.beam_time = 0.0;
  EXPECT_EQ(Straightened(scan, From(scanner, 0.0)).ranges, scan.ranges);
  LaserScan empty;
  empty.beam_time = 1e-3;
  EXPECT_TRUE(Straightened(empty, From(scanner, 0.0)).ranges.empty());
}

}  // namespace
}  // namespace masked_mapper
