// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/lanes.hpp"

#include <gtest/gtest.h>

#include "routing/two_floors.hpp"

namespace masked_mapper {
namespace {

BuildingMap MapOfFourFloors() {
  BuildingMap map;
  for (const char* label : {"0", "1", "2", "3"}) {
    map.graph.AddFloor({label, 3.0 * label[0], 0.1, true, false});
  }
  map.graph.AddNode({});
  map.drives.push_back({});
  return map;
}

TEST(Crossings, ACabIsOneWhereItStoodAtOnePlace) {
  BuildingMap map = TwoFloors();
  Drive(map, 1, 3.4, 0.7);
  Drive(map, 1, 3.4, 0.7, true);
  Drive(map, 2, 3.4, 0.7);  // by the same cab to the roof
  Drive(map, 2, 9.0, 0.7);
  Drive(map, 2, 9.0, 0.7, true);
  Drive(map, 0, 9.0, 0.7);  // and down by another
  const std::vector<Crossing> crossings = CrossingsOf(map);
  ASSERT_EQ(crossings.size(), 2U);
  ASSERT_EQ(crossings[0].stops.size(), 3U);
  EXPECT_EQ(crossings[0].kind, CrossingKind::kElevator);
  EXPECT_EQ(crossings[0].stops[0].floor, 1);  // the lowest
  EXPECT_EQ(crossings[0].stops[2].floor, 2);
  EXPECT_EQ(crossings[1].stops.size(), 2U);
}

TEST(Crossings, AShaftHasOneCabOnAllFloors) {
  BuildingMap map = MapOfFourFloors();
  const auto ride = [&](FloorId from, FloorId to, double x) {
    Drive(map, from, x, 1.0);
    Drive(map, from, x, 1.0, true);
    Drive(map, to, x, 1.0);
  };
  ride(0, 1, 1.0);
  ride(1, 2, 20.0);
  ride(2, 3, 1.3);  // no floor was come to by the first cab and left by it
  const std::vector<Crossing> crossings = CrossingsOf(map);
  ASSERT_EQ(crossings.size(), 2U);
  EXPECT_EQ(crossings[0].stops.size(), 4U);
  EXPECT_EQ(crossings[1].stops.size(), 2U);
}

TEST(Crossings, ARideMayShowThatTwoCabsAreOne) {
  BuildingMap map = MapOfFourFloors();
  const auto ride = [&](FloorId from, FloorId to, double x) {
    Drive(map, from, x, 1.0);
    Drive(map, from, x, 1.0, true);
    Drive(map, to, x, 1.0);
    Drive(map, to, 20.0, 1.0);
  };
  ride(0, 1, 1.0);
  ride(2, 3, 2.6);  // at the other side of the cab
  ride(1, 2, 1.8);
  // From 20 m off to the next ride's start no floor changes in transit but by the wheels: walked.
  const std::vector<Crossing> crossings = CrossingsOf(map);
  const auto cabs = std::count_if(crossings.begin(), crossings.end(), [](const Crossing& crossing) {
    return crossing.kind == CrossingKind::kElevator;
  });
  ASSERT_EQ(cabs, 1);
  EXPECT_EQ(crossings.front().stops.size(), 4U);
}

TEST(Crossings, WhatWasTravelledIsNoCab) {
  BuildingMap map = TwoFloors();
  Drive(map, 1, 0.5, 0.5, true);
  Drive(map, 1, 0.5, 4.5, true);
  Drive(map, 2, 0.5, 5.0);
  Drive(map, 2, 0.6, 5.0, true);  // and down again by the same
  Drive(map, 1, 0.5, 0.6);
  const std::vector<Crossing> crossings = CrossingsOf(map);
  ASSERT_EQ(crossings.size(), 2U);
  EXPECT_EQ(crossings[1].kind, CrossingKind::kStairs);
  EXPECT_EQ(crossings[1].stops.front().floor, 1);
  EXPECT_EQ(crossings[1].way.front(), Eigen::Vector2d(0.55, 1.65));
  EXPECT_EQ(crossings[1].way.back(), Eigen::Vector2d(0.5, 5.0));
}

TEST(Crossings, AMapWithoutAnythingHasNone) { EXPECT_TRUE(CrossingsOf(BuildingMap{}).empty()); }

}  // namespace
}  // namespace masked_mapper
