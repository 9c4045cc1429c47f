// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moved_scans.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"
#include "mapping/same_map.hpp"

namespace masked_mapper {
namespace {

/// A log in memory, that may break off with an error.
class DriveReader final : public LogReader {
 public:
  explicit DriveReader(const RingDrive& drive, std::size_t breaks_at = 1'000'000)
      : drive_(drive), breaks_at_(breaks_at) {}
  std::optional<Observation> Next() override {
    if (next_ == breaks_at_) throw std::runtime_error("broken off");
    if (next_ == drive_.scans.size()) return std::nullopt;
    return drive_.scans[next_++];
  }
  const LogStatistics& Statistics() const override { return statistics_; }
  double Progress() const override {
    return static_cast<double>(next_) / static_cast<double>(drive_.scans.size());
  }

 private:
  const RingDrive& drive_;
  std::size_t breaks_at_;
  std::size_t next_ = 0;
  LogStatistics statistics_;
};

class MovedScansTest : public testing::Test {
 protected:
  MovedScansTest() : drive_(1.3, 0.3) { options_.motion.source = MotionSource::kFused; }

  MaskedMapper Mapper() const { return MaskedMapper("always", options_, floors_); }

  BuildingMap Unbroken() const {
    MaskedMapper mapper = Mapper();
    for (const LaserScan& scan : drive_.scans) mapper.Observe(scan);
    return mapper.Finish();
  }

  RingDrive drive_;
  MappingOptions options_;
  FloorTimeline floors_;
};

TEST_F(MovedScansTest, AreTheSameMadeAheadAndNot) {
  const BuildingMap whole = Unbroken();
  EXPECT_GE(whole.closures.size(), 2U);
  for (const int threads : {1, 2, 8}) {
    MaskedMapper mapper = Mapper();
    DriveReader log(drive_);
    MovedScans scans(log, mapper.motion(), 7, threads);
    std::uint64_t taken = 0;
    while (std::optional<LoggedScan> scan = scans.Next()) {
      ++taken;
      EXPECT_EQ(scan->observations, 7 + taken);
      EXPECT_EQ(scan->progress,
                static_cast<double>(taken) / static_cast<double>(drive_.scans.size()));
      EXPECT_FALSE(scan->motion);
      mapper.Observe(scan->moved);
    }
    EXPECT_EQ(taken, drive_.scans.size());
    EXPECT_FALSE(scans.Next());
    EXPECT_TRUE(SameMap(whole, mapper.Finish())) << threads;
  }
}

TEST_F(MovedScansTest, AStateThatWasAskedForIsThatBehindItsScan) {
  const BuildingMap whole = Unbroken();
  for (const int threads : {1, 2}) {
    for (const std::size_t asked : {std::size_t{1}, drive_.scans.size() / 2}) {
      MaskedMapper mapper = Mapper();
      DriveReader log(drive_);
      MovedScans scans(log, mapper.motion(), 0, threads);
      LoggedScan last;
      std::size_t taken = 0;
      while (!last.motion) {
        std::optional<LoggedScan> scan = scans.Next();
        // All may have been made before the state was asked for.
        if (!scan) {
          scans.AskForState(last);
          continue;
        }
        last = std::move(*scan);
        mapper.Observe(last.moved);
        if (++taken == asked) scans.AskForState(last);
      }
      EXPECT_EQ(last.observations, taken);
      if (threads == 1) {
        EXPECT_EQ(taken, asked);
      }
      MaskedMapper other = Mapper();
      const BuildingMap& so_far = mapper.result();
      other.RestoreState(mapper.SaveState(*last.motion), {so_far.trajectory, so_far.kept_scans});
      for (std::size_t i = 0; i < taken; ++i) other.RememberScan(drive_.scans[i]);
      for (std::size_t i = taken; i < drive_.scans.size(); ++i) other.Observe(drive_.scans[i]);
      EXPECT_TRUE(SameMap(whole, other.Finish())) << threads << " " << asked;
    }
  }
}

TEST_F(MovedScansTest, WhatIsThrownComesBehindTheScansBeforeIt) {
  for (const int threads : {1, 2}) {
    MaskedMapper mapper = Mapper();
    DriveReader log(drive_, 100);
    MovedScans scans(log, mapper.motion(), 0, threads);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(scans.Next());
    EXPECT_THROW(scans.Next(), std::runtime_error);
  }
}

TEST_F(MovedScansTest, ManyThatNobodyTakesHoldNobodyUp) {
  MaskedMapper mapper = Mapper();
  DriveReader log(drive_);
  MovedScans scans(log, mapper.motion(), 0, 2);
  EXPECT_TRUE(scans.Next());
}

}  // namespace
}  // namespace masked_mapper
