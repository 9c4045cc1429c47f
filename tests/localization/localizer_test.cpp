// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/localization/localizer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "localization/room_drive.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

class LocalizerTest : public testing::Test {
 protected:
  static LocalizerOptions Usual() {
    LocalizerOptions options;
    options.floor_search = UsualFloorSearch();
    return options;
  }
};

TEST_F(LocalizerTest, FindsARobotAndHoldsIt) {
  const Walls room = Room(14.0, 9.0);
  const BuildingMap map = MapOf(Drive(room, 0, 320, 0.0));
  constexpr int kFirst = 130;
  Localizer localizer(map, "always", Usual());
  const std::vector<LaserScan> log = Drive(room, kFirst, 320, 1e5);
  for (const LaserScan& scan : log) EXPECT_TRUE(localizer.Observe(scan));
  const Localization& drive = localizer.result();
  ASSERT_TRUE(drive.found) << localizer.Doubt();
  EXPECT_LT(drive.found_after_m, 15.0);
  ASSERT_EQ(drive.scans.size(), log.size());
  // Where the second drive's first pose lies in the first one's frame.
  const Pose2 T_world_odom = *Drive(room, 0, kFirst + 1, 0.0).back().T_odom_robot;
  for (std::size_t i = 0; i < log.size(); ++i) {
    ASSERT_TRUE(drive.scans[i].placed) << i;
    const Pose2 truth = T_world_odom * *log[i].T_odom_robot;
    EXPECT_LT(Distance(drive.scans[i].T_world_robot.mean, truth), 0.3) << i;
  }
}

// What was taken away and what was put up is reported where it is, and no more than that.
TEST_F(LocalizerTest, ReportsWhatHasChanged) {
  const Walls room = Room(14.0, 9.0);
  const BuildingMap map = MapOf(Drive(room, 0, 320, 0.0));
  const auto changes_of = [&](const Walls& walls) {
    Localizer localizer(map, "always", Usual());
    constexpr std::size_t kAsBefore = 320;  // scans
    const std::vector<LaserScan> before = Drive(room, 0, 960, 1e5);
    const std::vector<LaserScan> after = Drive(walls, 0, 960, 1e5);
    for (std::size_t i = 0; i < after.size(); ++i) {
      localizer.Observe(i < kAsBefore ? before[i] : after[i]);
    }
    EXPECT_TRUE(localizer.result().found) << localizer.Doubt();
    return localizer.Changes();
  };
  EXPECT_TRUE(changes_of(room).empty());
  Walls changed;
  for (const Wall& wall : room) {
    const Eigen::Vector2d away = 0.5 * (wall.from + wall.to) - Eigen::Vector2d(6.25, 7.875);
    if (away.norm() > 1.0) changed.push_back(wall);
  }
  ASSERT_EQ(changed.size(), room.size() - 4);
  const Eigen::Vector2d new_from(8.5, 7.6);
  const Eigen::Vector2d new_to(10.5, 7.9);
  changed.push_back({new_from, new_to});
  // The world is the first pose of the drive.
  const Pose2 T_room_world = DrivenPose(0);
  int found_new = 0;
  int found_gone = 0;
  for (const MapChange& change : changes_of(changed)) {
    const Eigen::Vector2d at = T_room_world * Eigen::Vector2d(change.x, change.y);
    const Eigen::Vector2d where =
        change.kind == ChangeKind::kNew ? 0.5 * (new_from + new_to) : Eigen::Vector2d(6.25, 7.7);
    EXPECT_LT((at - where).norm(), 1.2) << Name(change.kind) << " " << at.transpose();
    ++(change.kind == ChangeKind::kNew ? found_new : found_gone);
  }
  EXPECT_EQ(found_new, 1);
  EXPECT_EQ(found_gone, 1);
}

// Carried a quarter of the way round between two scans, and neither clock nor wheels tell.
TEST_F(LocalizerTest, FindsARobotAgainThatWasCarriedUnnoticed) {
  const Walls room = Room(14.0, 9.0);
  const BuildingMap map = MapOf(Drive(room, 0, 320, 0.0));
  constexpr std::size_t kCarried = 400;  // scan
  constexpr std::size_t kLeftOut = 75;
  std::vector<LaserScan> log = Drive(room, 0, 1200, 1e5);
  std::vector<Pose2> truth;
  for (const LaserScan& scan : log) truth.push_back(*scan.T_odom_robot);
  truth.erase(truth.begin() + kCarried, truth.begin() + kCarried + kLeftOut);
  log.erase(log.begin() + kCarried, log.begin() + kCarried + kLeftOut);
  const Pose2 T_odom_leap = *log[kCarried - 1].T_odom_robot * Inverse(truth[kCarried]);
  for (std::size_t i = kCarried; i < log.size(); ++i) {
    log[i].T_odom_robot = T_odom_leap * truth[i];
    log[i].stamp -= 0.2 * kLeftOut;
  }
  Localizer localizer(map, "always", Usual());
  for (const LaserScan& scan : log) localizer.Observe(scan);
  const std::vector<LocatedScan>& scans = localizer.result().scans;
  EXPECT_TRUE(scans[kCarried - 1].sure);
  EXPECT_TRUE(scans.back().sure) << localizer.Doubt();
  constexpr std::size_t kNoticed = 15;  // scans, three seconds
  bool was_unsure = false;
  for (std::size_t i = kCarried + kNoticed; i < scans.size(); ++i) {
    was_unsure |= !scans[i].sure;
    if (!scans[i].sure) continue;
    EXPECT_LT(Distance(scans[i].T_world_robot.mean, truth[i]), 0.5) << i;
  }
  EXPECT_TRUE(was_unsure);
}

TEST_F(LocalizerTest, DoesNotFindARobotOfAnotherBuilding) {
  const BuildingMap map = MapOf(Drive(Room(14.0, 9.0), 0, 320, 0.0));
  Walls other{{{-3, -8}, {17, -9}},
              {{17, -9}, {14, 13}},
              {{14, 13}, {-6, 11}},
              {{-6, 11}, {-3, -8}},
              {{6, 3}, {8, 5}}};
  Localizer localizer(map, "always", Usual());
  for (const LaserScan& scan : Drive(other, 0, 320, 0.0)) localizer.Observe(scan);
  EXPECT_FALSE(localizer.result().found);
  EXPECT_FALSE(localizer.Doubt().empty());
  for (const LocatedScan& scan : localizer.result().scans) EXPECT_FALSE(scan.placed);
}

TEST_F(LocalizerTest, NothingIsKnownOfAnEmptyMapAndAnEmptyLog) {
  const BuildingMap empty = MapOf({});
  Localizer localizer(empty, "always", Usual());
  EXPECT_TRUE(localizer.result().scans.empty());
  for (const LaserScan& scan : Drive(Room(14.0, 9.0), 0, 40, 0.0)) localizer.Observe(scan);
  EXPECT_FALSE(localizer.result().found);
}

TEST_F(LocalizerTest, RefusesAMaskThatIsNone) {
  const BuildingMap empty = MapOf({});
  EXPECT_THROW(Localizer(empty, "sometimes", Usual()), InputError);
}

}  // namespace
}  // namespace masked_mapper
