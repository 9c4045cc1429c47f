// SPDX-License-Identifier: BSD-3-Clause
#include "log/carmen_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

std::optional<double> Number(const std::string& text) {
  const char* cursor = text.data();
  return ParseNumber(cursor, cursor + text.size());
}

CarmenLine Parse(const std::string& line, bool read_ranges = true) {
  return ParseCarmenLine(line.data(), line.data() + line.size(), read_ranges);
}

std::string Reason(const std::string& line, bool read_ranges = true) {
  const CarmenLine parsed = Parse(line, read_ranges);
  const auto* error = std::get_if<CarmenError>(&parsed);
  return error == nullptr ? "" : error->reason;
}

TEST(ParseNumberTest, ReadsWhatTheStandardLibraryReadsToTheLastBit) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const int decimals = static_cast<int>(random() % 12);
    const double scale = std::pow(10.0, static_cast<int>(random() % 14) - 3);
    const double value = (static_cast<double>(random()) / 2147483648.0 - 1.0) * scale;
    char text[64];
    std::snprintf(text, sizeof(text), i % 5 == 0 ? "%.*e" : "%.*f", decimals, value);
    EXPECT_EQ(Number(text), std::strtod(text, nullptr)) << text;
  }
}

TEST(ParseNumberTest, ReadsUnusualSpellings) {
  EXPECT_EQ(Number("+1.5"), 1.5);
  EXPECT_EQ(Number(".5"), 0.5);
  EXPECT_EQ(Number("5."), 5.0);
  EXPECT_EQ(Number("-0"), 0.0);
  EXPECT_EQ(Number("1e3"), 1000.0);
  EXPECT_EQ(Number("12345678901234567890123"), 12345678901234567890123.0);
  EXPECT_EQ(Number("0.1000000000000000055511151231257827"), 0.1);
  EXPECT_EQ(Number("inf"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(*Number("nan")));
  EXPECT_EQ(Number("1e999"), std::numeric_limits<double>::max());
  EXPECT_EQ(Number("-1e999"), -std::numeric_limits<double>::max());
}

TEST(ParseNumberTest, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"", " ", "-", "+", ".", "abc", "1,5", "1.5x", "1.2.3", "--1", "0x10", "e5"}) {
    EXPECT_FALSE(Number(text)) << text;
  }
}

TEST(ParseCarmenLineTest, ReadsFlaser) {
  const CarmenLine line = Parse("FLASER 3 1.5 2.25 81.91 0.1 0.2 0.3 0.4 0.5 0.6 12.5 host 1.0\r");
  const auto& scan = std::get<CarmenScan>(line);
  EXPECT_TRUE(scan.is_flaser);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.5F, 2.25F, 81.91F}));
  EXPECT_EQ(scan.T_odom_laser.y, 0.2);
  EXPECT_EQ(scan.T_odom_robot.theta, 0.6);
  EXPECT_EQ(scan.stamp, 12.5);
}

TEST(ParseCarmenLineTest, ReadsRobotLaserWithRemissions) {
  const CarmenLine line = Parse(
      "ROBOTLASER1 0 -1.57 3.14 1.57 80.0 0.01 0 3 1 2 3 2 7 8 0.78 0 0.1 0.5 0.6 0.7 1 2 3 4 5 "
      "9.5 h 1");
  const auto& scan = std::get<CarmenScan>(line);
  EXPECT_FALSE(scan.is_flaser);
  EXPECT_EQ(scan.ranges.size(), 3U);
  EXPECT_EQ(scan.start_angle, -1.57);
  EXPECT_EQ(scan.maximum_range, 80.0);
  EXPECT_EQ(scan.T_odom_laser.x, 0.78);
  EXPECT_EQ(scan.T_odom_robot.theta, 0.7);
  EXPECT_EQ(scan.stamp, 9.5);
}

TEST(ParseCarmenLineTest, WithoutRangesTheRestIsTheSame) {
  for (const std::string line : {"FLASER 3 1.5 2.25 81.91 0.1 0.2 0.3 0.4 0.5 0.6 12.5 host 1.0",
                                 "ROBOTLASER1 0 -1.57 3.14 1.57 80.0 0.01 0 3 1 2 3 2 7 8 0.78 0 "
                                 "0.1 0.5 0.6 0.7 1 2 3 4 5 9.5 h 1"}) {
    const auto full = std::get<CarmenScan>(Parse(line));
    const auto quick = std::get<CarmenScan>(Parse(line, false));
    EXPECT_TRUE(quick.ranges.empty());
    EXPECT_EQ(quick.beams, full.beams);
    EXPECT_EQ(quick.stamp, full.stamp);
    EXPECT_EQ(quick.T_odom_laser.AsVector(), full.T_odom_laser.AsVector());
    EXPECT_EQ(quick.T_odom_robot.AsVector(), full.T_odom_robot.AsVector());
  }
}

TEST(ParseCarmenLineTest, SaysHowManyRangesThereAre) {
  const std::string tail = " 0 0 0 0 0 0 12.5 host 1.0";
  EXPECT_EQ(Reason("FLASER 3 1 2" + tail), "FLASER: expected 3 ranges, found 2");
  EXPECT_EQ(Reason("FLASER 3 1 2 3 4" + tail), "FLASER: expected 3 ranges, found 4");
  EXPECT_EQ(Reason("FLASER 3 1 2" + tail, false), "FLASER: expected 3 ranges, found 2");
  EXPECT_EQ(Reason("FLASER 3 1 2"), "FLASER: the line is cut");
  EXPECT_EQ(Reason("FLASER"), "FLASER: no number of ranges");
  EXPECT_NE(Reason("FLASER 0" + tail), "");
  EXPECT_NE(Reason("FLASER -3 1 2 3" + tail), "");
  EXPECT_NE(Reason("FLASER 99999999999999999999 1 2 3" + tail), "");
  EXPECT_NE(Reason("FLASER 4000000000 1 2 3" + tail), "");
}

TEST(ParseCarmenLineTest, RefusesFieldsThatAreNoMeasurement) {
  EXPECT_NE(Reason("FLASER 2 1 abc 0 0 0 0 0 0 12.5 host 1.0"), "");
  EXPECT_NE(Reason("FLASER 2 1 2 0 0 0 nan 0 0 12.5 host 1.0"), "");
  EXPECT_NE(Reason("FLASER 2 1 2 0 0 0 0 0 0 inf host 1.0"), "");
  EXPECT_NE(Reason("ODOM 1e300 0 0 0 0 0 12.5 host 1.0"), "");
  EXPECT_NE(Reason("ODOM 1 0 0 0 0 0 12.5 host"), "");
  EXPECT_NE(Reason("ODOM 1 0 0 0 0 0 12.5 host 1.0 surplus"), "");
  EXPECT_NE(Reason("PRESSURE high 1 h 1"), "");
  EXPECT_NE(Reason("ACCEL 0 0 1 h 1"), "");
  EXPECT_NE(Reason("FLOOR ../x 1 h 1"), "");
  EXPECT_NE(Reason("FLOOR .. 1 h 1"), "");
  EXPECT_NE(Reason("*** garbage"), "");
}

TEST(ParseCarmenLineTest, KeepsOddRangesForTheCalibrationToJudge) {
  const auto scan =
      std::get<CarmenScan>(Parse("FLASER 4 nan -1 inf 1e300 0 0 0 0 0 0 12.5 host 1.0"));
  EXPECT_TRUE(std::isnan(scan.ranges[0]));
  EXPECT_EQ(scan.ranges[1], -1.0F);
  EXPECT_EQ(scan.ranges[2], std::numeric_limits<float>::infinity());
  EXPECT_EQ(scan.ranges[3], std::numeric_limits<float>::max());
}

TEST(ParseCarmenLineTest, ReadsOurOwnLinesAndNamesTheOthers) {
  EXPECT_EQ(std::get<PressureReading>(Parse("PRESSURE 101325.5 7 h 7")).pressure_pa, 101325.5);
  EXPECT_EQ(
      std::get<AccelerationReading>(Parse("ACCEL 0.1 0.2 9.8 7 h 7")).acceleration_in_robot.z(),
      9.8);
  EXPECT_EQ(std::get<FloorLabel>(Parse("FLOOR 2nd-floor 7 h 7")).label, "2nd-floor");
  EXPECT_EQ(std::get<FloorLabel>(Parse("FLOOR - 7 h 7")).label, "-");
  EXPECT_EQ(std::get<CarmenParam>(Parse("PARAM robot_use_laser on 1 h 1")).value, "on");
  EXPECT_EQ(std::get<CarmenOther>(Parse("TRUEPOS 1 2 3")).name, "TRUEPOS");
  EXPECT_TRUE(std::holds_alternative<CarmenNothing>(Parse("# FLASER 3")));
  EXPECT_TRUE(std::holds_alternative<CarmenNothing>(Parse("  \t\r")));
}

// Whatever a line holds, it is read or refused; sanitizers watch over this test.
TEST(ParseCarmenLineTest, SurvivesCutAndGarbledLines) {
  const std::string line =
      "ROBOTLASER1 0 -1.57 3.14 1.57 80.0 0.01 0 3 1 2 3 2 7 8 0.78 0 0.1 0.5 0.6 0.7 1 2 3 4 5 "
      "9.5 h 1";
  for (std::size_t length = 0; length < line.size(); ++length) {
    const CarmenLine cut = Parse(line.substr(0, length));
    EXPECT_FALSE(std::holds_alternative<CarmenScan>(cut)) << length;
  }
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    std::string garbled = line;
    for (int k = 0; k < 3; ++k) garbled[random() % garbled.size()] = static_cast<char>(random());
    Parse(garbled, i % 2 == 0);
  }
}

}  // namespace
}  // namespace masked_mapper
