// SPDX-License-Identifier: BSD-3-Clause
// Bags whose sensors or recorders lie, each in one way: the right value is read all the same, and
// said.
#include <gtest/gtest.h>

#include <limits>

#include "log/bag_drive.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper::bag_drive {
namespace {

TEST(BagEvidenceTest, OfASoundBagNothingIsFoundAndItIsReadOnce) {
  const Read read = ReadBag(Drive{}.Whole());
  ExpectTheDrive(read);
  EXPECT_EQ(read.passes, 1);
  EXPECT_TRUE(read.findings.empty()) << TextOf(read.findings.front());
}

TEST(BagEvidenceTest, WholeTopicsOneAfterTheOtherAreReadInOrder) {
  const Drive drive;
  std::string records;
  for (int i = 0; i < kScans; ++i) records += drive.ScanOf(i);
  records += drive.Mount();
  for (int i = 0; i < kScans; ++i) records += drive.OdometryOf(i);
  const Read read = ReadBag(Drive::Bag(records));
  ExpectTheDrive(read);
  ASSERT_EQ(read.findings.size(), 1U);
}

TEST(BagEvidenceTest, OdometryIsFoundInTfByWhatMoves) {
  Drive drive;
  drive.odometry_frame = "odom_combined";
  ExpectTheDrive(ReadBag(drive.Whole()));
  drive.odometry_frame = "map";
  EXPECT_FALSE(ReadBag(drive.Whole()).scans.front().T_odom_robot) << "put right by a map";
}

TEST(BagEvidenceTest, TheFrameOfOdometryMayBeNamed) {
  Drive drive;
  drive.odometry_frame = "map";
  LogOptions options;
  options.odom_frame = "map";
  ExpectTheDrive(ReadBag(drive.Whole(), options));
  options.odom_frame = "odom";
  try {
    ReadBag(drive.Whole(), options);
    FAIL() << "there is no such frame";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no frame `odom` above `"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("map"), std::string::npos) << error.what();
  }
}

TEST(BagEvidenceTest, AMountIsTakenFromWhereverItStands) {
  Drive drive;
  drive.mount_comes = kBegin + 35.0;
  ExpectTheDrive(ReadBag(drive.Whole()));
}

TEST(BagEvidenceTest, AClockIsSettledByTheMany) {
  Drive drive;
  drive.spoil = [](int i, ScanSpec* scan) {
    if (i < 30) scan->stamp = 100.0 + kPeriod * i;  // counted from the power-on
  };
  const Read read = ReadBag(drive.Whole());
  ExpectTheDrive(read);
  EXPECT_NEAR(read.scans.front().log_stamp, 100.0, 1e-6);
  ASSERT_EQ(read.findings.size(), 1U);
  EXPECT_NEAR(read.findings.front().value, 30.0 / kScans, 1e-6);
  EXPECT_NEAR(read.findings.front().t_a, StampOfScan(0), 0.1);
  EXPECT_NEAR(read.findings.front().t_b, StampOfScan(29), 0.1);
}

TEST(BagEvidenceTest, WholeSecondsAreSpread) {
  Drive drive;
  drive.spoil = [](int, ScanSpec* scan) { scan->stamp = std::floor(scan->stamp); };
  const Read read = ReadBag(drive.Whole());
  ExpectTheDrive(read, 0.1);
  EXPECT_EQ(read.findings.size(), 1U);
}

TEST(BagEvidenceTest, OfTwoDriversOnOneTopicTheUsefulOneIsTaken) {
  Drive drive;
  std::string records = drive.Mount();
  for (int i = 0; i < kScans; ++i) {
    ScanSpec blind;
    blind.stamp = StampOfScan(i) - 0.05;
    blind.frame = "blind";
    blind.ranges.assign(40, std::numeric_limits<float>::infinity());
    records += drive.OdometryOf(i) + Record(1, blind.stamp, ScanBytes(blind)) + drive.ScanOf(i);
  }
  const Read read = ReadBag(Drive::Bag(records));
  ExpectTheDrive(read);
  ASSERT_EQ(read.findings.size(), 1U);
  EXPECT_EQ(read.findings.front().value, kScans);
}

TEST(BagEvidenceTest, RangesAreJudgedByThemselves) {
  Drive drive;
  drive.spoil = [](int, ScanSpec* scan) { scan->range_min = 5.5F; };
  Read read = ReadBag(drive.Whole());
  ExpectTheDrive(read);
  EXPECT_EQ(read.findings.size(), 1U);
  for (const float range_max : {30.0F, 30000.0F}) {
    drive.spoil = [range_max](int, ScanSpec* scan) {
      scan->range_max = range_max;
      for (float& range : scan->ranges) range *= 1000.0F;
    };
    read = ReadBag(drive.Whole());
    ExpectTheDrive(read);
    ASSERT_EQ(read.findings.size(), 1U);
    EXPECT_EQ(read.findings.front().value, 0.001);
  }
  // What is part of the robot stays where it is, and is rightly cut off.
  drive.spoil = [](int, ScanSpec* scan) {
    scan->range_min = 0.5F;
    for (std::size_t beam = 0; beam < 10; ++beam) scan->ranges[beam] = 0.3F;
  };
  read = ReadBag(drive.Whole());
  EXPECT_TRUE(std::isnan(read.scans[7].ranges[3]));
  EXPECT_TRUE(read.findings.empty());
}

}  // namespace
}  // namespace masked_mapper::bag_drive
