// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/local_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

TEST(LocalMap, RecoversKnownPosesFromDisturbedGuesses) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(11);
  LocalMap map({}, {3.0, 3.0});
  for (int i = 0; i < 10; ++i) {
    const Pose2 pose{2.0 + 0.15 * i, 2.5, 0.03 * i};
    map.Add(*PointsInRobot(room.Scan(pose, 361, 270.0, &random)), pose);
  }
  std::uniform_real_distribution<double> shift(-0.12, 0.12);
  std::uniform_real_distribution<double> turn(-4.0, 4.0);
  double worst_m = 0.0;
  double worst_deg = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Pose2 truth{3.0 + shift(random), 2.7 + shift(random), 0.2 + DegToRad(turn(random))};
    const Pose2 guess{truth.x + shift(random), truth.y + shift(random),
                      truth.theta + DegToRad(turn(random))};
    const Alignment aligned = map.Align(*PointsInRobot(room.Scan(truth, 361, 270.0, &random)),
                                        guess, Eigen::Matrix3d::Zero());
    EXPECT_TRUE(aligned.converged);
    EXPECT_GT(aligned.inlier_share, 0.7);
    worst_m = std::max(worst_m, Distance(aligned.T_map_robot, truth));
    worst_deg =
        std::max(worst_deg, RadToDeg(std::abs(WrapAngle(aligned.T_map_robot.theta - truth.theta))));
  }
  EXPECT_LT(worst_m, 0.02) << "m";
  EXPECT_LT(worst_deg, 0.3) << "deg";
}

// Over many corridors what seems to be known of the way along one is noise, and told as such.
TEST(LocalMap, TellsWhatIsNoiseOfTheWayAlongABlankCorridor) {
  const BoxScene corridor = BlankCorridor();
  Eigen::Vector2d known = Eigen::Vector2d::Zero();
  Eigen::Vector2d noise = Eigen::Vector2d::Zero();
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    LocalMap map({}, {0.0, 0.0});
    for (int i = 0; i < 10; ++i) {
      const Pose2 pose{0.15 * i, 0.1, 0.02};
      map.Add(*PointsInRobot(corridor.Scan(pose, 361, 270.0, &random)), pose);
    }
    const ScanPoints::ConstPtr points =
        PointsInRobot(corridor.Scan({1.6, 0.15, 0.0}, 361, 270.0, &random));
    const Alignment aligned = map.Align(*points, {1.6, 0.15, 0.0}, Eigen::Matrix3d::Identity());
    known += aligned.information.diagonal().head<2>();
    noise += aligned.information_of_noise.diagonal();
  }
  EXPECT_NEAR(noise.x() / known.x(), 1.0, 0.4) << "along";
  EXPECT_LT(noise.y() / known.y(), 0.01) << "across";
}

TEST(LocalMap, BlankCorridorSaysNothingOfTheWayAlongIt) {
  const BoxScene corridor = BlankCorridor();
  std::mt19937 random(5);
  LocalMap map({}, {0.0, 0.0});
  for (int i = 0; i < 10; ++i) {
    const Pose2 pose{0.15 * i, 0.1, 0.02};
    map.Add(*PointsInRobot(corridor.Scan(pose, 361, 270.0, &random)), pose);
  }
  const Pose2 truth{1.6, 0.15, 0.0};
  const Pose2 guess{truth.x + 0.08, truth.y + 0.05, 0.03};
  // Wheels that are good to 5 cm and 5 degrees.
  const Eigen::Matrix3d prior =
      Eigen::Vector3d(1.0 / 0.0025, 1.0 / 0.0025, 1.0 / 0.0076).asDiagonal();
  const Alignment aligned =
      map.Align(*PointsInRobot(corridor.Scan(truth, 361, 270.0, &random)), guess, prior);
  EXPECT_NEAR(aligned.T_map_robot.y, truth.y, 0.01) << "m, across";
  EXPECT_NEAR(aligned.T_map_robot.theta, truth.theta, DegToRad(0.3)) << "rad";
  EXPECT_NEAR(aligned.T_map_robot.x, guess.x, 0.02) << "m: the wheels rule along the corridor";
  const Eigen::Matrix3d covariance = (aligned.information + prior).inverse();
  EXPECT_GT(std::sqrt(covariance(0, 0)), 8.0 * std::sqrt(covariance(1, 1)));
}

TEST(LocalMap, CovarianceIsHonest) {
  // Errors of many noisy alignments against one map, in sigmas: neither boasting nor useless.
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(23);
  LocalMap map({}, {3.0, 3.0});
  for (int i = 0; i < 10; ++i) {
    const Pose2 pose{2.0 + 0.15 * i, 2.5, 0.03 * i};
    map.Add(*PointsInRobot(room.Scan(pose, 361, 270.0, &random)), pose);
  }
  double chi2 = 0.0;
  const int trials = 200;
  for (int i = 0; i < trials; ++i) {
    const Pose2 truth{2.5 + 0.005 * i, 2.6, 0.1};
    const Alignment aligned = map.Align(*PointsInRobot(room.Scan(truth, 361, 270.0, &random)),
                                        truth, Eigen::Matrix3d::Zero());
    const Eigen::Vector3d error(aligned.T_map_robot.x - truth.x, aligned.T_map_robot.y - truth.y,
                                WrapAngle(aligned.T_map_robot.theta - truth.theta));
    chi2 += error.dot(aligned.information * error) / trials;
  }
  EXPECT_LT(chi2, 3.0 * 1.5);
  EXPECT_GT(chi2, 3.0 * 0.02);
}

TEST(LocalMap, AHeldGuessKeepsItsSayAgainstThePoints) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(2);
  LocalMap map({}, {3.0, 3.0});
  const Pose2 truth{2.5, 2.6, 0.1};
  map.Add(*PointsInRobot(room.Scan(truth, 361, 270.0, &random)), truth);
  const Pose2 guess{2.55, 2.6, 0.1};
  const ScanPoints::ConstPtr points = PointsInRobot(room.Scan(truth, 361, 270.0, &random));
  const Eigen::Matrix3d firm = Eigen::Vector3d(1e9, 0.0, 0.0).asDiagonal();
  EXPECT_NEAR(map.AlignHeld(*points, guess, firm).T_map_robot.x, guess.x, 0.002) << "m";
  EXPECT_NEAR(map.Align(*points, guess, 1e-4 * firm).T_map_robot.x, truth.x, 0.01) << "m";
}

TEST(LocalMap, NothingInReachLeavesTheGuess) {
  const LocalMap empty({}, {0.0, 0.0});
  const Pose2 guess{1.0, 2.0, 0.5};
  const ScanPoints::ConstPtr points = PointsInRobot(FurnishedRoom().Scan({3, 3, 0}, 90, 180.0));
  const Alignment aligned = empty.Align(*points, guess, Eigen::Matrix3d::Zero());
  EXPECT_FALSE(aligned.converged);
  EXPECT_EQ(aligned.T_map_robot.x, guess.x);
  EXPECT_EQ(aligned.inlier_share, 0.0);
  EXPECT_EQ(empty.Align(ScanPoints(), guess, Eigen::Matrix3d::Zero()).inlier_share, 0.0);
}

TEST(LocalMap, FarAndMeaninglessPointsAreLeftOut) {
  LocalMap map({}, {0.0, 0.0});
  ScanPoints points;
  for (const float x : {1e30F, -1e30F, 50.0F, std::numeric_limits<float>::quiet_NaN()}) {
    pcl::PointXY point;
    point.x = x;
    point.y = 0.0F;
    points.push_back(point);
  }
  map.Add(points, {});
  EXPECT_EQ(map.Align(points, {}, Eigen::Matrix3d::Identity()).inlier_share, 0.0);
}

TEST(LocalMap, MeaninglessPointsDoNotDisturbTheOthers) {
  const BoxScene room = FurnishedRoom();
  const Pose2 truth{3.0, 2.7, 0.2};
  LocalMap map({}, {3.0, 3.0});
  map.Add(*PointsInRobot(room.Scan({2.9, 2.6, 0.1}, 361, 270.0)), {2.9, 2.6, 0.1});
  const ScanPoints::ConstPtr points = PointsInRobot(room.Scan(truth, 361, 270.0));
  ScanPoints more = *points;
  for (const float x : {1e30F, -1e30F, 5e5F, std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::quiet_NaN()}) {
    pcl::PointXY point;
    point.x = x;
    point.y = -x;
    more.push_back(point);
  }
  const Pose2 guess{3.05, 2.66, 0.22};
  const Alignment aligned = map.Align(*points, guess, Eigen::Matrix3d::Zero());
  const Alignment beside_them = map.Align(more, guess, Eigen::Matrix3d::Zero());
  EXPECT_LT(Distance(aligned.T_map_robot, beside_them.T_map_robot), 1e-3) << "m";
  EXPECT_LT(Distance(aligned.T_map_robot, truth), 0.02) << "m";
}

TEST(LocalMap, IsNotSeenFromTheEndOfTheWorld) {
  LocalMap map({}, {3.0, 3.0});
  const ScanPoints::ConstPtr points = PointsInRobot(FurnishedRoom().Scan({3, 3, 0}, 90, 180.0));
  map.Add(*points, {3, 3, 0});
  for (const double x : {1e4, 1e7, 1e30, -1e300}) {
    const Alignment aligned = map.Align(*points, {x, 0.0, 0.0}, Eigen::Matrix3d::Zero());
    EXPECT_EQ(aligned.inlier_share, 0.0) << x;
    EXPECT_EQ(aligned.T_map_robot.x, x);
  }
}

TEST(LocalMap, TheTwoFacesOfAThinWallDoNotPullAtEachOther) {
  // Two rooms with a wall of 12 cm between them, thinner than a window of cells; one is well known,
  // of the other no more than a few scans. The rooms lie askew to the cells.
  BoxScene rooms;
  rooms.AddBox(0.0, 0.0, 10.0, 2.0);
  rooms.AddBox(0.0, 2.12, 10.0, 5.0);
  std::mt19937 random(31);
  const Pose2 T_map_rooms{0.3, 0.7, DegToRad(33.0)};
  LocalMap map({}, {3.0, 3.0});
  const auto add = [&](const Pose2& pose) {
    map.Add(*PointsInRobot(rooms.Scan(pose, 361, 270.0, &random)), T_map_rooms * pose);
  };
  for (int i = 0; i < 30; ++i) add({2.0 + 0.2 * i, 1.0, 0.0});
  for (int i = 0; i < 4; ++i) add({4.0 + 0.15 * i, 3.3, DegToRad(90.0)});
  double error_m = 0.0;
  double error_deg = 0.0;
  constexpr int kScans = 20;
  for (int i = 0; i < kScans; ++i) {
    const Pose2 truth{4.0 + 0.03 * i, 3.2, DegToRad(180.0 - 3.0 * i)};
    const Pose2 guess = T_map_rooms * Pose2{truth.x + 0.03, truth.y - 0.05, truth.theta + 0.02};
    const Alignment aligned = map.Align(*PointsInRobot(rooms.Scan(truth, 361, 270.0, &random)),
                                        guess, Eigen::Matrix3d::Zero());
    const Pose2 left = Between(T_map_rooms * truth, aligned.T_map_robot);
    error_m += std::hypot(left.x, left.y) / kScans;
    error_deg += RadToDeg(std::abs(left.theta)) / kScans;
  }
  EXPECT_LT(error_m, 0.005) << "m";
  EXPECT_LT(error_deg, 0.08) << "deg";
}

TEST(LocalMap, IsTheSameHoweverOftenItIsLookedAt) {
  const BoxScene room = FurnishedRoom();
  std::mt19937 random(5);
  LocalMap looked_at({}, {3.0, 3.0});
  LocalMap left_alone({}, {3.0, 3.0});
  const FacedPoints points(*PointsInRobot(room.Scan({2.9, 2.6, 0.2}, 361, 270.0, &random)));
  const Pose2 guess{2.95, 2.63, 0.22};
  for (int i = 0; i < 12; ++i) {
    const Pose2 pose{2.0 + 0.15 * i, 2.5, 0.1 * i};
    const FacedPoints added(*PointsInRobot(room.Scan(pose, 361, 270.0, &random)));
    looked_at.Add(added, pose);
    looked_at.Align(points, guess, Eigen::Matrix3d::Zero());
    left_alone.Add(added, pose);
  }
  const Alignment a = looked_at.Align(points, guess, Eigen::Matrix3d::Zero());
  const Alignment b = left_alone.Align(points, guess, Eigen::Matrix3d::Zero());
  EXPECT_EQ(a.T_map_robot.AsVector(), b.T_map_robot.AsVector());
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.inlier_share, b.inlier_share);
}

}  // namespace
}  // namespace masked_mapper
