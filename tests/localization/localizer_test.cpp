// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/localization/localizer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/mapping/masked_mapper.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Walls of a room that is like itself from nowhere else: 14 m x 9 m, with things in it.
struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using Walls = std::vector<Wall>;

Walls Room(double width, double depth) {
  Walls walls{{{0, 0}, {width, 0}},
              {{width, 0}, {width, depth}},
              {{width, depth}, {0, depth}},
              {{0, depth}, {0, 0}}};
  for (const auto& [x, y, size] : {std::tuple{2.0, 6.5, 0.8},
                                   {5.5, 7.5, 1.5},
                                   {9.0, 6.0, 0.5},
                                   {12.0, 7.0, 1.1},
                                   {7.0, 1.0, 0.6}}) {
    walls.push_back({{x, y}, {x + size, y}});
    walls.push_back({{x + size, y}, {x + size, y + 0.5 * size}});
    walls.push_back({{x + size, y + 0.5 * size}, {x, y + 0.5 * size}});
    walls.push_back({{x, y + 0.5 * size}, {x, y}});
  }
  return walls;
}

double RangeTo(const Walls& walls, const Eigen::Vector2d& origin, double angle) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = 1e9;
  for (const Wall& wall : walls) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const Eigen::Vector2d off = wall.from - origin;
    const double range = (off.x() * along.y() - off.y() * along.x()) / cross;
    const double share = (off.x() * direction.y() - off.y() * direction.x()) / cross;
    if (range > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// Round and round through the room, from a corner of the way on; odometry begins at zero.
std::vector<LaserScan> Drive(const Walls& walls, int first, int scans, double stamp) {
  const auto pose_at = [](int i) {
    const double turn = 0.02 * i;
    return Pose2{7.0 + 4.5 * std::cos(turn), 4.0 + 1.6 * std::sin(turn),
                 std::atan2(1.6 * std::cos(turn), -4.5 * std::sin(turn))};
  };
  const Pose2 T_room_odom = pose_at(first);
  std::vector<LaserScan> log;
  for (int i = first; i < first + scans; ++i) {
    LaserScan scan;
    scan.stamp = scan.log_stamp = stamp + 0.2 * (i - first);
    scan.first_angle = -0.75 * M_PI;
    scan.angle_step = 1.5 * M_PI / 360.0;
    scan.max_range = 30.0F;
    const Pose2 T_room_robot = pose_at(i);
    scan.T_odom_robot = Between(T_room_odom, T_room_robot);
    for (int beam = 0; beam <= 360; ++beam) {
      const double angle = T_room_robot.theta + scan.Angle(static_cast<std::size_t>(beam));
      const double noise = 0.01 * std::sin(37.0 * beam + 11.0 * i);
      scan.ranges.push_back(
          static_cast<float>(RangeTo(walls, T_room_robot.Translation(), angle) + noise));
    }
    log.push_back(std::move(scan));
  }
  return log;
}

class LocalizerTest : public testing::Test {
 protected:
  static BuildingMap MapOf(const std::vector<LaserScan>& log) {
    static const FloorTimeline kOneFloor;
    MappingOptions options;
    options.motion.source = MotionSource::kFused;
    MaskedMapper mapper("always", options, kOneFloor);
    for (const LaserScan& scan : log) mapper.Observe(scan);
    return mapper.Finish();
  }
  static LocalizerOptions Usual() {
    LocalizerOptions options;
    options.floor_search.fine = FineSearchOptions();
    options.floor_search.seen.resolution_m = 0.2;
    options.floor_search.seen.min_hits = 1;
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
