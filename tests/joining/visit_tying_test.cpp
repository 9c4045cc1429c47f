// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"

namespace masked_mapper {
namespace {

/// Twice and more round a ring, with a short while on another floor in between, and nothing closed
/// on the way.
BuildingMap OpenMapOfThreeVisits(const RingDrive& drive) {
  const auto stamp = [&](double share) {
    return drive.scans[static_cast<std::size_t>(share * static_cast<double>(drive.scans.size()))]
        .stamp;
  };
  FloorTimeline floors;
  floors.levels.push_back({"", 3.5, 0.1, true, true, ""});
  floors.intervals.push_back({stamp(0.44), 0, true});
  floors.intervals.push_back({stamp(0.445), 1, true});
  floors.intervals.push_back({stamp(0.45), 1, false});
  floors.intervals.push_back({stamp(0.50), 1, true});
  floors.intervals.push_back({stamp(0.505), 0, true});
  floors.intervals.push_back({stamp(0.51), 0, false});
  for (FloorInterval& interval : floors.intervals) interval.travelled_m = 5.0;  // stairs
  MappingOptions options;
  options.motion.source = MotionSource::kFused;
  options.closures.candidates.max_matches = 0;
  options.closures.polish.revisits.distance_m = 0.0;
  MaskedMapper mapper("openings", options, floors);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  BuildingMap map = mapper.Finish();
  map.drives.emplace_back();
  return map;
}

std::size_t Closed(const BuildingMap& map) {
  return static_cast<std::size_t>(
      std::count_if(map.graph.edges().begin(), map.graph.edges().end(),
                    [](const Edge& edge) { return edge.kind == EdgeKind::kClosure; }));
}

TEST(TieVisits, WhatStayedOpenIsTiedAndRight) {
  const RingDrive drive(2.4, 0.2);
  BuildingMap map = OpenMapOfThreeVisits(drive);
  ASSERT_EQ(Closed(map), 0U);
  TieVisits({}, {}, map);
  EXPECT_GT(Closed(map), 0U);
  for (std::size_t i = 0; i < drive.truth.size(); i += 20) {
    EXPECT_LT(Distance(drive.truth[i], map.trajectory[i].T_world_robot), 0.5) << "m, scan " << i;
  }
}

TEST(TieVisits, OneVisitStaysAsItIs) {
  const RingDrive drive(1.1, 0.2);
  MappingOptions options;
  options.motion.source = MotionSource::kFused;
  const FloorTimeline one_floor;
  MaskedMapper mapper("openings", options, one_floor);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  BuildingMap map = mapper.Finish();
  map.drives.emplace_back();
  const std::size_t closures = map.closures.size();
  TieVisits({}, {}, map);
  EXPECT_EQ(map.closures.size(), closures);
}

TEST(TieVisits, NothingIsNothing) {
  BuildingMap map;
  TieVisits({}, {}, map);
  EXPECT_TRUE(map.closures.empty());
}

}  // namespace
}  // namespace masked_mapper
