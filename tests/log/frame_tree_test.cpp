// SPDX-License-Identifier: BSD-3-Clause
#include "log/frame_tree.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

Eigen::Isometry3d Planar(double x, double y, double yaw) {
  Eigen::Isometry3d transform(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  transform.translation() = Eigen::Vector3d(x, y, 0.0);
  return transform;
}

TEST(FrameTreeTest, ComposesUpAndDown) {
  FrameTree tree;
  tree.Add("odom", "base", Planar(5, 6, 1.0));
  tree.Add("base", "mast", Planar(0.2, 0.0, 0.5));
  tree.Add("mast", "laser", Planar(0.1, 0.3, -0.2));
  tree.Add("base", "imu", Planar(-0.1, 0.0, 2.0));
  const Pose2 expected =
      Inverse(Pose2{-0.1, 0.0, 2.0}) * Pose2{0.2, 0.0, 0.5} * Pose2{0.1, 0.3, -0.2};
  const auto T_imu_laser = tree.Find("imu", "laser");
  ASSERT_TRUE(T_imu_laser);
  const Pose2 found = SeenFromAbove(*T_imu_laser).T_robot_laser;
  EXPECT_NEAR(found.x, expected.x, 1e-12);
  EXPECT_NEAR(found.y, expected.y, 1e-12);
  EXPECT_NEAR(found.theta, expected.theta, 1e-12);
  EXPECT_EQ(tree.Ancestors("laser"), (std::vector<std::string>{"laser", "mast", "base", "odom"}));
  EXPECT_FALSE(tree.Find("imu", "elsewhere"));
  EXPECT_TRUE(tree.Find("same", "same"));
}

TEST(FrameTreeTest, ARingOfFramesEnds) {
  FrameTree tree;
  tree.Add("a", "b", Planar(1, 0, 0));
  tree.Add("b", "a", Planar(1, 0, 0));
  EXPECT_LE(tree.Ancestors("a").size(), 100U);
  EXPECT_FALSE(tree.Find("c", "a"));
}

TEST(SeenFromAboveTest, AnUpsideDownScannerTurnsTheOtherWay) {
  const Eigen::Isometry3d mount(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const PlanarMount seen = SeenFromAbove(mount);
  EXPECT_TRUE(seen.upside_down);
  for (const double angle : {0.0, 0.3, -1.2}) {
    const Eigen::Vector3d direction =
        mount * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_NEAR(
        WrapAngle(std::atan2(direction.y(), direction.x()) - (seen.T_robot_laser.theta - angle)),
        0.0, 1e-12);
  }
}

TEST(SeenFromAboveTest, AnAngleOfAFewDigitsComesBackToTheLastBit) {
  for (int i = -314; i <= 314; ++i) {
    const double yaw = static_cast<double>(i) / 100.0;
    const Eigen::Isometry3d mount(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    EXPECT_EQ(SeenFromAbove(mount).T_robot_laser.theta, yaw);
  }
}

}  // namespace
}  // namespace masked_mapper
