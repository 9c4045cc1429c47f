// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"

namespace masked_mapper {
namespace {

/// Once round, a short while on a level not known, and on, on another not known.
FloorTimeline ThreeVisits(const RingDrive& drive) {
  const auto stamp = [&](double share) {
    return drive.scans[static_cast<std::size_t>(share * static_cast<double>(drive.scans.size()))]
        .stamp;
  };
  FloorTimeline floors;
  floors.levels.push_back({"", 3.5, 3.5, false, false, ""});
  floors.levels.push_back({"", 7.0, 3.5, false, false, ""});
  floors.intervals.push_back({stamp(0.44), 0, true});
  floors.intervals.push_back({stamp(0.445), 1, true});
  floors.intervals.push_back({stamp(0.45), 1, false});
  floors.intervals.push_back({stamp(0.50), 1, true});
  floors.intervals.push_back({stamp(0.505), 2, true});
  floors.intervals.push_back({stamp(0.51), 2, false});
  for (FloorInterval& interval : floors.intervals) interval.travelled_m = 5.0;  // stairs
  return floors;
}

BuildingMap MapOf(const std::vector<LaserScan>& scans, const FloorTimeline& floors) {
  MappingOptions options;
  options.motion.source = MotionSource::kFused;
  MaskedMapper mapper("openings", options, floors);
  for (const LaserScan& scan : scans) mapper.Observe(scan);
  return mapper.Finish();
}

TEST(JoinFloors, AFloorMetAgainIsOneFloor) {
  const RingDrive drive(2.4, 0.2);
  const FloorTimeline floors = ThreeVisits(drive);
  ASSERT_TRUE(HasUnknownFloors(floors));
  const FloorJoining joining = JoinFloors(MapOf(drive.scans, floors), floors, {}, {}, {});
  EXPECT_TRUE(joining.any_joined);
  EXPECT_EQ(joining.notes.size(), 1u);
  // The level in the middle was reached from the first, and is another.
  ASSERT_EQ(joining.floors.levels.size(), 2u);
  EXPECT_FALSE(HasUnknownFloors(joining.floors));
  EXPECT_DOUBLE_EQ(joining.floors.levels[1].elevation, 3.5);
  ASSERT_EQ(joining.floors.intervals.size(), floors.intervals.size());
  for (std::size_t i = 0; i < floors.intervals.size(); ++i) {
    EXPECT_EQ(joining.floors.intervals[i].level,
              floors.intervals[i].level == 1 ? std::size_t{1} : std::size_t{0});
    EXPECT_EQ(joining.floors.intervals[i].start, floors.intervals[i].start);
  }
}

TEST(JoinFloors, WhatAClimbTiesToAFloorMetAgainIsKnownWithIt) {
  const RingDrive drive(2.4, 0.2);
  FloorTimeline floors = ThreeVisits(drive);
  for (FloorInterval& interval : floors.intervals) {
    if (interval.in_transit && interval.start > floors.intervals[3].start) {
      interval.climb = -4.2;
      interval.climb_sigma = 0.1;
    }
  }
  floors.intervals[4].climb = -4.2;
  floors.intervals[4].climb_sigma = 0.1;
  const FloorJoining joining = JoinFloors(MapOf(drive.scans, floors), floors, {}, {}, {});
  ASSERT_EQ(joining.floors.levels.size(), 2u);
  EXPECT_NEAR(joining.floors.levels[1].elevation, 4.2, 1e-9);
  EXPECT_TRUE(joining.floors.levels[1].elevation_measured);
  EXPECT_TRUE(joining.floors.levels[1].open.empty());
}

TEST(JoinFloors, AnotherFloorAtTheSamePlaceStaysApart) {
  RingDrive drive(2.4, 0.2);
  const FloorTimeline floors = ThreeVisits(drive);
  // As wide a ring, but its corridors are wider to the other side and have other niches.
  BoxScene other;
  other.AddBox(-1.2, -1.2, 27.2, 19.2);
  other.AddBox(2.0, 2.0, 24.0, 16.0);
  for (double x = 3.0; x < 24.0; x += 5.3) other.AddBox(x, -1.2, x + 1.4, -0.5);
  for (double y = 2.0; y < 16.0; y += 4.7) other.AddBox(26.4, y, 27.2, y + 1.9);
  std::mt19937 random(5);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    LaserScan& scan = drive.scans[i];
    if (floors.At(scan.stamp).level != 2) continue;
    const LaserScan seen =
        other.Scan(Pose2{1.0, 1.0, 0.0} * drive.truth[i], 181, 270.0, &random, 0.01);
    scan.ranges = seen.ranges;
  }
  const FloorJoining joining = JoinFloors(MapOf(drive.scans, floors), floors, {}, {}, {});
  EXPECT_FALSE(joining.any_joined);
  EXPECT_EQ(joining.floors.levels.size(), 3u);
  EXPECT_FALSE(HasUnknownFloors(joining.floors)) << "it was looked at, and is another";
}

// Of floors of one plan any may be the one met again.
TEST(JoinFloors, AFloorThatAnotherIsAsLikeIsNotTakenForMetAgain) {
  const RingDrive drive(2.4, 0.2);
  FloorTimeline floors = ThreeVisits(drive);
  const auto stamp = [&](double share) {
    return drive.scans[static_cast<std::size_t>(share * static_cast<double>(drive.scans.size()))]
        .stamp;
  };
  // The last visit goes on to yet another level: that is not the one before, and looks like it.
  floors.levels.push_back({"", 10.5, 3.5, false, false, ""});
  floors.intervals.push_back({stamp(0.75), 2, true, 5.0});
  floors.intervals.push_back({stamp(0.755), 3, true, 5.0});
  floors.intervals.push_back({stamp(0.76), 3, false});
  const FloorJoining joining = JoinFloors(MapOf(drive.scans, floors), floors, {}, {}, {});
  EXPECT_FALSE(joining.any_joined);
  ASSERT_EQ(joining.floors.levels.size(), 4U);
  EXPECT_NE(joining.floors.levels[2].open.find("looks like floor 0"), std::string::npos)
      << joining.floors.levels[2].open;
  EXPECT_FALSE(joining.floors.levels[3].open.empty());
}

TEST(JoinFloors, KnownFloorsAndEmptyMapsAreLeftAlone) {
  const FloorTimeline one;
  EXPECT_FALSE(HasUnknownFloors(one));
  EXPECT_FALSE(JoinFloors({}, one, {}, {}, {}).any_joined);
  FloorTimeline unknown;
  unknown.levels.push_back({"", 3.5, 3.5, false, false, ""});
  unknown.levels.push_back({"", 7.0, 3.5, false, false, ""});
  const FloorJoining joining = JoinFloors({}, unknown, {}, {}, {});
  EXPECT_FALSE(joining.any_joined);
  EXPECT_EQ(joining.floors.levels.size(), 3u);
}

}  // namespace
}  // namespace masked_mapper
