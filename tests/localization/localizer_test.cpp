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
