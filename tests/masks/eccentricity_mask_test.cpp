// SPDX-License-Identifier: BSD-3-Clause
#include "masks/eccentricity_mask.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "masks/hand_drawn.hpp"

namespace masked_mapper {
namespace {

const Scene kCorridor = Corridor(-40.0, 40.0);
const Scene kHall{{{-8.0, -7.0}, {8.0, -7.0}, {8.0, 7.0}, {-8.0, 7.0}, {-8.0, -7.0}}};

PlaceShape ShapeOf(const Scene& scene, const Pose2& T_world_robot, const Scanner& scanner) {
  const auto shape = MeasurePlaceShape(Look(scene, T_world_robot, scanner), {});
  EXPECT_TRUE(shape.has_value());
  return shape.value_or(PlaceShape{});
}

bool FiresAt(EccentricityMask& mask, const Scene& scene, const Pose2& T_world_robot,
             const Scanner& scanner) {
  mask.Observe({Look(scene, T_world_robot, scanner), T_world_robot});
  return mask.Fires();
}

TEST(PlaceShape, AgreesWithSamplingOfTheSpaceSeen) {
  const Scene scene = Corridor(-40.0, 40.0, {{1.0, 3.0}});
  const Pose2 T_world_robot{1.2, -0.3, 0.4};
  const LaserScan scan = Look(scene, T_world_robot, FullCircle());
  const PlaceShape shape = ShapeOf(scene, T_world_robot, FullCircle());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-10.0, 10.0);
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sum_of_squares = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 400000; ++i) {
    const Eigen::Vector2d point(uniform(random), uniform(random));
    const double turn = std::atan2(point.y(), point.x()) - scan.first_angle;
    const auto beam = static_cast<std::size_t>(turn / scan.angle_step + 0.5) % scan.size();
    if (point.norm() > std::min(10.0, static_cast<double>(scan.ranges[beam]))) continue;
    count += 1.0;
    sum += point;
    sum_of_squares += point * point.transpose();
  }
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d c = sum_of_squares / count - mean * mean.transpose();
  const double trace = c.trace();
  const double root = std::sqrt(trace * trace - 4.0 * c.determinant());
  EXPECT_NEAR(shape.eccentricity, std::sqrt(1.0 - (trace - root) / (trace + root)), 0.01);
  EXPECT_NEAR(shape.drift, std::sqrt(mean.dot(c.inverse() * mean)), 0.02);
}

TEST(PlaceShape, RectangleAsInTheBook) {
  // 6 by 4 m: C = diag(36, 16) / 12, so e = sqrt(1 - 16/36).
  const Scene room{{{-3.0, -2.0}, {3.0, -2.0}, {3.0, 2.0}, {-3.0, 2.0}, {-3.0, -2.0}}};
  const PlaceShape centre = ShapeOf(room, {}, FullCircle());
  EXPECT_NEAR(centre.eccentricity, std::sqrt(1.0 - 16.0 / 36.0), 1e-3);
  EXPECT_NEAR(centre.drift, 0.0, 1e-3);
  const PlaceShape beside = ShapeOf(room, {1.5, 0.0, 0.3}, FullCircle());
  EXPECT_NEAR(beside.eccentricity, std::sqrt(1.0 - 16.0 / 36.0), 2e-3);
  EXPECT_NEAR(beside.drift, 1.5 / std::sqrt(3.0), 5e-3);
}

TEST(PlaceShape, CorridorIsLongAndHallIsNot) {
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    EXPECT_GT(ShapeOf(kCorridor, {}, scanner).eccentricity, 0.95);
    EXPECT_LT(ShapeOf(kHall, {}, scanner).eccentricity, 0.85);
  }
}

TEST(EccentricityMask, FiresAtPlacesThatAreNoCorridor) {
  const Scene crossing = Corridor(-40.0, 40.0, {{-1.0, 1.0}}, {{-1.0, 1.0}});
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    EccentricityMask mask({});
    EXPECT_FALSE(FiresAt(mask, kCorridor, {}, scanner));
    EXPECT_TRUE(FiresAt(mask, kHall, {-7.0, 0.0, 0.0}, scanner));
    EXPECT_FALSE(FiresAt(mask, kCorridor, {3.0, 0.2, 0.1}, scanner));
    EXPECT_TRUE(FiresAt(mask, crossing, {}, scanner));
  }
}

TEST(EccentricityMask, HysteresisKeepsTheAnswer) {
  EccentricityMaskOptions options;
  options.open_below = 0.6;
  options.corridor_above = 0.8;
  const auto room = [](double length) {
    const double x = length / 2.0;
    return Scene{{{-x, -1.0}, {x, -1.0}, {x, 1.0}, {-x, 1.0}, {-x, -1.0}}};
  };
  // e = sqrt(1 - (2 / length)^2): 2.1 m is 0.30, 2.8 m is 0.70, 6 m is 0.94.
  EccentricityMask mask(options);
  EXPECT_FALSE(FiresAt(mask, room(6.0), {}, FullCircle()));
  EXPECT_FALSE(FiresAt(mask, room(2.8), {}, FullCircle())) << "between: still a corridor";
  EXPECT_TRUE(FiresAt(mask, room(2.1), {}, FullCircle()));
  EXPECT_TRUE(FiresAt(mask, room(2.8), {}, FullCircle())) << "between: still open";
  EXPECT_FALSE(FiresAt(mask, room(6.0), {}, FullCircle()));
}

TEST(EccentricityMask, DeadEndByDriftNeedsSightBehind) {
  // 0.5 m from the wall that closes a corridor, facing the wall: all that is seen is behind.
  const Scene dead_end = Closed(kCorridor, 0.5);
  const PlaceShape shape = ShapeOf(dead_end, {}, FullCircle());
  EXPECT_GT(shape.eccentricity, 0.9);
  EXPECT_GT(shape.drift, 1.3);
  EccentricityMask mask({});
  EXPECT_TRUE(FiresAt(mask, dead_end, {}, FullCircle()));
  EXPECT_FALSE(FiresAt(mask, kCorridor, {}, FullCircle()));
  // A half circle stands at the edge of what it sees in every corridor.
  EXPECT_GT(ShapeOf(kCorridor, {}, HalfCircle()).drift, 1.3);
  EccentricityMask half({});
  EXPECT_FALSE(FiresAt(half, kCorridor, {}, HalfCircle()));
}

TEST(EccentricityMask, DeadEndOfAHalfCircleLosesEccentricity) {
  const Scene dead_end = Closed(kCorridor, 2.0);
  EccentricityMask mask({});
  EXPECT_TRUE(FiresAt(mask, dead_end, {}, HalfCircle()));
}

TEST(EccentricityMask, ScansWithoutAShapeChangeNothing) {
  LaserScan invalid = Look(kHall, {}, HalfCircle());
  std::fill(invalid.ranges.begin(), invalid.ranges.end(), kInvalidRange);
  LaserScan one_beam;
  one_beam.max_range = 30.0F;
  one_beam.ranges = {3.0F};
  EXPECT_FALSE(MeasurePlaceShape(invalid, {}).has_value());
  EXPECT_FALSE(MeasurePlaceShape(one_beam, {}).has_value());
  EXPECT_FALSE(MeasurePlaceShape(LaserScan{}, {}).has_value());

  EccentricityMask mask({});
  for (const bool fires : {false, true}) {
    ASSERT_EQ(FiresAt(mask, fires ? kHall : kCorridor, {}, FullCircle()), fires);
    for (const LaserScan& scan : {invalid, one_beam, LaserScan{}}) {
      mask.Observe({scan, {}});
      EXPECT_EQ(mask.Fires(), fires);
    }
  }
}

TEST(EccentricityMask, AllNoReturnIsOpenSpace) {
  EccentricityMask mask({});
  EXPECT_TRUE(FiresAt(mask, {}, {}, FullCircle()));
}

TEST(EccentricityMask, RestartForgets) {
  EccentricityMask mask({});
  ASSERT_TRUE(FiresAt(mask, kHall, {}, FullCircle()));
  mask.Restart();
  EXPECT_FALSE(mask.Fires());
}

}  // namespace
}  // namespace masked_mapper
