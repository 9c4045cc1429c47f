// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "doubt/screened_map.hpp"
#include "masked_mapper/doubt/doubt.hpp"

namespace masked_mapper {
namespace {

TEST(FindUnnoticedChanges, WithoutAWayThroughAWallThereAreNone) {
  EXPECT_TRUE(FindUnnoticedChanges(RightMap(), {}).empty());
  EXPECT_TRUE(FindUnnoticedChanges({}, {}).empty());
}

TEST(FindUnnoticedChanges, OneDoorThatWasOpenedIsNoFloor) {
  EXPECT_TRUE(FindUnnoticedChanges(MapWithScreens().map, {}).empty());
}

TEST(FindUnnoticedChanges, AreThoseBetweenTheWallAndTheWayThroughIt) {
  MapWithScreens screened;
  const std::size_t foot = screened.last_seen + 10;
  const std::size_t head = screened.DriveUpAndBack(foot, 1.5);
  ASSERT_LT(head, screened.crossed);
  const std::vector<TimeSpan> found = FindUnnoticedChanges(screened.map, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].start, screened.StampOf(foot));
  EXPECT_EQ(found[0].end, screened.StampOf(head - 1));
}

TEST(FindUnnoticedChanges, AreNoneWhereABarometerListened) {
  MapWithScreens screened;
  const std::size_t foot = screened.last_seen + 10;
  const double head = screened.StampOf(screened.DriveUpAndBack(foot, 1.5));
  const double begin = screened.StampOf(foot);
  EXPECT_TRUE(FindUnnoticedChanges(screened.map, {{begin - 1.0, head}}).empty());
  EXPECT_EQ(FindUnnoticedChanges(screened.map, {{0.0, begin + 1.0}, {head, 1e9}}).size(), 1U);
}

TEST(FindUnnoticedChanges, AreNotThoseDrivenBefore) {
  MapWithScreens screened;
  ASSERT_LT(screened.DriveUpAndBack(5, 1.5), screened.last_seen);
  EXPECT_TRUE(FindUnnoticedChanges(screened.map, {}).empty());
}

TEST(FindUnnoticedChanges, ARoomThatIsLeftAsItWasEnteredIsNone) {
  MapWithScreens screened;
  ASSERT_LT(screened.DriveUpAndBack(screened.last_seen + 10, 0.3), screened.crossed);
  EXPECT_TRUE(FindUnnoticedChanges(screened.map, {}).empty());
}

// A door opened says as much as one wall; two say that the robot rode.
TEST(FindUnnoticedChanges, AStandAsInACabIsOneWhereTwoWallsWereDrivenThrough) {
  MapWithScreens one(1);
  ASSERT_LT(one.StandAsInACab(one.last_seen + 10, 12.0), one.crossed);
  EXPECT_TRUE(FindUnnoticedChanges(one.map, {}).empty());
  MapWithScreens two(2);
  const std::size_t in = two.last_seen + 10;
  const std::size_t out = two.StandAsInACab(in, 12.0);
  ASSERT_LT(out, two.crossed);
  const std::vector<TimeSpan> found = FindUnnoticedChanges(two.map, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].start, two.StampOf(in));
  EXPECT_LT(found[0].end, two.StampOf(out));
  EXPECT_GT(found[0].end, two.StampOf(out) - 2.0);
}

TEST(FindUnnoticedChanges, AShortHaltIsNoRide) {
  MapWithScreens two(2);
  ASSERT_LT(two.StandAsInACab(two.last_seen + 10, 4.0), two.crossed);
  EXPECT_TRUE(FindUnnoticedChanges(two.map, {}).empty());
}

}  // namespace
}  // namespace masked_mapper
