// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/space_lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"
#include "simulation/building_file.hpp"
#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

/// A hall of 10 m by 6 m about the origin.
Building Hall() {
  Building building;
  FloorPlan floor;
  floor.label = "0";
  const std::vector<Eigen::Vector2d> corners = {{-5.0, -3.0}, {5.0, -3.0}, {5.0, 3.0}, {-5.0, 3.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    floor.segments.push_back({corners[i], corners[(i + 1) % 4], Surface::kWall});
  }
  floor.way_points = {{"a", {-4.0, 0.0}}, {"b", {4.0, 0.0}}};
  floor.passages = {{0, 1, true}};
  building.floors = {floor};
  return building;
}

RobotState Standing(double /*time*/) { return {}; }

/// m, to the nearest of floor, ceiling and walls of the hall.
double OffSurfaces(const Eigen::Vector3d& point) {
  return std::min({std::abs(point.z()), std::abs(point.z() - 2.7),
                   std::abs(std::abs(point.x()) - 5.0), std::abs(std::abs(point.y()) - 3.0)});
}

class EveryModelTest : public ::testing::TestWithParam<SpaceLidarModel> {};

TEST_P(EveryModelTest, ReturnsLieOnSurfacesAndInTheSweep) {
  const Building hall = Hall();
  SpaceLidar lidar(hall, OptionsOf(GetParam()), LidarNoise::None(), 1);
  const CloudReading cloud = lidar.Sweep(1.0, Standing);
  EXPECT_GT(cloud.points.size(), 15000U);
  double lowest = 90.0;
  double highest = -90.0;
  for (const CloudPoint& point : cloud.points) {
    const Eigen::Vector3d in_robot = cloud.T_robot_lidar * point.position.cast<double>();
    ASSERT_LT(OffSurfaces(in_robot), 1e-3);
    ASSERT_LE(std::abs(point.time), 0.1 + 1e-6);
    const double up = RadToDeg(std::asin(point.position.normalized().z()));
    lowest = std::min(lowest, up);
    highest = std::max(highest, up);
  }
  const bool is_mid360 = GetParam() == SpaceLidarModel::kMid360;
  const double expected = GetParam() == SpaceLidarModel::kVlp16 ? 15.0 : 22.5;
  EXPECT_NEAR(lowest, is_mid360 ? -7.0 : -expected, 0.1);
  EXPECT_NEAR(highest, is_mid360 ? 52.0 : expected, 0.1);
}

TEST_P(EveryModelTest, NoiseIsThatOfTheLidarAndSeedsRepeat) {
  const Building hall = Hall();
  LidarNoise noise;
  noise.people.per_kilometre = 0.0;
  const SpaceLidarOptions options = OptionsOf(GetParam());
  SpaceLidar one(hall, options, noise, 3);
  SpaceLidar other(hall, options, noise, 3);
  const CloudReading cloud = one.Sweep(1.0, Standing);
  const CloudReading again = other.Sweep(1.0, Standing);
  ASSERT_EQ(cloud.points.size(), again.points.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    ASSERT_EQ(cloud.points[i].position, again.points[i].position);
    const Eigen::Vector3d in_robot = cloud.T_robot_lidar * cloud.points[i].position.cast<double>();
    sum += OffSurfaces(in_robot);
  }
  EXPECT_LT(sum / static_cast<double>(cloud.points.size()), options.sigma);
  EXPECT_GT(sum, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModelTest,
                         ::testing::Values(SpaceLidarModel::kVlp16, SpaceLidarModel::kOs132,
                                           SpaceLidarModel::kMid360));

TEST(SpaceLidarTest, ATurningRobotBendsTheSweepByItsTimes) {
  const Building hall = Hall();
  SpaceLidar lidar(hall, OptionsOf(SpaceLidarModel::kVlp16), LidarNoise::None(), 1);
  const auto state_at = [](double t) {
    RobotState state;
    state.T_building_robot = {0.5 * t, 0.0, 1.0 * t};
    return state;
  };
  const CloudReading cloud = lidar.Sweep(1.0, state_at);
  for (const CloudPoint& point : cloud.points) {
    const Pose2 then = state_at(1.0 + point.time).T_building_robot;
    const Eigen::Vector3d in_robot = cloud.T_robot_lidar * point.position.cast<double>();
    const Eigen::Vector2d on_ground = then * Eigen::Vector2d(in_robot.head<2>());
    ASSERT_LT(OffSurfaces({on_ground.x(), on_ground.y(), in_robot.z()}), 1e-3);
  }
}

TEST(SpaceLidarTest, SeesTableTopsFromBelowAndPassesUnderThem) {
  Building hall = Hall();
  // Ahead of the robot, above its lidar.
  hall.floors[0].overhead.push_back({{3.0, 0.0, 0.0}, 1.0, 1.6, 0.75, 0.8});
  SpaceLidarOptions options = OptionsOf(SpaceLidarModel::kMid360);
  SpaceLidar lidar(hall, options, LidarNoise::None(), 1);
  const CloudReading cloud = lidar.Sweep(1.0, Standing);
  std::size_t below = 0;
  std::size_t edge = 0;
  std::size_t beyond = 0;
  for (const CloudPoint& point : cloud.points) {
    const Eigen::Vector3d p = cloud.T_robot_lidar * point.position.cast<double>();
    const bool under = p.x() > 2.5 && p.x() < 3.5 && std::abs(p.y()) < 0.8;
    below += under && std::abs(p.z() - 0.75) < 1e-3 ? 1 : 0;
    edge += std::abs(p.x() - 2.5) < 1e-3 && std::abs(p.y()) < 0.8 && p.z() < 0.801 ? 1 : 0;
    beyond += p.x() > 4.99 && std::abs(p.y()) < 1.0 && p.z() < 0.7 ? 1 : 0;
    // Nothing comes from within the block.
    EXPECT_FALSE(under && p.z() > 0.751 && p.z() < 0.799 && p.x() > 2.501);
  }
  EXPECT_GT(below, 10U);
  EXPECT_GT(edge, 10U);
  EXPECT_GT(beyond, 10U);
}

TEST(SpaceLidarTest, NamesAreThoseOfTheCommandLine) {
  for (const std::string& name : SpaceLidarNames()) EXPECT_TRUE(SpaceLidarCalled(name));
  EXPECT_EQ(SpaceLidarCalled("mid360"), SpaceLidarModel::kMid360);
  EXPECT_FALSE(SpaceLidarCalled("2d"));
}

}  // namespace
}  // namespace masked_mapper
