// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "log/temporary_file.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

struct Content {
  std::vector<Observation> observations;
  LogStatistics statistics;

  std::vector<LaserScan> Scans() const {
    std::vector<LaserScan> scans;
    for (const Observation& observation : observations) {
      if (const auto* scan = std::get_if<LaserScan>(&observation)) scans.push_back(*scan);
    }
    return scans;
  }
};

Content ReadAll(const std::string& path, const LogOptions& options = {}) {
  Content content;
  const std::unique_ptr<LogReader> reader = OpenLog(path, options);
  double last_stamp = -1e300;
  while (std::optional<Observation> observation = reader->Next()) {
    EXPECT_GE(Stamp(*observation), last_stamp);
    last_stamp = Stamp(*observation);
    content.observations.push_back(std::move(*observation));
  }
  EXPECT_EQ(reader->Progress(), 1.0);
  EXPECT_FALSE(reader->Next());
  content.statistics = reader->Statistics();
  return content;
}

Content ReadText(const std::string& text, const LogOptions& options = {}) {
  const TemporaryFile file(".log", text);
  return ReadAll(file.path(), options);
}

std::string Flaser(double stamp, std::size_t beams = 181, double range = 2.0) {
  std::string line = "FLASER " + std::to_string(beams);
  for (std::size_t i = 0; i < beams; ++i)
    line += " " + std::to_string(range + 0.01 * static_cast<double>(i % 7));
  return line + " 0 0 0 0 0 0 " + std::to_string(stamp) + " h 0\n";
}

std::string Odom(double stamp) { return "ODOM 1 2 0.5 0 0 0 " + std::to_string(stamp) + " h 0\n"; }

TEST(CarmenReaderTest, ReadsEveryKindInOrder) {
  const Content content =
      ReadText("# a comment\nPARAM robot_use_laser on 0 h 0\n" + Odom(1.0) + Flaser(1.5) +
               "PRESSURE 101300 1.25 h 0\nACCEL 0 0 9.81 1.75 h 0\nFLOOR 2 2.0 h 0\nTRUEPOS 1 2\n");
  ASSERT_EQ(content.observations.size(), 5U);
  EXPECT_TRUE(std::holds_alternative<OdometryReading>(content.observations[0]));
  EXPECT_TRUE(std::holds_alternative<PressureReading>(content.observations[1]));
  EXPECT_TRUE(std::holds_alternative<LaserScan>(content.observations[2]));
  EXPECT_TRUE(std::holds_alternative<AccelerationReading>(content.observations[3]));
  EXPECT_TRUE(std::holds_alternative<FloorLabel>(content.observations[4]));
  const LogStatistics& statistics = content.statistics;
  EXPECT_EQ(statistics.lines, 8U);
  EXPECT_EQ(statistics.scans, 1U);
  EXPECT_EQ(statistics.odometry, 1U);
  EXPECT_EQ(statistics.pressure, 1U);
  EXPECT_EQ(statistics.acceleration, 1U);
  EXPECT_EQ(statistics.floor_labels, 1U);
  EXPECT_EQ(statistics.bad_lines, 0U);
  EXPECT_EQ(statistics.reordered, 1U);
  EXPECT_EQ(statistics.other_messages.at("TRUEPOS"), 1U);
  EXPECT_EQ(statistics.first_stamp, 1.0);
  EXPECT_EQ(statistics.last_stamp, 2.0);
}

TEST(CarmenReaderTest, BadLinesAreSkippedAndCounted) {
  std::string wrong_count = Flaser(2.0);
  wrong_count.replace(0, 10, "FLASER 180");
  const Content content = ReadText(Flaser(1.0) + wrong_count + "FLASER 2 1 x 0 0 0 0 0 0 3 h 0\n" +
                                   "ODOM nan 0 0 0 0 0 3 h 0\n\x01\x02garbage\n" + Flaser(4.0));
  EXPECT_EQ(content.statistics.scans, 2U);
  EXPECT_EQ(content.statistics.bad_lines, 4U);
  EXPECT_EQ(content.statistics.first_bad_line, "line 2: FLASER: expected 180 ranges, found 181");
  EXPECT_FALSE(content.statistics.truncated);
}

TEST(CarmenReaderTest, NumbersThatAreNoRangeSpoilTheirBeamOnly) {
  const Content content =
      ReadText("FLASER 5 nan 1e300 -3 inf 2.0 0 0 0 0 0 0 1 h 0\n" + Flaser(2.0, 5));
  ASSERT_EQ(content.Scans().size(), 2U);
  EXPECT_EQ(content.statistics.invalid_ranges, 3U);
  const LaserScan scan = content.Scans()[0];
  EXPECT_FALSE(scan.IsHit(0) || scan.IsHit(1) || scan.IsHit(2) || scan.IsHit(3));
  EXPECT_EQ(scan.ranges[3], kNoReturn);
  EXPECT_TRUE(scan.IsHit(4));
}

TEST(CarmenReaderTest, ACutLastLineIsSaid) {
  const std::string text = Flaser(1.0) + Flaser(2.0);
  Content content = ReadText(text.substr(0, text.size() - 40));
  EXPECT_EQ(content.statistics.scans, 1U);
  EXPECT_EQ(content.statistics.bad_lines, 1U);
  EXPECT_TRUE(content.statistics.truncated);
  // Only the newline is missing: nothing is lost.
  content = ReadText(text.substr(0, text.size() - 1));
  EXPECT_EQ(content.statistics.scans, 2U);
  EXPECT_FALSE(content.statistics.truncated);
}

TEST(CarmenReaderTest, AGzipCutInTheMiddleGivesItsGoodPart) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += Flaser(i, 181, 1.0 + 0.013 * (i % 89));
  const std::string packed = Gzipped(text);
  const TemporaryFile file(".log.gz", packed.substr(0, packed.size() / 2));
  const Content content = ReadAll(file.path());
  EXPECT_GT(content.statistics.scans, 100U);
  EXPECT_LT(content.statistics.scans, 400U);
  EXPECT_TRUE(content.statistics.truncated);
}

TEST(CarmenReaderTest, ConcatenatedGzipAndGarbageBehindIt) {
  const TemporaryFile file(".gz", Gzipped(Flaser(1.0)) + Gzipped(Flaser(2.0)) + "garbage");
  const Content content = ReadAll(file.path());
  EXPECT_EQ(content.statistics.scans, 2U);
  EXPECT_EQ(content.statistics.trailing_bytes, 7U);
  EXPECT_FALSE(content.statistics.truncated);
}

TEST(CarmenReaderTest, CarriageReturnsChangeNothing) {
  std::string text = Odom(1.0) + Flaser(2.0);
  const Content unix_content = ReadText(text);
  std::string dos_text;
  for (const char c : text) dos_text += c == '\n' ? "\r\n" : std::string(1, c);
  const Content dos_content = ReadText(dos_text);
  EXPECT_EQ(dos_content.statistics.bad_lines, 0U);
  ASSERT_EQ(dos_content.Scans().size(), 1U);
  EXPECT_EQ(dos_content.Scans()[0].ranges, unix_content.Scans()[0].ranges);
}

TEST(CarmenReaderTest, AnEnormousLineIsSkipped) {
  const Content content =
      ReadText(Flaser(1.0) + "FLASER " + std::string(6 << 20, '1') + "\n" + Flaser(2.0));
  EXPECT_EQ(content.statistics.scans, 2U);
  EXPECT_EQ(content.statistics.bad_lines, 1U);
}

TEST(CarmenReaderTest, BackwardAndWrappedStampsAreMended) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += Flaser(std::fmod(4290.0 + 0.1 * i, 4294.967296));
  text += Flaser(0.0001);
  const Content content = ReadText(text);  // ReadAll checks the order
  EXPECT_EQ(content.statistics.scans, 101U);
  EXPECT_NEAR(content.statistics.first_stamp, 4290.0, 1e-6);
  EXPECT_NEAR(content.statistics.last_stamp, 4299.9, 1e-6);
  EXPECT_EQ(content.statistics.stamp_jumps, 2U);
}

TEST(CarmenReaderTest, TheNumberOfBeamsMayChange) {
  const Content content = ReadText(Flaser(1.0, 180) + Flaser(2.0, 361) + Flaser(3.0, 181));
  const std::vector<LaserScan> scans = content.Scans();
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_NEAR(RadToDeg(scans[0].angle_step), 1.0, 1e-9);
  EXPECT_NEAR(RadToDeg(scans[1].angle_step), 0.5, 1e-9);
  EXPECT_NEAR(RadToDeg(scans[2].Angle(180)), 90.0, 1e-9);
}

TEST(CarmenReaderTest, ALogWithoutNoReturnLosesNothing) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += Flaser(i, 181, 2.0);
  text += Flaser(400, 181, 60.0);  // far returns only at the very end
  const Content content = ReadText(text);
  for (const LaserScan& scan : content.Scans()) {
    for (std::size_t beam = 0; beam < scan.size(); ++beam) ASSERT_TRUE(scan.IsHit(beam));
  }
  EXPECT_EQ(content.statistics.empty_scans, 0U);
}

TEST(CarmenReaderTest, NoReturnThatFirstShowsLateIsFound) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += Flaser(i, 181, 2.0);
  for (int i = 400; i < 420; ++i) {
    std::string line = "FLASER 181";
    for (int beam = 0; beam < 181; ++beam) line += beam % 3 == 0 ? " 81.91" : " 3.5";
    text += line + " 0 0 0 0 0 0 " + std::to_string(i) + " h 0\n";
  }
  const Content content = ReadText(text);
  EXPECT_NEAR(content.statistics.max_range, 81.91, 1e-4);
  EXPECT_EQ(content.Scans().back().ranges[0], kNoReturn);
  EXPECT_EQ(content.Scans().back().ranges[1], 3.5F);
}

TEST(CarmenReaderTest, EmptyScansAreCounted) {
  std::string line = "FLASER 181";
  for (int beam = 0; beam < 181; ++beam) line += " inf";
  const Content content = ReadText(Flaser(1.0) + line + " 0 0 0 0 0 0 2.0 h 0\n");
  EXPECT_EQ(content.statistics.scans, 2U);
  EXPECT_EQ(content.statistics.empty_scans, 1U);
}

TEST(CarmenReaderTest, ScansLoggedTwiceAreReadOnce) {
  std::string text;
  for (int i = 0; i < 10; ++i) {
    text += "ROBOTLASER1 0 -1.5708 3.14159 0.0174533 80 0.01 0 181";
    for (int beam = 0; beam < 181; ++beam) text += " 2.5";
    text +=
        " 0 0 0 0 0 0 0 0 0 0 0 0 " + std::to_string(static_cast<double>(i)) + " h 0\n" + Flaser(i);
  }
  const Content content = ReadText(text);
  EXPECT_EQ(content.statistics.scans, 10U);
  EXPECT_EQ(content.statistics.other_messages.at("FLASER (repeats ROBOTLASER1)"), 10U);
  EXPECT_EQ(content.Scans()[0].max_range, 80.0F);
}

TEST(CarmenReaderTest, WithoutRangesTheRestIsTheSame) {
  const std::string text = Odom(1.0) + Flaser(1.5) + Flaser(2.0, 361);
  LogOptions options;
  options.read_ranges = false;
  const Content full = ReadText(text);
  const Content quick = ReadText(text, options);
  ASSERT_EQ(quick.observations.size(), full.observations.size());
  EXPECT_EQ(quick.statistics.max_range, full.statistics.max_range);
  EXPECT_TRUE(quick.Scans()[0].ranges.empty());
  EXPECT_EQ(quick.Scans()[1].angle_step, full.Scans()[1].angle_step);
}

TEST(CarmenReaderTest, ManyUnknownNamesTakeNoMemory) {
  std::string text = Flaser(1.0);
  for (int i = 0; i < 5000; ++i) text += "M" + std::to_string(i) + " 1\n";
  const Content content = ReadText(text);
  EXPECT_LE(content.statistics.other_messages.size(), 65U);
  EXPECT_GT(content.statistics.other_messages.at("(others)"), 4900U);
}

TEST(CarmenReaderTest, ATextThatIsNoLogHasNoScan) {
  const Content content = ReadText("This is a letter.\nIt is not a log.\n");
  EXPECT_EQ(content.statistics.scans, 0U);
  EXPECT_TRUE(content.observations.empty());
}

TEST(CarmenReaderTest, AReaderMayBeLeftInTheMiddle) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += Flaser(i);
  const TemporaryFile file(".log", text);
  for (int i = 0; i < 5; ++i) {
    const std::unique_ptr<LogReader> reader = OpenLog(file.path(), {});
    for (int k = 0; k < i * 100; ++k) ASSERT_TRUE(reader->Next());
    EXPECT_LT(reader->Progress(), 1.0);
  }
}

struct RealLog {
  const char* file;
  std::uint64_t scans;
  std::size_t beams;
  double max_range;
  double laser_x;
};
void PrintTo(const RealLog& log, std::ostream* out) { *out << log.file; }

class RealLogTest : public ::testing::TestWithParam<RealLog> {};

TEST_P(RealLogTest, IsReadWhole) {
  const RealLog& log = GetParam();
  const std::string path = std::string(MASKED_MAPPER_REAL_LOGS) + "/data/" + log.file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Content content = ReadAll(path);
  EXPECT_EQ(content.statistics.scans, log.scans);
  EXPECT_EQ(content.statistics.bad_lines, 0U);
  EXPECT_EQ(content.statistics.stamp_jumps, 0U);
  EXPECT_EQ(content.statistics.invalid_ranges, 0U);
  EXPECT_NEAR(content.statistics.max_range, log.max_range, 1e-3);
  for (const LaserScan& scan : content.Scans()) {
    ASSERT_EQ(scan.size(), log.beams);
    ASSERT_NEAR(scan.T_robot_laser.x, log.laser_x, 1e-9);
    ASSERT_TRUE(scan.T_odom_robot);
    for (const float range : scan.ranges) ASSERT_FALSE(range < log.max_range && range > 60.0F);
  }
}

INSTANTIATE_TEST_SUITE_P(All, RealLogTest,
                         ::testing::Values(RealLog{"aces.clf.gz", 7374, 180, 50.0, 0.0},
                                           RealLog{"fr079.clf.gz", 4934, 360, 81.91, -0.04},
                                           RealLog{"mit-csail.clf.gz", 1988, 361, 81.91, 0.0},
                                           RealLog{"malaga-telecom.clf.gz", 225, 361, 80.0, 0.78},
                                           RealLog{"driving-office.clf.gz", 1159, 626, 25.0, 0.16}),
                         [](const ::testing::TestParamInfo<RealLog>& info) {
                           std::string name = info.param.file;
                           name = name.substr(0, name.find('.'));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace masked_mapper
