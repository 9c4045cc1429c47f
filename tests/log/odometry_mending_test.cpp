// SPDX-License-Identifier: BSD-3-Clause
#include "log/odometry_mending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

class Listed final : public LogReader {
 public:
  explicit Listed(std::vector<Observation> observations) : observations_(std::move(observations)) {}
  std::optional<Observation> Next() override {
    if (next_ == observations_.size()) return std::nullopt;
    return observations_[next_++];
  }
  const LogStatistics& Statistics() const override { return statistics_; }
  double Progress() const override { return 0.0; }

 private:
  std::vector<Observation> observations_;
  std::size_t next_ = 0;
  LogStatistics statistics_;
};

/// Where the robot truly is: round a circle of 10 m radius at a metre a second.
Pose2 At(double stamp) {
  return {10.0 * std::sin(0.1 * stamp), 10.0 * (1.0 - std::cos(0.1 * stamp)), 0.1 * stamp};
}

/// Round it; wheels at 20 Hz and a scan every 0.2 s,
/// stamped `ahead_s` too late, with the odometry of its stamp.
std::vector<Observation> Drive(double ahead_s) {
  std::vector<Observation> log;
  for (int i = 0; i < 400; ++i) {
    const double stamp = 0.05 * i;
    log.emplace_back(OdometryReading{stamp, At(stamp)});
    if (i % 4 != 2) continue;
    LaserScan scan;
    scan.stamp = scan.log_stamp = stamp + 0.01;  // seen at stamp + 0.01 - ahead_s
    scan.T_odom_robot = At(scan.stamp);
    scan.ranges = {static_cast<float>(scan.stamp - ahead_s)};
    log.emplace_back(scan);
    if (i % 40 == 2) log.emplace_back(PressureReading{scan.stamp, 1e5});
  }
  return log;
}

std::vector<Observation> Read(std::vector<Observation> log, const OdometryMending& mending) {
  const std::unique_ptr<LogReader> reader =
      Mended(std::make_unique<Listed>(std::move(log)), mending);
  std::vector<Observation> read;
  while (std::optional<Observation> next = reader->Next()) read.push_back(std::move(*next));
  return read;
}

std::vector<LaserScan> Scans(const std::vector<Observation>& log) {
  std::vector<LaserScan> scans;
  for (const Observation& observation : log) {
    if (const auto* scan = std::get_if<LaserScan>(&observation)) scans.push_back(*scan);
  }
  return scans;
}

TEST(OdometryMending, NothingToMendIsNothingDone) {
  EXPECT_EQ(Read(Drive(0.0), {}).size(), Drive(0.0).size());
  EXPECT_TRUE(Read({}, {1.0, 2.0, 3.0, true, {{0.0, 1.0}}}).empty());
}

TEST(OdometryMending, ScansGetTheOdometryOfWhenTheyWereTaken) {
  for (const double ahead_s : {2.0, -1.5, 0.3}) {
    OdometryMending mending;
    mending.scan_clock_s = ahead_s;
    const std::vector<Observation> read = Read(Drive(ahead_s), mending);
    for (std::size_t i = 1; i < read.size(); ++i) {
      EXPECT_LE(Stamp(read[i - 1]), Stamp(read[i])) << "s, at " << i;
    }
    const std::vector<LaserScan> scans = Scans(read);
    ASSERT_EQ(scans.size(), 100U);
    int with_odometry = 0;
    for (const LaserScan& scan : scans) {
      EXPECT_NEAR(scan.stamp, scan.ranges[0], 1e-5) << "s";
      EXPECT_NEAR(scan.log_stamp, scan.stamp + ahead_s, 1e-9) << "s";
      if (!scan.T_odom_robot) continue;
      ++with_odometry;
      // Before the first reading the robot stands, behind the last it goes on.
      EXPECT_NEAR(Distance(*scan.T_odom_robot, At(std::max(scan.stamp, 0.0))), 0.0, 0.03) << "m";
    }
    EXPECT_GE(with_odometry, 85);
  }
}

TEST(OdometryMending, StepsAreMultiplied) {
  OdometryMending mending;
  mending.travel_factor = 2.0;
  mending.turn_factor = 0.0;
  const std::vector<LaserScan> scans = Scans(Read(Drive(0.0), mending));
  // Without its turns a circle is a straight line.
  EXPECT_NEAR(Distance(*scans.front().T_odom_robot, *scans.back().T_odom_robot),
              2.0 * (scans.back().stamp - scans.front().stamp), 0.1)
      << "m";
  EXPECT_EQ(scans.back().T_odom_robot->theta, 0.0);
  mending.turn_factor = 1.0;
  const std::vector<LaserScan> turned = Scans(Read(Drive(0.0), mending));
  EXPECT_NEAR(turned.back().T_odom_robot->theta, 0.1 * turned.back().stamp, 1e-9) << "rad";
}

TEST(OdometryMending, OfTurnsLeftOutTheWayStays) {
  OdometryMending mending;
  mending.turns_left_out = true;
  mending.travel_factor = 0.5;
  const std::vector<LaserScan> scans = Scans(Read(Drive(0.0), mending));
  const double way = 0.5 * (scans.back().stamp - scans.front().stamp);
  EXPECT_NEAR(scans.back().T_odom_robot->x - scans.front().T_odom_robot->x, way, 0.01) << "m";
  EXPECT_EQ(scans.back().T_odom_robot->y, 0.0);
  EXPECT_EQ(scans.back().T_odom_robot->theta, 0.0);
}

TEST(OdometryMending, WhatIsLeftOutIsSilent) {
  OdometryMending mending;
  mending.left_out = {{2.0, 5.0}, {8.0, std::numeric_limits<double>::infinity()}};
  const std::vector<Observation> read = Read(Drive(0.0), mending);
  EXPECT_EQ(Scans(read).size(), 100U);
  for (const Observation& observation : read) {
    const double stamp = Stamp(observation);
    const bool is_left_out = (stamp >= 2.0 && stamp <= 5.0) || stamp >= 8.0;
    EXPECT_FALSE(is_left_out && std::holds_alternative<OdometryReading>(observation)) << stamp;
    const auto* scan = std::get_if<LaserScan>(&observation);
    if (scan == nullptr) continue;
    EXPECT_EQ(scan->T_odom_robot.has_value(), !is_left_out) << stamp;
  }
}

}  // namespace
}  // namespace masked_mapper
