// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/editing/edits.hpp"

#include <gtest/gtest.h>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Once round and a bit, with wheels that drift, and not a closure.
class EditsTest : public testing::Test {
 protected:
  EditsTest() : drive_(1.2, 0.5) {
    MappingOptions options;
    options.motion.source = MotionSource::kOdometry;
    options.closures.refine = options.closures.laid_out_by_scans = false;
    floors_.levels.push_back({"up", 3.0, 0.1, true, true, ""});
    MaskedMapper mapper("never", options, floors_);
    for (const LaserScan& scan : drive_.scans) mapper.Observe(scan);
    map_ = mapper.Finish();
  }

  /// Of the end of the drive, as seen from the same place a round before, m.
  double LastError() const {
    return Distance(
        Between(map_.trajectory[OldScan()].T_world_robot, map_.trajectory.back().T_world_robot),
        Between(drive_.truth[OldScan()], drive_.truth.back()));
  }

  /// The scan nearest to where the drive ends, of its first half.
  std::size_t OldScan() const {
    std::size_t best = 0;
    for (std::size_t i = 0; i < drive_.truth.size() / 2; ++i) {
      if (Distance(drive_.truth[i], drive_.truth.back()) <
          Distance(drive_.truth[best], drive_.truth.back())) {
        best = i;
      }
    }
    return best;
  }

  std::string Stamps() const {
    return "from: " + std::to_string(map_.trajectory.back().stamp) +
           ", to: " + std::to_string(map_.trajectory[OldScan()].stamp);
  }

  std::string TruePose() const {
    const Pose2 T = Between(drive_.truth.back(), drive_.truth[OldScan()]);
    return "[" + std::to_string(T.x) + ", " + std::to_string(T.y) + ", " +
           std::to_string(RadToDeg(T.theta)) + "]";
  }

  void Edit(const std::string& text) { ApplyEditsText("edits.yaml", text, options_, map_); }

  RingDrive drive_;
  FloorTimeline floors_;
  LoopClosureOptions options_;
  BuildingMap map_;
};

TEST_F(EditsTest, AClosureWithItsTransformMendsTheMap) {
  const double before = LastError();
  ASSERT_GT(before, 1.0) << "m";
  Edit("- add_closure: {" + Stamps() + ", transform: " + TruePose() + "}\n");
  EXPECT_LT(LastError(), 0.2) << "m";
  EXPECT_EQ(map_.graph.edges().back().kind, EdgeKind::kClosure);
  EXPECT_EQ(map_.closures.back().reason, ClosureReason::kAddedByHand);
  EXPECT_GT(map_.closures.back().newer, map_.closures.back().older);
  EXPECT_EQ(map_.warnings.back().rfind("edited: a closure between", 0), 0U);
}

TEST_F(EditsTest, AClosureIsMatchedFromAGuess) {
  const Pose2 T = Between(drive_.truth.back(), drive_.truth[OldScan()]);
  Edit("- add_closure: {" + Stamps() + ", guess: [" + std::to_string(T.x + 0.4) + ", " +
       std::to_string(T.y - 0.3) + ", " + std::to_string(RadToDeg(T.theta) + 4.0) + "]}\n");
  EXPECT_LT(LastError(), 0.25) << "m";
  EXPECT_GT(map_.closures.back().score, options_.matcher.min_score);
}

TEST_F(EditsTest, AForbiddenClosureIsOut) {
  const BuildingMap before = map_;
  Edit("- add_closure: {" + Stamps() + ", transform: [1, 2, 30]}\n");
  EXPECT_FALSE(SameMap(before, map_));
  const Closure added = map_.closures.back();
  const auto stamp = [&](NodeId node) {
    return std::to_string(map_.graph.nodes()[static_cast<std::size_t>(node)].stamp);
  };
  Edit("- forbid_closure: {from: " + stamp(added.older) + ", to: " + stamp(added.newer) + "}\n");
  EXPECT_EQ(map_.closures.back().state, ClosureState::kAuditedOut);
  for (std::size_t i = 0; i < map_.trajectory.size(); ++i) {
    EXPECT_LT(Distance(map_.trajectory[i].T_world_robot, before.trajectory[i].T_world_robot), 1e-3);
  }
}

TEST_F(EditsTest, FloorsAreNamedPinnedAndJoined) {
  Edit(
      "- name_floor: {floor: up, name: attic}\n- pin_elevation: {floor: attic, elevation_m: "
      "4.5}\n");
  EXPECT_EQ(map_.graph.floors()[1].label, "attic");
  EXPECT_EQ(map_.graph.floors()[1].elevation, 4.5);
  EXPECT_TRUE(map_.graph.floors()[1].elevation_measured);
  Edit("- same_floor: {floor: \"0\", as: attic}\n");
  ASSERT_EQ(map_.graph.floors().size(), 1U);
  EXPECT_EQ(map_.graph.floors()[0].label, "attic");
  for (const Node& node : map_.graph.nodes()) EXPECT_EQ(node.floor, 0);
  for (const TrajectoryPose& pose : map_.trajectory) EXPECT_EQ(pose.floor, 0);
}

TEST_F(EditsTest, PlacesAndAreasAreWrittenIntoTheMap) {
  Edit(
      "- places: {dock: [\"0\", 1.5, -2.0], printer: [up, 4, 7.5]}\n"
      "- keep_out: {floor: up, area: [[1, 1], [3, 1], [3, 2]]}\n"
      "- erase: {floor: \"0\", area: [[1, 1], [3, 1], [3, 2], [1, 2]]}\n"
      "- places: {dock: [up, 0, 1]}\n"
      "- same_floor: {floor: \"0\", as: up}\n");
  ASSERT_EQ(map_.places.size(), 2U);
  EXPECT_EQ(map_.places[0].name, "dock");
  EXPECT_EQ(map_.places[0].at_in_world, Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(map_.places[1].floor, 0) << "the one that is left";
  ASSERT_EQ(map_.areas.size(), 2U);
  EXPECT_EQ(map_.areas[0].kind, AreaKind::kKeepOut);
  EXPECT_EQ(map_.areas[0].floor, 0);
  EXPECT_EQ(map_.areas[1].kind, AreaKind::kErased);
  EXPECT_EQ(map_.areas[1].floor, 0);
  EXPECT_EQ(map_.areas[1].corners_in_world.size(), 4U);
}

TEST_F(EditsTest, WhatIsWrittenStaysWithItsPlaceWhenTheMapIsMended) {
  const std::size_t half = map_.trajectory.size() / 2;  // where it drove once only
  const Pose2 before = map_.trajectory[half].T_world_robot;
  Edit("- places: {half: [\"0\", " + std::to_string(before.x) + ", " + std::to_string(before.y) +
       "]}\n- add_closure: {" + Stamps() + ", transform: " + TruePose() + "}\n");
  const Pose2 after = map_.trajectory[half].T_world_robot;
  EXPECT_GT(Distance(after, before), 0.2);
  EXPECT_LT((map_.places[0].at_in_world - after.Translation()).norm(),
            0.5 * Distance(after, before));
}

TEST_F(EditsTest, AnchorsPutTheMapIntoTheFrameOfTheSite) {
  const BuildingMap before = map_;
  const Pose2 T_site_world{100.0, -40.0, 1.0};
  const auto anchor = [&](double x, double y, double off) {
    const Eigen::Vector2d is = T_site_world * Eigen::Vector2d(x, y);
    return "- anchor: {floor: \"0\", at: [" + std::to_string(x) + ", " + std::to_string(y) +
           "], is: [" + std::to_string(is.x() + off) + ", " + std::to_string(is.y()) + "]}\n";
  };
  Edit("- places: {dock: [\"0\", 3, 4]}\n" + anchor(0, 0, 0.1) + anchor(10, 0, -0.1) +
       anchor(5, 8, 0.0));
  const Pose2 expected = T_site_world * before.trajectory.back().T_world_robot;
  EXPECT_LT(Distance(map_.trajectory.back().T_world_robot, expected), 0.4);
  EXPECT_LT((map_.places[0].at_in_world - T_site_world * Eigen::Vector2d(3.0, 4.0)).norm(), 0.1);
  EXPECT_NE(map_.warnings.back().find("known points are off by"), std::string::npos)
      << map_.warnings.back();
  // One alone shifts.
  map_ = before;
  Edit(anchor(2, 3, 0.0));
  EXPECT_NEAR(map_.trajectory.back().T_world_robot.theta,
              before.trajectory.back().T_world_robot.theta, 1e-9);
  EXPECT_NE(map_.warnings.back().find("says nothing of the turn"), std::string::npos);
}

TEST_F(EditsTest, NoEditsChangeNothing) {
  const BuildingMap before = map_;
  Edit("");
  Edit("# nothing yet\n");
  EXPECT_TRUE(SameMap(before, map_));
}

TEST_F(EditsTest, MistakesNameFileAndLineAndChangeNothing) {
  const BuildingMap before = map_;
  const std::string good = "- name_floor: {floor: up, name: attic}\n";
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"- ad_closure: {from: 1, to: 2}\n", "did you mean `add_closure`"},
           {"- add_closure: {from: 1}\n", "needs `to`"},
           {"- add_closure: {from: 1, to: x}\n", "must be a number"},
           {"- add_closure: {from: 1, to: .nan}\n", "must be a number"},
           {"- add_closure: {from: 1, to: 99999}\n", "no scan within"},
           {"- add_closure: {from: 1, to: 1.1, transform: [0, 0, 0]}\n", "one node"},
           {"- add_closure: {from: 1, to: 30, transform: [0, 0]}\n", "list of 3 numbers"},
           {"- add_closure: {from: 1, to: 30, transform: [0, 0, 0], sigma: [0, 1]}\n",
            "sigma must be 0.000001 to 10000"},
           {"- add_closure: {from: 1, to: 30, transform: [0, 0, 0], sigma: [1, 1e200]}\n",
            "sigma must be 0.000001 to 10000"},
           {"- add_closure: {from: 1, to: 30, gues: [0, 0, 0]}\n", "has no field `gues`"},
           {"- add_closure: {from: 1, to: 30, guess: [900, 0, 0]}\n", "do not match"},
           {"- forbid_closure: {from: 1, to: 30}\n", "no closure between"},
           {"- name_floor: {floor: cellar, name: x}\n", "it has 0, attic"},
           {"- name_floor: {floor: \"0\", name: attic}\n", "called `attic` already"},
           {"- name_floor: {floor: \"0\", name: a/b}\n", "made of letters"},
           {"- pin_elevation: {floor: \"0\", elevation_m: high}\n", "must be a number"},
           {"- same_floor: {floor: \"0\", as: \"0\"}\n", "one floor already"},
           {"- places: {}\n", "expected name"},
           {"- places: {a b: [\"0\", 1, 2]}\n", "made of letters"},
           {"- places: {a: [\"0\", 1]}\n", "[floor, x, y]"},
           {"- places: {a: [cellar, 1, 2]}\n", "it has 0, attic"},
           {"- places: {a: [\"0\", 1, 2e5]}\n", "within 100 km"},
           {"- keep_out: {floor: \"0\"}\n", "needs `area`"},
           {"- keep_out: {floor: \"0\", area: [[0, 0], [1, 1]]}\n", "three corners"},
           {"- keep_out: {floor: \"0\", area: [[0, 0], [1, 1], [2, 2]]}\n", "three corners"},
           {"- erase: {floor: \"0\", area: [[0, 0], [1, 1], [2]]}\n", "list of points"},
           {"- erase: {floor: \"0\", area: 7}\n", "list of points"},
           {"- anchor: {floor: \"0\", at: [1, 2]}\n", "needs `is`"},
           {"- anchor: {floor: \"0\", at: [1, 2], is: [1, 2, 3]}\n", "list of 2 numbers"},
           {"- anchor: {floor: \"0\", at: [1, 2], is: [5e6, 2]}\n", "within 100 km"},
           {"- same_floor\n", "expected one edit"},
           {"- same_floor: 3\n", "needs its fields"},
           {"- {a: {}, b: {}}\n", "expected one edit"},
           {"  - [\n", "not valid YAML"}}) {
    try {
      Edit(good + text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).rfind("edits.yaml:", 0), 0U) << error.what();
    }
    EXPECT_TRUE(SameMap(before, map_));
  }
  EXPECT_THROW(Edit("a: 1\n"), InputError);
  EXPECT_THROW(ApplyEdits("/nowhere/edits.yaml", options_, map_), InputError);
}

}  // namespace
}  // namespace masked_mapper
