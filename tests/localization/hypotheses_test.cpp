// SPDX-License-Identifier: BSD-3-Clause
#include "localization/hypotheses.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "localization/room_drive.hpp"

namespace masked_mapper {
namespace {

constexpr int kScans = 320;      // once round, on each floor
constexpr double kStorey = 3.0;  // m

/// With a wall on one side of it, so that it is not taken for itself turned round.
Walls OneSidedRoom() {
  Walls room = Room(24.0, 16.0);
  room.push_back({{17.0, 2.0}, {17.0, 13.0}});
  room.push_back({{13.5, 11.0}, {17.0, 13.0}});
  return room;
}

/// So many floors, one as the other.
BuildingMap MapOfTower(const Walls& room, std::size_t storeys) {
  FloorTimeline floors;
  floors.levels.clear();
  floors.intervals.clear();
  for (std::size_t level = 0; level < storeys; ++level) {
    FloorLevel known;
    known.elevation = kStorey * static_cast<double>(level);
    floors.levels.push_back(known);
    FloorInterval interval;
    interval.start = 0.2 * kScans * static_cast<double>(level);
    interval.level = level;
    floors.intervals.push_back(interval);
  }
  return MapOf(Drive(room, 0, static_cast<int>(storeys) * kScans, 0.0), floors);
}

class HypothesesTest : public testing::Test {
 protected:
  explicit HypothesesTest(std::size_t storeys = 3) : map_(MapOfTower(room_, storeys)) {}
  void SetUp() override { hypotheses_.Restart(0); }

  /// Drives on by so many scans; whether a place is believed at the end.
  const Hypothesis* DriveOn(int scans) {
    const std::vector<LaserScan> log = Drive(room_, 130, driven_ + scans, 1e5);
    for (int i = driven_; i < driven_ + scans; ++i) {
      const LaserScan& scan = log[static_cast<std::size_t>(i)];
      stretch_.Add(scan, *scan.T_odom_robot);
      if (i % 10 == 9) hypotheses_.Step(stretch_, static_cast<std::size_t>(i), std::nullopt);
    }
    driven_ += scans;
    return hypotheses_.Believed();
  }

  Walls room_ = OneSidedRoom();
  BuildingMap map_;
  KnownMap known_{map_, UsualFloorSearch()};
  Hypotheses hypotheses_{known_, EvidenceOptions()};
  Stretch stretch_;
  int driven_ = 0;
};

class HypothesesOnOneFloorTest : public HypothesesTest {
 protected:
  HypothesesOnOneFloorTest() : HypothesesTest(1) {}
};

// Nothing that the map knows contradicts a robot off the map; it is dear to be there.
TEST_F(HypothesesOnOneFloorTest, APlaceOffTheMapDoesNotKeepTheRightOneFromBeingBelieved) {
  constexpr double kAway = 300.0;  // m
  hypotheses_.Suggest(0, {kAway, kAway, 0.0}, -known_.LogPlaces());
  const Hypothesis* found = DriveOn(240);
  ASSERT_NE(found, nullptr) << hypotheses_.Description();
  EXPECT_LT(found->T_world_odom.Translation().norm(), 30.0);
}

// Floors that look alike are told apart by a ride alone; then they stay so, though all of them are
// found again.
TEST_F(HypothesesTest, OfAlikeFloorsARideTellsWhich) {
  EXPECT_EQ(DriveOn(240), nullptr);
  ASSERT_GE(hypotheses_.all().size(), 3U);
  hypotheses_.Ride(2.0 * kStorey, 0.2, static_cast<std::size_t>(driven_));
  const Hypothesis* found = DriveOn(240);
  ASSERT_NE(found, nullptr) << hypotheses_.Description();
  EXPECT_EQ(found->floor, 2);
}

// One storey up leaves two floors open.
TEST_F(HypothesesTest, ARideThatMayHaveEndedOnTwoFloorsTellsNeither) {
  EXPECT_EQ(DriveOn(240), nullptr);
  hypotheses_.Ride(kStorey, 0.2, static_cast<std::size_t>(driven_));
  EXPECT_EQ(DriveOn(240), nullptr);
}

// A floor that was said holds where rides from there lead, and no longer than the place does.
TEST_F(HypothesesTest, AFloorThatWasSaidHoldsUntilNobodyKnowsAnyMore) {
  hypotheses_.KeepFloor(0);
  const Hypothesis* found = DriveOn(240);
  ASSERT_NE(found, nullptr) << hypotheses_.Description();
  EXPECT_EQ(found->floor, 0);
  hypotheses_.Ride(kStorey, 0.2, static_cast<std::size_t>(driven_));
  found = DriveOn(60);
  ASSERT_NE(found, nullptr) << hypotheses_.Description();
  EXPECT_EQ(found->floor, 1);
  hypotheses_.Ride(std::nullopt, 0.0, static_cast<std::size_t>(driven_));
  EXPECT_EQ(DriveOn(60), nullptr);
  hypotheses_.KeepFloor(2);
  found = DriveOn(60);
  ASSERT_NE(found, nullptr) << hypotheses_.Description();
  EXPECT_EQ(found->floor, 2);
  // Carried off: anywhere again.
  hypotheses_.Restart(static_cast<std::size_t>(driven_));
  stretch_.Restart();
  EXPECT_EQ(DriveOn(240), nullptr);
  EXPECT_GE(hypotheses_.all().size(), 3U);
}

// A search of one floor has not looked at others.
TEST_F(HypothesesTest, ASearchOfOneFloorIsNoneOfOthers) {
  hypotheses_.KeepFloor(0);
  ASSERT_NE(DriveOn(240), nullptr);
  hypotheses_.Ride(std::nullopt, 0.0, static_cast<std::size_t>(driven_));
  EXPECT_EQ(hypotheses_.Believed(), nullptr);
  EXPECT_EQ(DriveOn(240), nullptr);
  for (const Hypothesis& one : hypotheses_.all()) {
    EXPECT_GE(one.prior_nats, -known_.LogPlaces()) << "floor " << one.floor;
  }
}

}  // namespace
}  // namespace masked_mapper
