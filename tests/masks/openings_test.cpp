// SPDX-License-Identifier: BSD-3-Clause
#include "masks/openings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "masks/hand_drawn.hpp"

namespace masked_mapper {
namespace {

std::vector<double> DirectionsDeg(const LaserScan& scan, const OpeningOptions& options = {}) {
  std::vector<double> directions;
  for (const Opening& opening : FindOpenings(scan, options)) {
    directions.push_back(RadToDeg(opening.direction));
  }
  return directions;
}

bool HasDirection(const std::vector<double>& directions_deg, double wanted_deg, double within_deg) {
  return std::any_of(directions_deg.begin(), directions_deg.end(), [&](double direction) {
    return std::abs(RadToDeg(WrapAngle(DegToRad(direction - wanted_deg)))) <= within_deg;
  });
}

bool HasSideOpening(const LaserScan& scan, double sign) {
  const auto directions = DirectionsDeg(scan);
  return std::any_of(directions.begin(), directions.end(), [&](double direction) {
    return sign * direction > 35.0 && sign * direction < 145.0;
  });
}

TEST(FindOpenings, CorridorLeadsOnlyAheadAndBack) {
  const Scene corridor = Corridor(-40.0, 40.0);
  const auto half = DirectionsDeg(Look(corridor, {}, HalfCircle()));
  ASSERT_EQ(half.size(), 1U);
  EXPECT_NEAR(half[0], 0.0, 5.0);

  const auto full = DirectionsDeg(Look(corridor, {}, FullCircle()));
  ASSERT_EQ(full.size(), 2U);
  EXPECT_TRUE(HasDirection(full, 0.0, 5.0));
  EXPECT_TRUE(HasDirection(full, 180.0, 5.0));
}

TEST(FindOpenings, WidthOfACorridorIsThatBetweenItsWalls) {
  const auto openings = FindOpenings(Look(Corridor(-40.0, 40.0), {}, HalfCircle()), {});
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].width, 2.0, 0.01);
}

TEST(FindOpenings, JunctionsToLeftRightAndBoth) {
  const Gap side{1.0, 3.0};
  const Scene left = Corridor(-40.0, 40.0, {side});
  const Scene right = Corridor(-40.0, 40.0, {}, {side});
  const Scene both = Corridor(-40.0, 40.0, {side}, {side});
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    // From where the middle of the side corridor is at 63 degrees.
    const Pose2 T_world_robot{1.5, 0.0, 0.0};
    EXPECT_TRUE(HasSideOpening(Look(left, T_world_robot, scanner), 1.0));
    EXPECT_FALSE(HasSideOpening(Look(left, T_world_robot, scanner), -1.0));
    EXPECT_FALSE(HasSideOpening(Look(right, T_world_robot, scanner), 1.0));
    EXPECT_TRUE(HasSideOpening(Look(right, T_world_robot, scanner), -1.0));
    EXPECT_TRUE(HasSideOpening(Look(both, T_world_robot, scanner), 1.0));
    EXPECT_TRUE(HasSideOpening(Look(both, T_world_robot, scanner), -1.0));
  }
}

TEST(FindOpenings, RefinesToTheMouthOfASideCorridor) {
  const Scene scene = Corridor(-40.0, 40.0, {{-0.6, 0.6}});
  const auto openings = FindOpenings(Look(scene, {}, FullCircle()), {});
  const auto side = std::find_if(openings.begin(), openings.end(), [](const Opening& opening) {
    return std::abs(opening.direction - kPi / 2.0) < DegToRad(10.0);
  });
  ASSERT_NE(side, openings.end());
  EXPECT_NEAR(side->width, 1.2, 0.03);
  EXPECT_NEAR(side->left_in_robot.x(), -0.6, 0.03);
  EXPECT_NEAR(side->right_in_robot.x(), 0.6, 0.03);
  EXPECT_LE(side->left_in_robot.y(), 5.0);
}

TEST(FindOpenings, TJunctionAtTheEndOfACorridor) {
  // The corridor ends on a wall 2 m beyond its side walls.
  Scene scene;
  for (const double y : {-1.0, 1.0}) {
    scene.push_back({{-40.0, y}, {3.0, y}, {3.0, 20.0 * y}});
  }
  scene.push_back({{5.0, -20.0}, {5.0, 20.0}});
  const auto directions = DirectionsDeg(Look(scene, {3.4, 0.0, 0.0}, HalfCircle()));
  EXPECT_TRUE(HasDirection(directions, 60.0, 25.0));
  EXPECT_TRUE(HasDirection(directions, -60.0, 25.0));
  EXPECT_FALSE(HasDirection(directions, 0.0, 20.0));
}

TEST(FindOpenings, CrossingHasFourWays) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}}, {{-1.0, 1.0}});
  const auto directions = DirectionsDeg(Look(scene, {}, FullCircle()));
  ASSERT_EQ(directions.size(), 4U);
  for (const double way : {0.0, 90.0, 180.0, -90.0})
    EXPECT_TRUE(HasDirection(directions, way, 5.0));
}

TEST(FindOpenings, DeadEndHasNoneAhead) {
  const Scene scene = Closed(Corridor(-40.0, 40.0), 3.0);
  EXPECT_TRUE(FindOpenings(Look(scene, {}, HalfCircle()), {}).empty());
  const auto full = DirectionsDeg(Look(scene, {}, FullCircle()));
  ASSERT_EQ(full.size(), 1U);
  EXPECT_TRUE(HasDirection(full, 180.0, 5.0));
}

TEST(FindOpenings, DoorIsKeptByItsWidth) {
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    EXPECT_FALSE(HasSideOpening(Look(Corridor(-40.0, 40.0, {{-0.3, 0.3}}), {}, scanner), 1.0));
    EXPECT_TRUE(
        HasSideOpening(Look(Corridor(-40.0, 40.0, {{-0.45, 0.45}}), {}, FullCircle()), 1.0));
  }
}

TEST(FindOpenings, OpeningMustBeWideEnoughAsSeen) {
  // 1 m in a wall 4.9 m ahead is 11.6 degrees across, 0.5 m is 5.8.
  OpeningOptions options;
  options.min_width_m = 0.0;
  const auto is_open_ahead = [&](double half_width) {
    const Scene wall{{{4.9, -20.0}, {4.9, -half_width}}, {{4.9, half_width}, {4.9, 20.0}}};
    return HasDirection(DirectionsDeg(Look(wall, {}, HalfCircle()), options), 0.0, 3.0);
  };
  EXPECT_TRUE(is_open_ahead(0.50));
  EXPECT_FALSE(is_open_ahead(0.25));
}

TEST(FindOpenings, SeamOfAFullCircleChangesNothing) {
  const Scene scene = Corridor(-40.0, 40.0, {{-1.0, 1.0}});
  const LaserScan scan = Look(scene, {}, FullCircle());
  const auto wanted = DirectionsDeg(scan);
  ASSERT_EQ(wanted.size(), 3U);
  for (const std::size_t shift : {90U, 180U, 350U, 360U, 361U, 540U, 719U}) {
    LaserScan turned = scan;
    std::rotate(turned.ranges.begin(), turned.ranges.begin() + static_cast<std::ptrdiff_t>(shift),
                turned.ranges.end());
    turned.first_angle = scan.Angle(shift);
    const auto found = DirectionsDeg(turned);
    ASSERT_EQ(found.size(), wanted.size()) << "seam moved by " << shift << " beams";
    for (const double direction : wanted) EXPECT_TRUE(HasDirection(found, direction, 0.1));
  }
}

TEST(FindOpenings, HalfCircleDoesNotGoOnAcrossItsEnds) {
  // Free at both ends of the view, walled ahead: two openings, not one behind.
  const Scene scene{{{1.0, -3.0}, {1.0, 3.0}}};
  const auto directions = DirectionsDeg(Look(scene, {}, HalfCircle()));
  EXPECT_EQ(directions.size(), 2U);
}

TEST(FindOpenings, MirroredScannerSeesTheSame) {
  const Scene scene = Corridor(-40.0, 40.0, {{1.0, 3.0}});
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    const LaserScan scan = Look(scene, {1.5, 0.2, 0.1}, scanner);
    LaserScan mirrored = scan;
    std::reverse(mirrored.ranges.begin(), mirrored.ranges.end());
    mirrored.first_angle = scan.Angle(scan.size() - 1);
    mirrored.angle_step = -scan.angle_step;
    const auto wanted = DirectionsDeg(scan);
    const auto found = DirectionsDeg(mirrored);
    ASSERT_EQ(found.size(), wanted.size());
    for (const double direction : wanted) EXPECT_TRUE(HasDirection(found, direction, 0.01));
  }
}

TEST(FindOpenings, LaserOffsetMovesTheEndsToTheRobotFrame) {
  const Scene scene = Corridor(-40.0, 40.0, {{-0.6, 0.6}});
  const Pose2 T_robot_laser{0.5, 0.1, 0.3};
  const Pose2 T_world_robot = Inverse(T_robot_laser);
  const auto from_robot = FindOpenings(Look(scene, T_world_robot, FullCircle(), T_robot_laser), {});
  const auto from_laser = FindOpenings(Look(scene, {}, FullCircle()), {});
  ASSERT_EQ(from_robot.size(), from_laser.size());
  for (const Opening& wanted : from_laser) {
    const Eigen::Vector2d left = T_robot_laser * wanted.left_in_robot;
    EXPECT_TRUE(std::any_of(from_robot.begin(), from_robot.end(), [&](const Opening& opening) {
      return (opening.left_in_robot - left).norm() < 1e-3 &&
             std::abs(WrapAngle(opening.direction - wanted.direction - T_robot_laser.theta)) < 1e-3;
    }));
  }
}

TEST(FindOpenings, NoReturnIsFarWhateverTheReach) {
  Scanner short_sighted = HalfCircle();
  short_sighted.max_range = 4.0F;
  const auto directions = DirectionsDeg(Look(Corridor(-40.0, 40.0), {}, short_sighted));
  ASSERT_EQ(directions.size(), 1U);
  EXPECT_NEAR(directions[0], 0.0, 5.0);
}

TEST(FindOpenings, OnlyManyInvalidBeamsCutARun) {
  LaserScan scan = Look(Corridor(-40.0, 40.0, {{-2.0, 2.0}}), {}, FullCircle());
  const std::size_t side = FindOpenings(scan, {}).size();
  const std::size_t at_90_deg = 540;
  for (std::size_t beam = at_90_deg - 2; beam < at_90_deg + 2; ++beam) {
    scan.ranges[beam] = kInvalidRange;  // 2 degrees
  }
  EXPECT_EQ(FindOpenings(scan, {}).size(), side);
  for (std::size_t beam = at_90_deg - 5; beam < at_90_deg + 5; ++beam) {
    scan.ranges[beam] = kInvalidRange;
  }
  EXPECT_EQ(FindOpenings(scan, {}).size(), side + 1);
}

TEST(FindOpenings, NothingToSee) {
  LaserScan scan = Look({}, {}, FullCircle());
  EXPECT_TRUE(FindOpenings(scan, {}).empty()) << "free all round";
  std::fill(scan.ranges.begin(), scan.ranges.end(), kInvalidRange);
  EXPECT_TRUE(FindOpenings(scan, {}).empty()) << "all invalid";
  EXPECT_TRUE(FindOpenings(LaserScan{}, {}).empty()) << "no beam";
  scan = Look({}, {}, HalfCircle());
  EXPECT_LE(FindOpenings(scan, {}).size(), 1U) << "free ahead";
  for (const float range : {kNoReturn, kInvalidRange, 3.0F, 7.0F}) {
    scan.ranges = {range};
    EXPECT_TRUE(FindOpenings(scan, {}).empty()) << "one beam of " << range;
    scan.ranges = {range, range};
    EXPECT_TRUE(FindOpenings(scan, {}).empty()) << "two beams of " << range;
  }
}

// (b) by trying every pair of end-points.
double LeastCost(const LaserScan& scan, double centre_angle, const OpeningOptions& options) {
  const Eigen::Vector2d line(std::cos(centre_angle), std::sin(centre_angle));
  const Eigen::Vector2d across(-line.y(), line.x());
  double least = std::numeric_limits<double>::infinity();
  const auto is_candidate = [&](const Eigen::Vector2d& p, double sign) {
    return line.dot(p) >= 0.0 && line.dot(p) <= options.max_depth_m && sign * across.dot(p) > 0.0;
  };
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (std::size_t j = 0; j < scan.size(); ++j) {
      if (!scan.IsHit(i) || !scan.IsHit(j)) continue;
      const Eigen::Vector2d p =
          scan.ranges[i] * Eigen::Vector2d(std::cos(scan.Angle(i)), std::sin(scan.Angle(i)));
      const Eigen::Vector2d q =
          scan.ranges[j] * Eigen::Vector2d(std::cos(scan.Angle(j)), std::sin(scan.Angle(j)));
      if (!is_candidate(p, 1.0) || !is_candidate(q, -1.0)) continue;
      least = std::min(least, (p - q).norm() + std::sqrt(std::abs(across.dot(p))) +
                                  std::sqrt(std::abs(across.dot(q))));
    }
  }
  return least;
}

TEST(FindOpenings, RefinementFindsTheLeastCostOfAllPairs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  OpeningOptions options;
  options.min_width_m = 0.0;
  options.min_angle_deg = 0.0;
  for (int round = 0; round < 200; ++round) {
    LaserScan scan;
    scan.max_range = 30.0F;
    scan.angle_step = DegToRad(3.0);
    scan.first_angle = DegToRad(-90.0);
    scan.ranges.resize(61);
    for (float& range : scan.ranges) range = static_cast<float>(0.5 + 4.4 * uniform(random));
    // One run, so that its centre line is known.
    const auto first = static_cast<std::size_t>(5 + 20 * uniform(random));
    const auto last = first + static_cast<std::size_t>(2 + 25 * uniform(random));
    for (std::size_t i = first; i <= last; ++i)
      scan.ranges[i] = uniform(random) < 0.3 ? kNoReturn : 8.0F;
    const double centre_angle = 0.5 * (scan.Angle(first) + scan.Angle(last));
    const auto openings = FindOpenings(scan, options);
    ASSERT_EQ(openings.size(), 1U);
    const Eigen::Vector2d across(-std::sin(centre_angle), std::cos(centre_angle));
    const double cost = openings[0].width +
                        std::sqrt(std::abs(across.dot(openings[0].left_in_robot))) +
                        std::sqrt(std::abs(across.dot(openings[0].right_in_robot)));
    EXPECT_NEAR(cost, LeastCost(scan, centre_angle, options), 1e-9) << "round " << round;
  }
}

}  // namespace
}  // namespace masked_mapper
