// SPDX-License-Identifier: BSD-3-Clause
#include "masks/openings_mask.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "masked_mapper/log/log_reader.hpp"
#include "masks/hand_drawn.hpp"

namespace masked_mapper {
namespace {

constexpr double kStep = 0.06;  ///< m from scan to scan, as a robot of 0.3 m/s at 5 Hz

/// Drives a robot through a scene and keeps where the mask fired.
class Drive {
 public:
  Drive(Mask& mask, Scene scene, const Scanner& scanner)
      : mask_(mask), scene_(std::move(scene)), scanner_(scanner) {}

  void Stand(const Pose2& T_world_robot) {
    LaserScan scan = Look(scene_, T_world_robot, scanner_);
    scan.stamp = stamp_ += 0.2;
    mask_.Observe({scan, T_world_robot});
    if (mask_.Fires()) fired_at_.push_back(T_world_robot);
    T_world_robot_ = T_world_robot;
  }
  /// Along a straight line at a constant heading.
  void Go(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double heading) {
    const auto steps = static_cast<int>(std::ceil((to - from).norm() / kStep));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d at = from + (to - from) * (static_cast<double>(i) / steps);
      Stand({at.x(), at.y(), heading});
    }
  }
  void TurnTo(double heading) {
    const double turn = WrapAngle(heading - T_world_robot_.theta);
    const double begin = T_world_robot_.theta;
    for (int i = 1; i <= 20; ++i) {
      Stand({T_world_robot_.x, T_world_robot_.y, WrapAngle(begin + turn * i / 20.0)});
    }
  }
  const std::vector<Pose2>& fired_at() const { return fired_at_; }

 private:
  Mask& mask_;
  Scene scene_;
  Scanner scanner_;
  double stamp_ = 0.0;
  Pose2 T_world_robot_;
  std::vector<Pose2> fired_at_;
};

std::vector<Pose2> FiredAlong(const Scene& scene, const Scanner& scanner, double heading = 0.0) {
  OpeningsMask mask({});
  Drive drive(mask, scene, scanner);
  drive.Go({-6.0, 0.1}, {6.0, 0.1}, heading);
  return drive.fired_at();
}

TEST(OpeningsMask, SilentInACorridor) {
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    EXPECT_TRUE(FiredAlong(Corridor(-40.0, 40.0), scanner).empty());
  }
}

TEST(OpeningsMask, FiresAtJunctionsAndOnlyThere) {
  const Gap side{-1.0, 1.0};
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    for (const Scene& scene : {Corridor(-40.0, 40.0, {side}), Corridor(-40.0, 40.0, {}, {side}),
                               Corridor(-40.0, 40.0, {side}, {side})}) {
      const auto fired = FiredAlong(scene, scanner);
      ASSERT_FALSE(fired.empty());
      for (const Pose2& T_world_robot : fired) EXPECT_LT(std::abs(T_world_robot.x), 2.5);
    }
  }
}

TEST(OpeningsMask, SilentAtANarrowDoor) {
  EXPECT_TRUE(FiredAlong(Corridor(-40.0, 40.0, {{-0.3, 0.3}}), HalfCircle()).empty());
}

TEST(OpeningsMask, CourseIsTheWayTheRobotGoesNotWhereItLooks) {
  // Backwards along the corridor: a full circle sees the same junction.
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  const auto fired = FiredAlong(scene, FullCircle(), kPi);
  EXPECT_FALSE(fired.empty());
  for (const Pose2& T_world_robot : fired) EXPECT_LT(std::abs(T_world_robot.x), 2.5);
}

TEST(OpeningsMask, FewSightingsAreNotEnough) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  const LaserScan corridor = Look(Corridor(-40.0, 40.0), {}, HalfCircle());
  const LaserScan junction = Look(scene, {-0.5, 0.0, 0.0}, HalfCircle());
  OpeningsMask mask({});
  for (int i = 0; i < 40; ++i) {
    // Every fourth scan shows a side opening, as when people pass before a wall of mirrors.
    mask.Observe({i % 4 == 0 ? junction : corridor, {0.2 * i, 0.0, 0.0}});
    EXPECT_FALSE(mask.Fires()) << "scan " << i;
  }
}

TEST(OpeningsMask, RobotAtRestSeesNothingNew) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  OpeningsMask mask({});
  Drive drive(mask, scene, HalfCircle());
  for (int i = 0; i < 100; ++i) drive.Stand({-0.5, 0.0, 0.0});
  EXPECT_FALSE(mask.Fires()) << "one view, however long";
  drive.Go({-0.5, 0.0}, {0.0, 0.0}, 0.0);
  const bool fires = mask.Fires();
  EXPECT_TRUE(fires);
  for (int i = 0; i < 100; ++i) drive.Stand({0.0, 0.0, 0.0});
  EXPECT_EQ(mask.Fires(), fires);
}

TEST(OpeningsMask, TurningOnTheSpotDoesNotTurnTheCourse) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  OpeningsMask mask({});
  Drive drive(mask, scene, FullCircle());
  drive.Go({-4.0, 0.0}, {0.0, 0.0}, 0.0);
  ASSERT_TRUE(mask.Fires());
  drive.TurnTo(kPi / 2.0);
  EXPECT_TRUE(mask.Fires()) << "the side corridor still lies 90 degrees off the way it came";
}

TEST(OpeningsMask, DeadEndFiresOnceTheRobotHasTurnedBack) {
  const Scene scene = Closed(Corridor(-40.0, 40.0), 6.0);
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    OpeningsMask mask({});
    Drive drive(mask, scene, scanner);
    drive.Stand({0.0, 0.0, 0.0});
    mask.OnNode();
    drive.Go({0.0, 0.0}, {5.0, 0.0}, 0.0);
    EXPECT_TRUE(drive.fired_at().empty());
    drive.TurnTo(DegToRad(140.0));
    EXPECT_FALSE(mask.Fires());
    drive.TurnTo(DegToRad(-170.0));
    EXPECT_TRUE(mask.Fires());
    mask.OnNode();
    drive.Go({5.0, 0.0}, {-5.0, 0.0}, kPi);
    EXPECT_FALSE(mask.Fires()) << "on its way back it has not turned again";
  }
}

TEST(OpeningsMask, ReversingIsNotTurning) {
  const Scene scene = Corridor(-40.0, 40.0);
  OpeningsMask mask({});
  Drive drive(mask, scene, FullCircle());
  drive.Stand({0.0, 0.0, 0.0});
  mask.OnNode();
  drive.Go({0.0, 0.0}, {-6.0, 0.0}, 0.0);
  EXPECT_TRUE(drive.fired_at().empty());
}

TEST(OpeningsMask, RestartForgets) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  OpeningsMask mask({});
  Drive drive(mask, scene, HalfCircle());
  drive.Go({-4.0, 0.0}, {-0.3, 0.0}, 0.0);
  ASSERT_TRUE(mask.Fires());
  mask.Restart();
  EXPECT_FALSE(mask.Fires());
  drive.Stand({30.0, 0.0, 0.0});
  EXPECT_FALSE(mask.Fires());
}

TEST(OpeningsMask, ScansWithNothingInThem) {
  OpeningsMask mask({});
  LaserScan free = Look({}, {}, FullCircle());
  LaserScan invalid = free;
  std::fill(invalid.ranges.begin(), invalid.ranges.end(), kInvalidRange);
  for (int i = 0; i < 30; ++i) {
    for (const LaserScan& scan : {free, invalid, LaserScan{}}) {
      mask.Observe({scan, {0.1 * i, 0.0, 0.0}});
      EXPECT_FALSE(mask.Fires());
    }
  }
}

TEST(Course, FollowsThePathAndStandsAtRest) {
  Course course(0.5);
  course.Observe({0.0, 0.0, 0.3});
  EXPECT_DOUBLE_EQ(course.Direction(), 0.3) << "before the first motion: the heading";
  for (int i = 1; i <= 20; ++i) course.Observe({0.1 * i, 0.0, 0.3});
  EXPECT_NEAR(course.Direction(), 0.0, 1e-9);
  for (int i = 0; i < 50; ++i) course.Observe({2.0 + 0.001 * (i % 2), 0.0, 0.1 * i});
  EXPECT_NEAR(course.Direction(), 0.0, 1e-2);
  for (int i = 1; i <= 7; ++i) course.Observe({2.0, 0.1 * i, kPi / 2.0});
  EXPECT_NEAR(course.Direction(), kPi / 2.0, 0.1);
}

TEST(DirectionTracks, GoOnAcrossTheSeamOfAngles) {
  DirectionTracks tracks({});
  for (int i = 0; i < 6; ++i) {
    tracks.Observe(0.1 * i, {i % 2 == 0 ? kPi - 0.02 : -kPi + 0.02, 1.0 + 0.01 * i});
  }
  const auto kept = tracks.Kept();
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_NEAR(std::abs(kept[0]), kPi, 0.03);
  EXPECT_NEAR(kept[1], 1.025, 0.03);
}

TEST(DirectionTracks, UnsteadyDirectionsAreNotKept) {
  OpeningsMaskOptions options;
  options.max_deviation_deg = 5.0;
  DirectionTracks steady(options);
  DirectionTracks unsteady(options);
  for (int i = 0; i < 6; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    steady.Observe(0.1 * i, {DegToRad(4.0) * sign});
    unsteady.Observe(0.1 * i, {DegToRad(7.0) * sign});
  }
  EXPECT_EQ(steady.Kept().size(), 1U);
  EXPECT_TRUE(unsteady.Kept().empty());
}

// Real logs.

struct Visit {
  double stamp;
  Pose2 T_odom_robot;
  bool is_node;
};

/// The rule of Algorithm 1: a node where the mask fires, more than 1.5 m from the last.
std::vector<Visit> Nodes(const std::string& path, Mask& mask) {
  std::vector<Visit> visits;
  std::optional<Pose2> T_odom_node;
  const auto log = OpenLog(path, {});
  while (const auto observation = log->Next()) {
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr || !scan->T_odom_robot) continue;
    const Pose2& T_odom_robot = *scan->T_odom_robot;
    mask.Observe({*scan, T_odom_robot});
    const bool is_node =
        !T_odom_node || (mask.Fires() && Distance(*T_odom_node, T_odom_robot) > 1.5);
    if (is_node) {
      T_odom_node = T_odom_robot;
      mask.OnNode();
    }
    visits.push_back({scan->stamp, T_odom_robot, is_node});
  }
  return visits;
}

/// What `always` makes of the same drive.
std::size_t DensestNodes(const std::vector<Visit>& visits) {
  std::size_t count = 1;
  Pose2 T_odom_node = visits.front().T_odom_robot;
  for (const Visit& visit : visits) {
    if (Distance(T_odom_node, visit.T_odom_robot) <= 1.5) continue;
    T_odom_node = visit.T_odom_robot;
    ++count;
  }
  return count;
}

std::size_t Count(const std::vector<Visit>& visits) {
  return static_cast<std::size_t>(std::count_if(visits.begin(), visits.end(),
                                                [](const Visit& visit) { return visit.is_node; }));
}

std::string RealLog(const std::string& name) {
  return std::string(MASKED_MAPPER_REAL_LOGS) + "/data/" + name;
}

TEST(OpeningsMaskOnRealLogs, FiresAFractionOfAlways) {
  struct Expected {
    const char* log;
    double max_share;
  };
  // Corridors; offices along a corridor; halls and cubicles.
  for (const Expected& expected :
       {Expected{"aces.clf.gz", 1.0 / 3.0}, Expected{"fr079.clf.gz", 0.6},
        Expected{"mit-csail.clf.gz", 0.6}}) {
    if (!std::ifstream(RealLog(expected.log))) GTEST_SKIP() << "no log " << expected.log;
    OpeningsMask mask({});
    const auto visits = Nodes(RealLog(expected.log), mask);
    const auto nodes = static_cast<double>(Count(visits));
    const auto densest = static_cast<double>(DensestNodes(visits));
    EXPECT_LE(nodes, expected.max_share * densest) << expected.log;
    EXPECT_GE(nodes, 0.1 * densest) << expected.log;
  }
}

TEST(OpeningsMaskOnRealLogs, EveryJunctionOfAcesGetsANodeInEveryPass) {
  std::ifstream reference_file(RealLog("aces.reference.txt"));
  if (!reference_file || !std::ifstream(RealLog("aces.clf.gz"))) GTEST_SKIP() << "no ACES log";
  OpeningsMask mask({});
  const auto visits = Nodes(RealLog("aces.clf.gz"), mask);

  // Poses of the reference, carried to every scan by odometry.
  struct Key {
    double stamp;
    Pose2 T_world_robot;
    Pose2 T_odom_robot;
  };
  std::vector<Key> keys;
  for (std::string line; std::getline(reference_file, line);) {
    Key key{};
    std::istringstream fields(line);
    if (!(fields >> key.stamp >> key.T_world_robot.x >> key.T_world_robot.y >>
          key.T_world_robot.theta)) {
      continue;
    }
    const auto nearest =
        std::min_element(visits.begin(), visits.end(), [&](const Visit& a, const Visit& b) {
          return std::abs(a.stamp - key.stamp) < std::abs(b.stamp - key.stamp);
        });
    key.T_odom_robot = nearest->T_odom_robot;
    keys.push_back(key);
  }
  ASSERT_GT(keys.size(), 100U);
  std::vector<Pose2> T_world_robot;
  std::size_t key = 0;
  for (const Visit& visit : visits) {
    while (key + 1 < keys.size() &&
           std::abs(keys[key + 1].stamp - visit.stamp) < std::abs(keys[key].stamp - visit.stamp)) {
      ++key;
    }
    T_world_robot.push_back(keys[key].T_world_robot *
                            Between(keys[key].T_odom_robot, visit.T_odom_robot));
  }

  // The rotunda, the four T-junctions and the three corners driven round, read off the plan.
  const std::vector<Eigen::Vector2d> junctions = {{-0.6, -18.7}, {-19.7, -18.4}, {23.0, -18.9},
                                                  {-0.9, -38.3}, {-0.4, -0.1},   {-19.3, -0.1},
                                                  {23.4, -0.3},  {-20.6, -38.7}};
  int passes = 0;
  for (const Eigen::Vector2d& junction : junctions) {
    const auto distance = [&](std::size_t i) {
      return (T_world_robot[i].Translation() - junction).norm();
    };
    for (std::size_t i = 0; i < visits.size(); ++i) {
      if (distance(i) > 2.0 || (i > 0 && distance(i - 1) <= 2.0)) continue;
      // A pass goes on for as long as the robot is near, before and after.
      std::size_t begin = i;
      std::size_t end = i;
      while (begin > 0 && distance(begin - 1) < 4.0) --begin;
      while (end + 1 < visits.size() && distance(end + 1) < 4.0) ++end;
      ++passes;
      EXPECT_TRUE(std::any_of(visits.begin() + static_cast<std::ptrdiff_t>(begin),
                              visits.begin() + static_cast<std::ptrdiff_t>(end) + 1,
                              [](const Visit& visit) { return visit.is_node; }))
          << "no node within 4 m of (" << junction.transpose() << ") at " << visits[i].stamp
          << " s";
    }
  }
  EXPECT_GE(passes, 12);
}

}  // namespace
}  // namespace masked_mapper
