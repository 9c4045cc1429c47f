// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/masked_mapper.hpp"

#include <gtest/gtest.h>

#include "loop_closure/open_revisits.hpp"
#include "mapping/ring_drive.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

MappingOptions OptionsFor(MotionSource source) {
  MappingOptions options;
  options.motion.source = source;
  return options;
}

BuildingMap Map(const RingDrive& drive, const std::string& mask, const MappingOptions& options,
                const FloorTimeline& floors = {}) {
  MaskedMapper mapper(mask, options, floors);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  return mapper.Finish();
}

std::size_t Validated(const BuildingMap& map) {
  std::size_t count = 0;
  for (const Closure& closure : map.closures) {
    count += closure.state == ClosureState::kValidated;
  }
  return count;
}

TEST(MaskedMapper, NeverIsDeadReckoning) {
  const RingDrive drive(1.0, 0.3);
  const BuildingMap map = Map(drive, "never", OptionsFor(MotionSource::kOdometry));
  EXPECT_TRUE(map.closures.empty());
  ASSERT_EQ(map.trajectory.size(), drive.scans.size());
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    EXPECT_NEAR(Distance(map.trajectory[i].T_world_robot, *drive.scans[i].T_odom_robot), 0.0, 1e-9);
  }
}

TEST(MaskedMapper, NodesKeepTheirDistances) {
  const RingDrive drive(1.0, 0.3);
  const MappingOptions options = OptionsFor(MotionSource::kOdometry);
  for (const char* mask : {"always", "openings", "never"}) {
    const BuildingMap map = Map(drive, mask, options);
    const std::vector<Node>& nodes = map.graph.nodes();
    EXPECT_TRUE(nodes.front().HasScan()) << "node 0 is a scan node";
    const Node* last_scan_node = nullptr;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (i > 0) {
        // One step of the drive beyond the limit at the most.
        EXPECT_LE(Distance(nodes[i - 1].T_odom_robot, nodes[i].T_odom_robot),
                  options.nodes.max_edge_length_m + 0.21);
      }
      if (!nodes[i].HasScan()) continue;
      if (last_scan_node != nullptr) {
        EXPECT_GT(Distance(last_scan_node->T_odom_robot, nodes[i].T_odom_robot),
                  options.nodes.min_edge_length_m);
      }
      last_scan_node = &nodes[i];
    }
  }
}

TEST(MaskedMapper, ClosuresBringADriftingPathHome) {
  const RingDrive drive(2.0, 0.15);
  const double drifted =
      LargestError(drive, Map(drive, "never", OptionsFor(MotionSource::kOdometry)));
  EXPECT_GT(drifted, 3.0) << "m, or the test shows nothing";
  const BuildingMap map = Map(drive, "always", OptionsFor(MotionSource::kOdometry));
  EXPECT_GT(Validated(map), 5U);
  EXPECT_LT(LargestError(drive, map), 0.25 * drifted) << "m";
}

TEST(MaskedMapper, ScansAndClosuresTogetherAreGoodToCentimetres) {
  const RingDrive drive(2.0, 0.3);
  const BuildingMap map = Map(drive, "openings", OptionsFor(MotionSource::kFused));
  EXPECT_LT(LargestError(drive, map), 0.25) << "m";
}

TEST(MaskedMapper, EveryClosureOfTheRingIsTrue) {
  const RingDrive drive(2.0, 0.15);
  const BuildingMap map = Map(drive, "always", OptionsFor(MotionSource::kOdometry));
  const auto truth_at = [&](NodeId id) {
    const double stamp = map.graph.nodes()[static_cast<std::size_t>(id)].stamp;
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      if (drive.scans[i].stamp == stamp) return drive.truth[i];
    }
    ADD_FAILURE() << "a node without a scan's stamp";
    return Pose2{};
  };
  for (const Closure& closure : map.closures) {
    if (closure.state != ClosureState::kValidated) continue;
    const Pose2 left = Between(Between(truth_at(closure.older), truth_at(closure.newer)),
                               closure.T_older_newer.mean);
    EXPECT_LT(std::hypot(left.x, left.y), 0.5) << "m";
    EXPECT_LT(RadToDeg(std::abs(left.theta)), 5.0) << "deg";
  }
}

TEST(MaskedMapper, AnyNumberOfThreadsGivesTheSameMap) {
  const RingDrive drive(1.25, 0.15);
  MappingOptions options = OptionsFor(MotionSource::kFused);
  options.closures.matcher.threads = 1;
  const BuildingMap one = Map(drive, "always", options);
  options.closures.matcher.threads = 2;
  const BuildingMap two = Map(drive, "always", options);
  ASSERT_EQ(one.trajectory.size(), two.trajectory.size());
  for (std::size_t i = 0; i < one.trajectory.size(); ++i) {
    EXPECT_EQ(one.trajectory[i].T_world_robot.x, two.trajectory[i].T_world_robot.x);
    EXPECT_EQ(one.trajectory[i].T_world_robot.theta, two.trajectory[i].T_world_robot.theta);
  }
}

TEST(MaskedMapper, ChangeOfFloorIsAPairOfOdometryNodesAndAnEdge) {
  const RingDrive drive(1.0, 0.0);
  FloorTimeline floors;
  floors.levels.resize(2);
  const double ride = drive.scans[drive.scans.size() / 2].stamp;
  floors.intervals = {{0.0, 0, false}, {ride, 0, true}, {ride + 3.0, 1, false}};
  const BuildingMap map = Map(drive, "always", OptionsFor(MotionSource::kOdometry), floors);
  int changes = 0;
  for (const Edge& edge : map.graph.edges()) {
    const Node& from = map.graph.nodes()[static_cast<std::size_t>(edge.from)];
    const Node& to = map.graph.nodes()[static_cast<std::size_t>(edge.to)];
    if (edge.kind != EdgeKind::kFloorChange) {
      EXPECT_EQ(from.floor, to.floor) << "only floor changes cross floors";
      continue;
    }
    ++changes;
    EXPECT_FALSE(from.HasScan());
    EXPECT_FALSE(to.HasScan());
    EXPECT_EQ(from.floor, 0);
    EXPECT_EQ(to.floor, 1);
  }
  EXPECT_EQ(changes, 1);
  for (const KeptScan& kept : map.kept_scans) {
    EXPECT_FALSE(kept.scan.stamp >= ride && kept.scan.stamp < ride + 3.0)
        << "scans in transit are not rendered";
  }
  for (const Closure& closure : map.closures) {
    EXPECT_EQ(map.graph.node(closure.newer).floor, map.graph.node(closure.older).floor);
  }
}

TEST(MaskedMapper, OneScanIsAMap) {
  const RingDrive drive(0.0, 0.0);
  ASSERT_EQ(drive.scans.size(), 1U);
  const BuildingMap map = Map(drive, "openings", OptionsFor(MotionSource::kFused));
  EXPECT_EQ(map.graph.nodes().size(), 1U);
  EXPECT_EQ(map.trajectory.size(), 1U);
  const FloorTimeline floors;
  EXPECT_THROW(MaskedMapper("nonsense", OptionsFor(MotionSource::kFused), floors), InputError);
}

TEST(MaskedMapper, WhatFitsTheOptimisedMapEntersLateAndIsRight) {
  const RingDrive drive(2.3, 0.2);
  for (const double most_m : {0.2, 0.0}) {
    MappingOptions options;
    options.motion.source = MotionSource::kFused;
    options.closures.polish.most_m = most_m;
    const FloorTimeline floors;
    MaskedMapper mapper("openings", options, floors);
    for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
    const BuildingMap map = mapper.Finish();
    int late = 0;
    for (const Closure& closure : map.closures) {
      if (closure.reason != ClosureReason::kFitsTheMap) continue;
      ++late;
      EXPECT_EQ(closure.state, ClosureState::kValidated);
      const auto truth_at = [&](NodeId node) {
        const double stamp = map.graph.nodes()[static_cast<std::size_t>(node)].stamp;
        for (std::size_t i = 0; i < drive.scans.size(); ++i) {
          if (drive.scans[i].stamp == stamp) return drive.truth[i];
        }
        ADD_FAILURE() << "no scan at a node";
        return Pose2();
      };
      const Pose2 error = Between(closure.T_older_newer.mean,
                                  Between(truth_at(closure.older), truth_at(closure.newer)));
      EXPECT_LT(std::hypot(error.x, error.y), 0.1) << "m";
      EXPECT_LT(RadToDeg(std::abs(error.theta)), 1.0) << "deg";
    }
    if (most_m > 0.0) {
      EXPECT_GT(late, 0);
    } else {
      EXPECT_EQ(late, 0);
    }
  }
}

TEST(MaskedMapper, ACorridorPassedAgainIsClosedBetweenItsMaskedPlaces) {
  const RingDrive drive(2.3, 0.2);
  const auto truth_at = [&](const Node& node) {
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      if (drive.scans[i].stamp == node.stamp) return drive.truth[i];
    }
    ADD_FAILURE() << "no scan at a node";
    return Pose2();
  };
  std::size_t offered = 0;
  for (const double distance_m : {0.0, 2.0}) {
    MappingOptions options = OptionsFor(MotionSource::kFused);
    options.closures.polish.revisits.distance_m = distance_m;
    const BuildingMap map = Map(drive, "openings", options);
    const std::vector<Node>& nodes = map.graph.nodes();
    int between_scans = 0;
    for (const Closure& closure : map.closures) {
      const Node& older = map.graph.node(closure.older);
      const Node& newer = map.graph.node(closure.newer);
      if (older.HasScan() && newer.HasScan()) continue;
      ++between_scans;
      EXPECT_EQ(closure.state, ClosureState::kValidated) << Name(closure.reason);
      EXPECT_GT(closure.newer, closure.older);
      EXPECT_GT(closure.score, options.closures.matcher.min_score);
      const Pose2 error =
          Between(closure.T_older_newer.mean, Between(truth_at(older), truth_at(newer)));
      EXPECT_LT(std::hypot(error.x, error.y), 0.1) << "m";
      EXPECT_LT(RadToDeg(std::abs(error.theta)), 1.0) << "deg";
    }
    std::size_t open = 0;
    const OpenRevisits revisits(map.graph, {});
    for (NodeId id = 0; static_cast<std::size_t>(id) < nodes.size(); ++id) {
      open += revisits.Of(id).size();
    }
    if (distance_m > 0.0) {
      EXPECT_GT(between_scans, 0);
      EXPECT_EQ(open, 0U);
      EXPECT_LE(map.closures.size(), offered + open + 12) << "one closure joins its surroundings";
    } else {
      EXPECT_EQ(between_scans, 0);
      EXPECT_GT(open, 0U) << "or the test shows nothing";
      offered = map.closures.size();
    }
  }
}

TEST(MaskedMapper, DeadReckoningStaysDeadReckoningWhenItIsGood) {
  const RingDrive drive(2.3, 0.0);
  EXPECT_TRUE(Map(drive, "never", OptionsFor(MotionSource::kFused)).closures.empty());
}

}  // namespace
}  // namespace masked_mapper
