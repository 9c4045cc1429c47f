// SPDX-License-Identifier: BSD-3-Clause
#include "motion/floor_lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

struct Wall {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};
using Walls = std::vector<Wall>;

/// A closed line through the points.
void AddLine(const std::vector<Eigen::Vector2d>& points, Walls& walls) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) walls.push_back({points[i], points[i + 1]});
}

/// A corridor along x, 2 m wide and 40 m long, with a shaft on its side around (0, 2.2); `kind`
/// changes what stands in the corridor. The door of the cab is not among the walls.
Walls Floor(int kind) {
  Walls walls;
  AddLine({{-0.55, 1.0}, {-20.0, 1.0}, {-20.0, -1.0}, {20.0, -1.0}, {20.0, 1.0}, {0.55, 1.0}},
          walls);
  AddLine({{-0.55, 1.0},
           {-0.55, 1.2},
           {-1.0, 1.2},
           {-1.0, 3.2},
           {1.0, 3.2},
           {1.0, 1.2},
           {0.55, 1.2},
           {0.55, 1.0}},
          walls);
  for (int i = 0; i < 3 * kind; ++i) {
    const double x = -7.0 + 2.3 * i;
    AddLine({{x, -1.0}, {x, -0.6}, {x + 0.7, -0.6}, {x + 0.7, -1.0}}, walls);
  }
  return walls;
}

/// Metres to the nearest wall, 30 when there is none.
double Range(const Walls& walls, const Eigen::Vector2d& eye, double angle) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = 30.0;
  for (const Wall& wall : walls) {
    const Eigen::Vector2d along = wall.b - wall.a;
    const Eigen::Vector2d to_wall = wall.a - eye;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const double range = (to_wall.x() * along.y() - to_wall.y() * along.x()) / cross;
    const double share = (to_wall.x() * direction.y() - to_wall.y() * direction.x()) / cross;
    if (range > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

struct Sensor {
  double field_of_view_deg = 270.0;
  std::size_t beams = 361;
};

/// Drives and sees; the clock goes by scans at 5 Hz.
class Robot {
 public:
  Robot(LidarTrack* lidar, WheelTrack* track, const Sensor& sensor)
      : lidar_(lidar), track_(track), sensor_(sensor) {}

  Walls walls;
  bool door_is_closed = false;
  Pose2 pose;

  void Wait(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.2) See();
  }
  void DriveTo(double x, double y) {
    const Eigen::Vector2d way = Eigen::Vector2d(x, y) - pose.Translation();
    TurnTo(std::atan2(way.y(), way.x()));
    const int steps = std::max(1, static_cast<int>(way.norm() / 0.1));
    const Eigen::Vector2d start = pose.Translation();
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector2d at = start + way * i / steps;
      pose.x = at.x();
      pose.y = at.y();
      See();
    }
  }
  void TurnTo(double theta) {
    const double turn = WrapAngle(theta - pose.theta);
    const int steps = std::max(1, static_cast<int>(std::abs(turn) / 0.16));
    const double start = pose.theta;
    for (int i = 1; i <= steps; ++i) {
      pose.theta = WrapAngle(start + turn * i / steps);
      See();
    }
  }
  double stamp() const { return stamp_; }

 private:
  void See() {
    Walls all = walls;
    if (door_is_closed) all.push_back({{-0.55, 1.1}, {0.55, 1.1}});
    LaserScan scan;
    scan.stamp = stamp_ += 0.2;
    const double field = DegToRad(sensor_.field_of_view_deg);
    scan.angle_step = field / static_cast<double>(sensor_.beams - 1);
    if (sensor_.field_of_view_deg == 360.0)
      scan.angle_step = field / static_cast<double>(sensor_.beams);
    scan.first_angle = -0.5 * field;
    scan.max_range = 30.0F;
    scan.T_odom_robot = pose;
    for (std::size_t i = 0; i < sensor_.beams; ++i) {
      const double nearest = Range(all, pose.Translation(), pose.theta + scan.Angle(i));
      scan.ranges.push_back(nearest < 30.0 ? static_cast<float>(nearest) : kNoReturn);
    }
    lidar_->Observe(scan);
    track_->Observe({scan.stamp, pose});
  }

  LidarTrack* lidar_;
  WheelTrack* track_;
  Sensor sensor_;
  double stamp_ = 0.0;
};

enum class Turn { kBefore, kDuring, kAfter };

struct Story {
  Sensor sensor;
  Turn turn = Turn::kDuring;
  int kind_before = 0;
  int kind_after = 0;
  bool door_moves = true;  ///< false: a recess, nothing else
};

struct Outcome {
  std::vector<FloorTransit> rides;
  double closed = 0.0;  ///< s, when the door closed
  double opened = 0.0;
};

/// Along the corridor, into the cab, a ride, out again and on.
Outcome Tell(const Story& story) {
  LidarTrack lidar{FloorLidarOptions{}};
  WheelTrack track;
  Robot robot(&lidar, &track, story.sensor);
  Outcome outcome;
  robot.walls = Floor(story.kind_before);
  robot.pose = {-9.0, 0.0, 0.0};
  robot.door_is_closed = story.door_moves;
  robot.DriveTo(0.0, 0.0);
  robot.TurnTo(0.5 * kPi);
  robot.Wait(5.0);
  robot.door_is_closed = false;
  robot.Wait(1.0);
  robot.DriveTo(0.0, 2.2);
  if (story.turn == Turn::kBefore) robot.TurnTo(-0.5 * kPi);
  robot.Wait(1.0);
  robot.door_is_closed = story.door_moves;
  outcome.closed = robot.stamp();
  robot.Wait(4.0);
  robot.walls = Floor(story.kind_after);
  if (story.turn == Turn::kDuring) robot.TurnTo(-0.5 * kPi);
  robot.Wait(4.0);
  robot.door_is_closed = false;
  outcome.opened = robot.stamp();
  robot.Wait(1.0);
  robot.TurnTo(-0.5 * kPi);
  robot.DriveTo(0.0, 0.0);
  robot.DriveTo(9.0, 0.0);
  outcome.rides = lidar.FindRides(track);
  return outcome;
}

TEST(FloorLidar, ACabIsAClosedBoxAndACorridorIsNot) {
  LaserScan scan;
  scan.angle_step = DegToRad(1.0);
  scan.max_range = 30.0F;
  scan.ranges.assign(360, 1.2F);
  EXPECT_TRUE(IsClosedBox(scan, {}));
  for (int i = 0; i < 8; ++i) scan.ranges[static_cast<std::size_t>(i)] = 12.0F;
  EXPECT_TRUE(IsClosedBox(scan, {})) << "a gap of the door";
  for (int i = 0; i < 20; ++i) scan.ranges[static_cast<std::size_t>(i)] = kNoReturn;
  EXPECT_FALSE(IsClosedBox(scan, {}));
  scan.ranges.assign(360, 2.5F);
  EXPECT_FALSE(IsClosedBox(scan, {})) << "20 m^2";
  scan.ranges.assign(360, kInvalidRange);
  EXPECT_FALSE(IsClosedBox(scan, {}));
  scan.ranges.clear();
  EXPECT_FALSE(IsClosedBox(scan, {}));
}

TEST(FloorLidar, NoticesARideHoweverTheRobotTurns) {
  for (const double field_of_view : {180.0, 270.0, 360.0}) {
    for (const Turn turn : {Turn::kBefore, Turn::kDuring, Turn::kAfter}) {
      for (const int kind_after : {0, 2}) {
        Story story;
        story.sensor.field_of_view_deg = field_of_view;
        story.turn = turn;
        story.kind_after = kind_after;
        const Outcome outcome = Tell(story);
        ASSERT_EQ(outcome.rides.size(), 1U)
            << field_of_view << " deg, turn " << static_cast<int>(turn) << ", floor " << kind_after;
        EXPECT_FALSE(outcome.rides[0].climb);
        EXPECT_LE(outcome.rides[0].start, outcome.closed);
        EXPECT_GE(outcome.rides[0].end, outcome.opened);
        EXPECT_LT(outcome.rides[0].end - outcome.rides[0].start,
                  outcome.opened - outcome.closed + 15.0);
      }
    }
  }
}

TEST(FloorLidar, ARecessWithoutADoorIsNoCab) {
  for (const double field_of_view : {180.0, 270.0, 360.0}) {
    for (const Turn turn : {Turn::kBefore, Turn::kDuring, Turn::kAfter}) {
      Story story;
      story.sensor.field_of_view_deg = field_of_view;
      story.turn = turn;
      story.door_moves = false;
      EXPECT_TRUE(Tell(story).rides.empty())
          << field_of_view << " deg, turn " << static_cast<int>(turn);
    }
  }
}

/// Nose first into a nook whose way out bends, half a turn, and out again.
std::vector<FloorTransit> RidesOfNook(double field_of_view_deg) {
  LidarTrack lidar{FloorLidarOptions{}};
  WheelTrack track;
  Robot robot(&lidar, &track, {field_of_view_deg, 361});
  AddLine({{-8.0, -1.0},
           {8.0, -1.0},
           {8.0, 1.0},
           {1.0, 1.0},
           {1.0, 2.2},
           {2.6, 2.2},
           {2.6, 4.2},
           {0.6, 4.2},
           {0.6, 3.3},
           {-0.3, 3.3},
           {-0.3, 1.0},
           {-8.0, 1.0},
           {-8.0, -1.0}},
          robot.walls);
  robot.pose = {-6.0, 0.0, 0.0};
  robot.DriveTo(0.35, 0.0);
  robot.DriveTo(0.35, 2.6);
  robot.DriveTo(1.7, 3.3);
  robot.Wait(6.0);
  robot.TurnTo(robot.pose.theta + kPi);
  robot.Wait(1.0);
  robot.DriveTo(0.35, 2.6);
  robot.DriveTo(0.35, 0.0);
  robot.DriveTo(6.0, 0.0);
  return lidar.FindRides(track);
}

TEST(FloorLidar, ANookRoundACornerIsNoCab) {
  for (const double field_of_view : {180.0, 270.0}) {
    EXPECT_TRUE(RidesOfNook(field_of_view).empty()) << field_of_view << " deg";
  }
}

TEST(FloorLidar, OpensALevelThatMayBeAnyOther) {
  const Outcome outcome = Tell({});
  const FloorTimeline timeline = TimelineOfTransits(outcome.rides, {});
  ASSERT_EQ(timeline.levels.size(), 2U);
  EXPECT_FALSE(timeline.levels[1].identity_known);
  EXPECT_FALSE(timeline.levels[1].elevation_measured);
  EXPECT_TRUE(timeline.At(0.5 * (outcome.closed + outcome.opened)).in_transit);
}

TEST(FloorLidar, SameSceneAgreesAndAnotherDoesNot) {
  const auto look = [](int kind, double from, double to) {
    std::deque<PlacedScan> way;
    for (double x = from; x <= to; x += 0.5) {
      LaserScan scan;
      scan.first_angle = -kPi;
      scan.angle_step = DegToRad(1.0);
      scan.max_range = 30.0F;
      for (std::size_t i = 0; i < 360; ++i) {
        scan.ranges.push_back(static_cast<float>(Range(Floor(kind), {x, 0.0}, scan.Angle(i))));
      }
      way.push_back({{x, 0.0, 0.0}, scan});
    }
    return way;
  };
  const FloorLidarOptions options;
  EXPECT_GT(SceneAgreement(look(0, -6.0, -1.0), look(0, 1.0, 6.0), {}, options).value_or(0.0),
            0.99);
  EXPECT_LT(SceneAgreement(look(0, -6.0, -1.0), look(3, 1.0, 6.0), {}, options).value_or(1.0),
            0.95);
  EXPECT_FALSE(SceneAgreement({}, look(0, 1.0, 6.0), {}, options));
}

TEST(FloorLidar, ScansWithoutBeamsTellNothing) {
  LidarTrack lidar{FloorLidarOptions{}};
  lidar.Observe(LaserScan{});
  EXPECT_FALSE(lidar.HasRanges());
  EXPECT_TRUE(lidar.FindRides({}).empty());
}

TEST(FloorLidar, ALogMayBeginAndEndInTheCab) {
  LidarTrack lidar{FloorLidarOptions{}};
  WheelTrack track;
  Robot robot(&lidar, &track, {});
  robot.walls = Floor(0);
  robot.pose = {0.0, 2.2, -0.5 * kPi};
  robot.door_is_closed = true;
  robot.Wait(8.0);
  robot.door_is_closed = false;
  robot.DriveTo(0.0, 0.0);
  robot.DriveTo(9.0, 0.0);
  robot.DriveTo(0.0, 0.0);
  robot.door_is_closed = true;
  robot.TurnTo(0.5 * kPi);
  robot.Wait(3.0);
  robot.door_is_closed = false;
  robot.DriveTo(0.0, 2.2);
  robot.door_is_closed = true;
  robot.Wait(8.0);
  const std::vector<FloorTransit> rides = lidar.FindRides(track);
  ASSERT_EQ(rides.size(), 2U);
  EXPECT_TRUE(std::isinf(rides[0].start));
  EXPECT_TRUE(std::isinf(rides[1].end));
  EXPECT_EQ(TimelineOfTransits(rides, {}).levels.size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
