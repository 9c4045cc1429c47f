// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <gtest/gtest.h>

#include "log/temporary_file.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "sensor/sweeping_scanner.hpp"

namespace masked_mapper {
namespace {

/// Turns to and fro while it drives slowly about.
Pose2 ToAndFro(double time) {
  return {0.5 * std::sin(0.1 * time), 0.3 * std::sin(0.07 * time), 1.2 * std::sin(time)};
}

TEST(StraightenedLog, ReadsABagWithWallsAsThinAsTheyAre) {
  const TemporaryFile bag(".bag");
  const std::string path = bag.path();
  SweepingScanner scanner;
  scanner.T_room_robot = ToAndFro;
  scanner.noise_m = 0.005;
  {
    LogWriter writer(path);
    for (int tick = 0; tick < 1200; ++tick) {
      const double stamp = 100.0 + 0.05 * tick;
      if (tick % 4 != 0) {
        writer.Write(OdometryReading{stamp, ToAndFro(stamp)});
        continue;
      }
      LaserScan scan = scanner.Scan(stamp);
      scan.T_odom_robot = ToAndFro(stamp);
      writer.Write(scan);
    }
    writer.Close();
  }
  LogSource source(path, LogOptions{});
  const LogSurvey survey = SurveyLog(source, MappingOptions{});
  EXPECT_NEAR(survey.sweep_s_per_rad, 0.18 / (2.0 * kPi), 1e-6);
  const auto scans_of = [](const std::unique_ptr<LogReader>& log) {
    std::vector<LaserScan> scans;
    while (std::optional<Observation> observation = log->Next()) {
      auto* scan = std::get_if<LaserScan>(&*observation);
      if (scan != nullptr) scans.push_back(std::move(*scan));
    }
    return scans;
  };
  const std::vector<LaserScan> bent = scans_of(source.Read());
  std::vector<LaserScan> straight =
      scans_of(ReadStraightened(source, {survey.sweep_s_per_rad, true}));
  ASSERT_EQ(straight.size(), bent.size());
  straight.pop_back();
  EXPECT_GT(MedianThickness(scanner, bent), 0.03);
  EXPECT_LT(MedianThickness(scanner, straight),
            0.0045);  // 0.67 of the noise, and what interpolates
  for (const LaserScan& scan : straight) EXPECT_EQ(scan.beam_time, 0.0);
}

}  // namespace
}  // namespace masked_mapper
