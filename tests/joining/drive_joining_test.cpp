// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/drive_joining.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <cstdio>

#include "mapping/ring_logs.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/map/drives.hpp"

namespace masked_mapper {
namespace {

BuildingMap Joined(std::vector<BuildingMap> maps) {
  ProgressSink silent;
  return JoinDrives(std::move(maps), {}, {}, silent);
}

/// The largest error of a drive of a map whose first drive begins where the truth does.
double WorstError(const BuildingMap& map, std::size_t drive, const Cut& cut) {
  const IndexRange poses = PosesOfDrive(map, drive);
  EXPECT_EQ(poses.end - poses.begin, cut.truth.size());
  double worst = 0.0;
  for (std::size_t i = poses.begin; i < poses.end; ++i) {
    worst = std::max(worst, Distance(map.trajectory[i].T_world_robot, cut.truth[i - poses.begin]));
  }
  return worst;
}

TEST(DriveJoining, OneMapAloneStaysAsItIs) {
  const BuildingMap map = MapOf(First(), "join_first.log");
  EXPECT_EQ(map.drives.size(), 1U);
  EXPECT_TRUE(SameMap(map, Joined({map})));
}

TEST(DriveJoining, ADriveFromElsewhereFindsItsPlace) {
  BuildingMap first = MapOf(First(), "join_first.log");
  BuildingMap second = MapOf(Second(), "join_second.log");
  first.kept_clouds = {{3, std::make_shared<const std::string>("one")}};
  second.kept_clouds = {{5, std::make_shared<const std::string>("another")}};
  const BuildingMap map = Joined({first, second});
  ASSERT_EQ(map.drives.size(), 2U);
  ASSERT_EQ(map.kept_clouds.size(), 2U);
  EXPECT_EQ(*map.kept_clouds[1].packed, "another");
  EXPECT_EQ(map.kept_clouds[1].trajectory_index, first.trajectory.size() + 5);
  EXPECT_EQ(PiecesOfDrives(map), (std::vector<std::size_t>{0, 0}));
  EXPECT_EQ(map.graph.floors().size(), 1U);
  EXPECT_LT(WorstError(map, 0, First()), 0.3) << "m";
  EXPECT_LT(WorstError(map, 1, Second()), 0.3) << "m";
  const std::vector<DriveFacts> facts = FactsOfDrives(map);
  EXPECT_TRUE(facts[1].joined);
  EXPECT_GT(facts[1].closures_to_others, 5U);
  EXPECT_EQ(facts[1].scans, Second().scans.size());
  EXPECT_EQ(facts[1].nodes, second.graph.nodes().size());
  // Stamps follow on, by whole seconds, and that is said.
  const double offset = facts[1].stamp_offset_s;
  EXPECT_GT(offset, 0.0);
  EXPECT_EQ(offset, std::floor(offset));
  for (std::size_t i = 1; i < map.trajectory.size(); ++i) {
    ASSERT_GE(map.trajectory[i].stamp, map.trajectory[i - 1].stamp);
  }
  EXPECT_NEAR(map.trajectory.back().stamp - offset, second.trajectory.back().stamp, 1e-6);
  ASSERT_EQ(map.warnings.size(), 1U);
  EXPECT_NE(map.warnings[0].find("stamps are shifted"), std::string::npos) << map.warnings[0];
  EXPECT_TRUE(SameMap(map, Joined({first, second})));
}

TEST(DriveJoining, ALogGivenTwiceJoinsItself) {
  const BuildingMap first = MapOf(First(), "join_first.log");
  const BuildingMap map = Joined({first, first});
  EXPECT_TRUE(FactsOfDrives(map)[1].joined);
  EXPECT_LT(WorstError(map, 1, First()), 0.3) << "m";
}

TEST(DriveJoining, ThirdDrivesJoinWhatGrewBefore) {
  const Cut third(RingDrive(2.0, 0.1, 3), 500, 900);
  const BuildingMap two =
      Joined({MapOf(First(), "join_first.log"), MapOf(Second(), "join_second.log")});
  const BuildingMap map = Joined({two, MapOf(third, "join_third.log")});
  ASSERT_EQ(map.drives.size(), 3U);
  EXPECT_EQ(PiecesOfDrives(map), (std::vector<std::size_t>{0, 0, 0}));
  EXPECT_LT(WorstError(map, 2, third), 0.3) << "m";
}

TEST(DriveJoining, AnotherBuildingStaysApartBesideTheFirst) {
  RingDrive other(1.0, 0.1, 5);
  for (BoxScene::Wall& wall : other.scene.walls) {
    wall.from = {1.7 * wall.from.x(), 0.6 * wall.from.y()};
    wall.to = {1.7 * wall.to.x(), 0.6 * wall.to.y()};
  }
  other.scene.AddBox(30.0, 0.3, 31.0, 0.9);
  for (std::size_t i = 0; i < other.scans.size(); ++i) {
    const double stamp = other.scans[i].stamp;
    const auto odometry = other.scans[i].T_odom_robot;
    const Pose2 T_world_robot{1.7 * (other.truth[i].x + 1.0), 0.6 * (other.truth[i].y + 1.0),
                              other.truth[i].theta};
    other.scans[i] = other.scene.Scan(T_world_robot, 181, 270.0);
    other.scans[i].stamp = stamp;
    other.scans[i].T_odom_robot = Pose2{T_world_robot.x, T_world_robot.y, odometry->theta};
  }
  const BuildingMap first = MapOf(First(), "join_first.log");
  const BuildingMap second = MapOf(Cut(other, 0, 10000), "join_other.log");
  const BuildingMap map = Joined({first, second});
  const std::vector<DriveFacts> facts = FactsOfDrives(map);
  ASSERT_FALSE(facts[1].joined) << facts[1].reason;
  EXPECT_EQ(facts[1].piece, 1U);
  EXPECT_EQ(facts[1].closures_to_others, 0U);
  EXPECT_FALSE(facts[1].reason.empty());
  EXPECT_NE(WarningsOf(map).back().find("stays a piece of its own"), std::string::npos);
  ASSERT_EQ(map.graph.floors().size(), 2U);
  EXPECT_EQ(map.graph.floors()[0].label, "0");
  EXPECT_EQ(map.graph.floors()[1].label, "0.drive2");
  // Each is as it was alone, and they do not overlap.
  double right = 0.0;
  for (std::size_t i = 0; i < first.trajectory.size(); ++i) {
    EXPECT_NEAR(Distance(map.trajectory[i].T_world_robot, first.trajectory[i].T_world_robot), 0.0,
                1e-9);
    right = std::max(right, map.trajectory[i].T_world_robot.x);
  }
  const IndexRange poses = PosesOfDrive(map, 1);
  const Pose2 start = map.trajectory[poses.begin].T_world_robot;
  for (std::size_t i = poses.begin; i < poses.end; ++i) {
    const Pose2& pose = map.trajectory[i].T_world_robot;
    EXPECT_GT(pose.x, right + 1.0);
    EXPECT_NEAR(Distance(Between(start, pose), second.trajectory[i - poses.begin].T_world_robot),
                0.0, 1e-6);
  }
}

TEST(DriveJoining, OneScanIsTooLittleToJoin) {
  const BuildingMap map = Joined({MapOf(First(), "join_first.log"),
                                  MapOf(Cut(RingDrive(1.0, 0.1, 2), 100, 101), "join_one.log")});
  EXPECT_FALSE(FactsOfDrives(map)[1].joined);
  EXPECT_EQ(map.trajectory.size(), First().scans.size() + 1);
  // And the other way round: a map of one scan is no map to join.
  const BuildingMap back = Joined({MapOf(Cut(RingDrive(1.0, 0.1, 2), 100, 101), "join_one.log"),
                                   MapOf(First(), "join_first.log")});
  EXPECT_FALSE(FactsOfDrives(back)[1].joined);
}

// Two floors of one plan, and a drive on one of them.
class StoreysAlike : public testing::Test {
 protected:
  StoreysAlike() {
    const Cut both(RingDrive(2.2, 0.2, 1), 0, 10000);
    const std::size_t half = both.scans.size() / 2;
    two_floors_ = MapOf(both, "join_tower.log", {{0, "low"}, {half, "-"}, {half + 8, "high"}});
  }

  static BuildingMap Unnamed(BuildingMap map) {
    return WithFloors(std::move(map), [](Floor& floor) {
      floor.label_given = false;
      floor.elevation_measured = true;
    });
  }

  BuildingMap two_floors_;
};

TEST_F(StoreysAlike, AreNotToldApartByNothing) {
  ASSERT_EQ(two_floors_.graph.floors().size(), 2U);
  const BuildingMap map =
      Joined({Unnamed(two_floors_), Unnamed(MapOf(Second(), "join_second.log"))});
  const DriveFacts facts = FactsOfDrives(map)[1];
  EXPECT_FALSE(facts.joined);
  EXPECT_NE(facts.reason.find("more than one way"), std::string::npos) << facts.reason;
}

TEST_F(StoreysAlike, AreToldApartByTheirNames) {
  for (const std::string label : {"low", "high"}) {
    const BuildingMap map = Joined({two_floors_, MapOf(Second(), "join_named.log", {{0, label}})});
    const DriveFacts facts = FactsOfDrives(map)[1];
    ASSERT_TRUE(facts.joined) << facts.reason;
    EXPECT_EQ(facts.floors, std::vector<std::string>{label});
    EXPECT_EQ(map.graph.floors().size(), 2U);
  }
  const BuildingMap other = Joined({two_floors_, MapOf(Second(), "join_named.log", {{0, "roof"}})});
  EXPECT_FALSE(FactsOfDrives(other)[1].joined) << "no floor is called so";
  EXPECT_EQ(other.graph.floors().back().label, "roof.drive2");
}

TEST_F(StoreysAlike, AFloorHardlySeenIsTheOneOfItsName) {
  const std::size_t scans = Second().scans.size();
  const BuildingMap map =
      Joined({two_floors_, MapOf(Second(), "join_glimpse.log",
                                 {{0, "low"}, {scans - 12, "-"}, {scans - 2, "high"}})});
  const DriveFacts facts = FactsOfDrives(map)[1];
  ASSERT_TRUE(facts.joined) << facts.reason;
  EXPECT_EQ(facts.floors, (std::vector<std::string>{"low", "high"}));
  EXPECT_EQ(map.graph.floors().size(), 2U);
}

TEST(DriveJoining, NoTwoFloorsAreCalledAlike) {
  const BuildingMap map = Joined({MapOf(First(), "join_odd.log", {{0, "0.drive2"}}),
                                  MapOf(Cut(RingDrive(1.0, 0.1, 2), 100, 101), "join_one.log")});
  ASSERT_EQ(map.graph.floors().size(), 2U);
  EXPECT_EQ(map.graph.floors()[0].label, "0.drive2");
  EXPECT_EQ(map.graph.floors()[1].label, "0.drive2_");
}

TEST(DriveJoining, APieceWithANamedFloorJoinsWhatGrewLater) {
  // A drive of a few metres, to which nothing can be tied.
  const Cut stub(RingDrive(1.0, 0.1, 1), 0, 60);
  const BuildingMap apart = Joined(
      {MapOf(stub, "join_stub.log", {{0, "EG"}}), MapOf(Second(), "join_second.log", {{0, "EG"}})});
  ASSERT_FALSE(FactsOfDrives(apart)[1].joined);
  EXPECT_EQ(apart.graph.floors()[1].label, "EG.drive2");
  const BuildingMap map = Joined({apart, MapOf(First(), "join_named.log", {{0, "EG"}})});
  EXPECT_EQ(PiecesOfDrives(map)[1], PiecesOfDrives(map)[2]);
  const std::vector<std::string> warnings = WarningsOf(map);
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const std::string& warning) {
                            return warning.find("piece of its own") != std::string::npos;
                          }),
            1)
      << "of the stub, and of the stub alone";
}

TEST(DriveJoining, WhatWasTakenApartByHandStaysApart) {
  BuildingMap map = Joined({MapOf(First(), "join_first.log"), MapOf(Second(), "join_second.log")});
  std::string edits;
  for (const Edge& edge : map.graph.edges()) {
    if (DriveOfNode(map, edge.from) == DriveOfNode(map, edge.to)) continue;
    char line[200];
    std::snprintf(line, sizeof line, "- forbid_closure: {from: %.6f, to: %.6f}\n",
                  map.graph.nodes()[static_cast<std::size_t>(edge.from)].stamp,
                  map.graph.nodes()[static_cast<std::size_t>(edge.to)].stamp);
    edits += line;
  }
  ApplyEditsText("edits.yaml", edits, {}, map);
  ASSERT_EQ(map.graph.floors().size(), 1U) << "two pieces on one floor";
  const BuildingMap grown =
      Joined({map, MapOf(Cut(RingDrive(1.0, 0.1, 2), 100, 101), "join_one.log")});
  EXPECT_EQ(PiecesOfDrives(grown), (std::vector<std::size_t>{0, 1, 2}));
  const std::vector<DriveFacts> facts = FactsOfDrives(grown);
  EXPECT_EQ(facts[0].floors, std::vector<std::string>{"0"});
  EXPECT_EQ(facts[1].floors, std::vector<std::string>{"0.drive2"});
  EXPECT_EQ(facts[2].floors, std::vector<std::string>{"0.drive3"});
  EXPECT_EQ(facts[1].reason, "its closures were forbidden by hand");
}

TEST(DriveJoining, APieceIsJoinedByHand) {
  // Two halves of the ring that share next to nothing.
  const RingDrive drive(1.0, 0.1, 1);
  const Cut first(drive, 0, 150);
  const Cut second(drive, 140, 330);
  BuildingMap map = Joined({MapOf(first, "join_a.log"), MapOf(second, "join_b.log")});
  ASSERT_FALSE(FactsOfDrives(map)[1].joined) << FactsOfDrives(map)[1].reason;
  ASSERT_EQ(map.graph.floors().size(), 2U);
  // The last scan of the first drive and that of the second at the same place.
  const Pose2 T = Between(first.truth[149], second.truth[20]);
  char text[400];
  std::snprintf(text, sizeof text,
                "- same_floor: {floor: \"0.drive2\", as: \"0\"}\n"
                "- add_closure: {from: %.6f, to: %.6f, transform: [%.4f, %.4f, %.4f]}\n",
                map.trajectory[149].stamp, map.trajectory[150 + 20].stamp, T.x, T.y,
                RadToDeg(T.theta));
  ApplyEditsText("edits.yaml", text, {}, map);
  const DriveFacts facts = FactsOfDrives(map)[1];
  EXPECT_TRUE(facts.joined);
  EXPECT_EQ(facts.reason, "joined by hand");
  EXPECT_LT(WorstError(map, 1, second), 0.3) << "m";
  for (const std::string& warning : map.warnings) {
    EXPECT_EQ(warning.find("piece of its own"), std::string::npos) << warning;
  }
}

}  // namespace
}  // namespace masked_mapper
