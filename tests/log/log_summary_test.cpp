// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_summary.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_writer.hpp"

namespace masked_mapper {
namespace {

LogSummary SummaryOf(const std::string& path) {
  LogSource source(path, {});
  return Summarise(source);
}

TEST(SummariseTest, SaysWhatAPersonCanCount) {
  const TemporaryFile file(".log");
  LogWriter writer(file.path());
  for (int i = 0; i <= 100; ++i) {
    LaserScan scan;
    scan.stamp = 10.0 + 0.2 * i + (i > 50 ? 3.0 : 0.0);
    scan.first_angle = -DegToRad(135.0);
    scan.angle_step = DegToRad(270.0) / 99.0;
    scan.max_range = 30.0F;
    for (int beam = 0; beam < 100; ++beam) {
      scan.ranges.push_back(beam < 10 ? kNoReturn : 1.0F + 0.1F * static_cast<float>(beam - 10));
    }
    scan.T_odom_robot = Pose2{0.1 * i, 0.0, 0.01 * i};
    writer.Write(scan);
  }
  writer.Close();
  const LogSummary summary = SummaryOf(file.path());
  EXPECT_EQ(summary.statistics.scans, 101U);
  EXPECT_NEAR(summary.duration_s, 23.0, 1e-6);
  EXPECT_NEAR(summary.path_length_m, 10.0, 1e-4);
  EXPECT_NEAR(RadToDeg(summary.turned_rad), RadToDeg(1.0), 0.01);
  EXPECT_TRUE(summary.has_odometry);
  EXPECT_EQ(summary.scans_of_beams, (std::map<std::size_t, std::uint64_t>{{100, 101}}));
  EXPECT_NEAR(RadToDeg(summary.field_of_view_rad), 270.0, 1e-6);
  EXPECT_NEAR(summary.max_range_m, 30.0, 1e-6);
  EXPECT_NEAR(summary.range_quantiles_m[2], 1.0 + 0.1 * 45.0, 0.11);
  EXPECT_NEAR(summary.share_no_return, 0.1, 1e-9);
  EXPECT_NEAR(summary.scan_rate_hz, 5.0, 0.01);
  EXPECT_NEAR(summary.largest_gap_s, 3.2, 1e-6);
  EXPECT_NEAR(summary.largest_gap_stamp, 20.0, 1e-6);
  EXPECT_EQ(summary.statistics.stamp_jumps, 0U);
}

TEST(SummariseTest, AnEmptyLogIsAllZeros) {
  const TemporaryFile file(".log", "# nothing\n");
  const LogSummary summary = SummaryOf(file.path());
  EXPECT_EQ(summary.statistics.scans, 0U);
  EXPECT_FALSE(summary.has_odometry);
  EXPECT_EQ(summary.range_quantiles_m[2], 0.0);
}

// The lengths that the logs' own description states.
TEST(SummariseTest, PathsOfRealLogs) {
  for (const auto& [name, length] : std::map<std::string, double>{
           {"aces", 325.0}, {"fr079", 392.0}, {"mit-csail", 374.0}, {"malaga-telecom", 76.0}}) {
    const std::string path = std::string(MASKED_MAPPER_REAL_LOGS) + "/data/" + name + ".clf.gz";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    EXPECT_NEAR(SummaryOf(path).path_length_m, length, 1.0) << name;
  }
}

}  // namespace
}  // namespace masked_mapper
