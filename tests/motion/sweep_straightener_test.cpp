// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/sweep_check.hpp"

#include <gtest/gtest.h>

#include "sensor/sweeping_scanner.hpp"

namespace masked_mapper {
namespace {

SweepingScanner Turning(double rad_per_s) {
  SweepingScanner scanner;
  scanner.T_room_robot = [rad_per_s](double time) {
    return Pose2{0.5, -0.2, WrapAngle(rad_per_s * time)};
  };
  scanner.noise_m = 0.01;
  return scanner;
}

double RateOf(const SweepingScanner& scanner) {
  return scanner.sweep_s / DegToRad(scanner.span_deg);
}

/// Odometry at 20 Hz, scans between; the odometry at a scan as a reader gives it.
std::vector<Observation> Drive(SweepingScanner& scanner, double seconds, bool with_wheels = true) {
  std::vector<Observation> log;
  for (int tick = 0; tick <= static_cast<int>(seconds * 20.0); ++tick) {
    const double time = 0.05 * tick;
    if (with_wheels) log.emplace_back(OdometryReading{time, scanner.T_room_robot(time)});
    if (tick % 4 != 2) continue;
    LaserScan scan = scanner.Scan(time + 0.013);
    if (with_wheels) scan.T_odom_robot = scanner.T_room_robot(scan.stamp);
    log.emplace_back(std::move(scan));
  }
  return log;
}

std::vector<Observation> HandedOn(SweepStraightener straightener, std::vector<Observation> log) {
  std::vector<Observation> out;
  const auto take = [&] {
    while (std::optional<Observation> next = straightener.Next()) out.push_back(std::move(*next));
  };
  for (Observation& observation : log) {
    straightener.Add(std::move(observation));
    take();
  }
  straightener.Finish();
  take();
  return out;
}

std::vector<LaserScan> ScansOf(const std::vector<Observation>& log) {
  std::vector<LaserScan> scans;
  for (const Observation& observation : log) {
    if (const auto* scan = std::get_if<LaserScan>(&observation)) scans.push_back(*scan);
  }
  return scans;
}

TEST(SweepStraightener, MakesWallsOfAFastTurnAsThinAsAtRest) {
  SweepingScanner at_rest = Turning(0.0);
  SweepingScanner turning = Turning(1.2);
  const double rest = MedianThickness(at_rest, ScansOf(Drive(at_rest, 10.0)));
  std::vector<LaserScan> bent = ScansOf(Drive(turning, 10.0));
  std::vector<LaserScan> straight =
      ScansOf(HandedOn(SweepStraightener({RateOf(turning), true}), Drive(turning, 10.0)));
  straight.pop_back();                // the log ends within its sweep
  EXPECT_NEAR(rest, 0.0058, 0.0005);  // of a noise of 0.01 m along beams, mostly not square on
  EXPECT_GT(MedianThickness(turning, bent), 5.0 * rest);
  EXPECT_LT(MedianThickness(turning, straight), 1.05 * rest);
}

TEST(SweepStraightener, KeepsOrderAndNumber) {
  SweepingScanner turning = Turning(1.2);
  const std::vector<Observation> log = Drive(turning, 5.0);
  const std::vector<Observation> out = HandedOn(SweepStraightener({RateOf(turning), true}), log);
  ASSERT_EQ(out.size(), log.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_EQ(out[i].index(), log[i].index());
    EXPECT_EQ(Stamp(out[i]), Stamp(log[i]));
  }
}

TEST(SweepStraightener, LeavesToOthersWhatWheelsDoNotTell) {
  SweepingScanner turning = Turning(1.2);
  const auto expect_bent = [&](const std::vector<Observation>& out) {
    for (const LaserScan& scan : ScansOf(out)) {
      EXPECT_NEAR(scan.SweepDuration(), 0.18, 0.001);
    }
  };
  expect_bent(HandedOn(SweepStraightener({RateOf(turning), true}), Drive(turning, 2.0, false)));
  expect_bent(HandedOn(SweepStraightener({RateOf(turning), false}), Drive(turning, 2.0)));
}

TEST(SweepStraightener, IsNotStoppedByAGapInTheOdometry) {
  SweepingScanner turning = Turning(1.2);
  std::vector<Observation> log;
  for (Observation& observation : Drive(turning, 20.0)) {
    const double stamp = Stamp(observation);
    auto* scan = std::get_if<LaserScan>(&observation);
    if (stamp > 5.0 && stamp < 10.0) {
      if (scan == nullptr) continue;
      scan->T_odom_robot.reset();
    }
    log.push_back(std::move(observation));
  }
  for (const LaserScan& scan : ScansOf(HandedOn(SweepStraightener({RateOf(turning), true}), log))) {
    const bool in_gap = scan.stamp > 5.0 - 0.18 && scan.stamp < 10.0;
    const bool at_end = scan.stamp > 20.0 - 0.18;
    EXPECT_EQ(scan.beam_time != 0.0, in_gap || at_end) << scan.stamp;
  }
}

TEST(SweepStraightener, OverrulesWhatAScanSays) {
  SweepingScanner turning = Turning(1.2);
  for (const LaserScan& scan :
       ScansOf(HandedOn(SweepStraightener({0.0, true}), Drive(turning, 1.0)))) {
    EXPECT_EQ(scan.beam_time, 0.0);
  }
}

}  // namespace
}  // namespace masked_mapper
