// SPDX-License-Identifier: BSD-3-Clause
#include "localization/pose_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "localization/evidence.hpp"
#include "localization/room_drive.hpp"

namespace masked_mapper {
namespace {

constexpr double kFirstHeading = 0.5 * M_PI;  // rad, of Drive() in its room

UncertainPose2 Guess(const Pose2& T_world_robot, double sigma_m, double sigma_deg) {
  return Widened({T_world_robot, Eigen::Matrix3d::Zero()}, sigma_m, sigma_deg);
}

/// Equal teeth along a wall, and nothing else near by that tells one from the next.
class PoseTrackerTest : public testing::Test {
 protected:
  static Walls Hall() {
    Walls walls{{{-4, 0}, {18, 0}}, {{-4, 8}, {18, 8}}, {{-4, 0}, {-4, 8}}, {{18, 0}, {18, 8}}};
    for (double x = -2.0; x < 17.0; x += 2.0) walls.push_back({{x, 0.0}, {x, 0.8}});
    return walls;
  }
};

// Surer than it should have been, and 0.7 m off: what the map shows puts it right.
TEST_F(PoseTrackerTest, AMatchThatFitsBetterOverrulesTheMotion) {
  const Walls room = Room(14.0, 9.0);
  const std::vector<LaserScan> log = Drive(room, 0, 320, 0.0);
  const BuildingMap map = MapOf(log);
  const KnownMap known(map, UsualFloorSearch());
  PoseTracker tracker(known, LoopClosureOptions());
  const Pose2 truth = *log[100].T_odom_robot;
  const UncertainPose2 guess = Guess({truth.x + 0.7, truth.y, truth.theta}, 0.25, 2.0);
  const std::optional<UncertainPose2> match = tracker.Match(log[100], 0, guess);
  ASSERT_TRUE(match.has_value());
  EXPECT_LT(Distance(match->mean, truth), 0.1);
}

// Among equal teeth a pose some teeth off looks much the same; the ends of the hall tell.
TEST_F(PoseTrackerTest, AScanFitsBestFromWhereItWasTaken) {
  const std::vector<LaserScan> log = Drive(Hall(), 0, 320, 0.0);
  const BuildingMap map = MapOf(log);
  const KnownMap known(map, UsualFloorSearch());
  int right = 0;
  int tried = 0;
  for (std::size_t i = 20; i < log.size(); i += 20) {
    const Pose2 truth = *log[i].T_odom_robot;
    for (const double teeth : {-2.0, -1.0, 1.0, 2.0}) {
      // The hall lies turned in the map, whose first pose is its origin.
      const double heading = -kFirstHeading;
      const Eigen::Vector2d step =
          2.0 * teeth * Eigen::Vector2d(std::cos(heading), std::sin(heading));
      const Pose2 shifted{truth.x + step.x(), truth.y + step.y(), truth.theta};
      ++tried;
      right += FitsBetter(log[i], *known.FloorAt(0), truth, shifted) ? 1 : 0;
      EXPECT_FALSE(FitsBetter(log[i], *known.FloorAt(0), shifted, truth)) << i << ' ' << teeth;
    }
  }
  EXPECT_EQ(right, tried);
}

TEST_F(PoseTrackerTest, WhereTheMapHasNoNodeNothingIsMatched) {
  const std::vector<LaserScan> log = Drive(Room(14.0, 9.0), 0, 60, 0.0);
  const BuildingMap map = MapOf(log);
  const KnownMap known(map, UsualFloorSearch());
  PoseTracker tracker(known, LoopClosureOptions());
  EXPECT_FALSE(tracker.Match(log[10], 0, Guess({200.0, 0.0, 0.0}, 0.5, 2.0)).has_value());
  EXPECT_EQ(tracker.matches(), 0);
}

}  // namespace
}  // namespace masked_mapper
