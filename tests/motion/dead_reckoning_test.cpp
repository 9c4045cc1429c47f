// SPDX-License-Identifier: BSD-3-Clause
#include "motion/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <random>

namespace masked_mapper {
namespace {

OdometryReading Reading(double stamp, Pose2 pose) { return {stamp, pose}; }

TEST(DeadReckoning, PathStartsAtTheIdentityWhateverTheOdometryFrame) {
  DeadReckoning motion({});
  EXPECT_FALSE(motion.HasStarted());
  const Pose2 start{5.0, -3.0, 2.0};
  motion.Observe(Reading(0.0, start));
  EXPECT_EQ(Distance(motion.T_odom_robot(), Pose2{}), 0.0);
  const Pose2 step{1.0, 0.2, 0.3};
  motion.Observe(Reading(1.0, start * step));
  EXPECT_NEAR(Distance(motion.T_odom_robot(), step), 0.0, 1e-12);
  EXPECT_NEAR(motion.T_odom_robot().theta, step.theta, 1e-12);
}

TEST(DeadReckoning, MotionSinceNodeComposesToThePath) {
  DeadReckoning motion({});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  Pose2 pose;
  motion.Observe(Reading(0.0, pose));
  for (int i = 1; i <= 40; ++i) {
    pose = pose * Pose2{uniform(random), uniform(random), uniform(random)};
    motion.Observe(Reading(0.1 * i, pose));
    if (i == 15) motion.StartNode();
    if (i == 15) {
      EXPECT_EQ(motion.T_node_robot().covariance.norm(), 0.0);
    }
  }
  EXPECT_NEAR(Distance(motion.T_odom_robot(), pose), 0.0, 1e-12);
}

TEST(DeadReckoning, StandingStillCostsNothing) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> far(-900.0, 900.0);
  for (int place = 0; place < 20; ++place) {
    DeadReckoning motion({});
    const Pose2 pose{far(random), far(random), WrapAngle(far(random))};
    for (int i = 0; i < 100; ++i) motion.Observe(Reading(i, pose));
    EXPECT_EQ(motion.T_node_robot().covariance.norm(), 0.0);
    EXPECT_EQ(motion.T_odom_robot().AsVector(), Pose2{}.AsVector());
  }
}

TEST(DeadReckoning, UncertaintyGrowsWithTheSquareRootOfTheWay) {
  // A random walk: four times the way, twice the sigma, and the steps' length does not matter.
  const auto heading_variance = [](double way_m, int steps) {
    DeadReckoning motion({});
    for (int i = 0; i <= steps; ++i) {
      motion.Observe(Reading(0.0, Pose2{way_m * i / steps, 0.0, 0.0}));
    }
    return motion.T_node_robot().covariance(2, 2);
  };
  EXPECT_NEAR(heading_variance(8.0, 80) / heading_variance(2.0, 20), 4.0, 1e-9);
  EXPECT_NEAR(heading_variance(2.0, 20), heading_variance(2.0, 200), 1e-12);
}

TEST(DeadReckoning, CovarianceAgreesWithSampledPaths) {
  // Steps disturbed by the stated noise end where the stated covariance says.
  DeadReckoningOptions options;
  options.sigma_heading_deg_per_sqrt_m = 1.0;
  const Pose2 step{0.2, 0.0, 0.03};
  const int steps = 30;
  DeadReckoning motion(options);
  Pose2 pose;
  motion.Observe(Reading(0.0, pose));
  const UncertainPose2 noise = OdometryStep(Reading(0.0, {}), Reading(0.1, step), options);
  for (int i = 1; i <= steps; ++i) motion.Observe(Reading(0.1 * i, pose = pose * step));

  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  const int samples = 20000;
  for (int sample = 0; sample < samples; ++sample) {
    Pose2 end;
    for (int i = 0; i < steps; ++i) {
      end = end * Pose2{step.x + std::sqrt(noise.covariance(0, 0)) * normal(random),
                        step.y + std::sqrt(noise.covariance(1, 1)) * normal(random),
                        step.theta + std::sqrt(noise.covariance(2, 2)) * normal(random)};
    }
    const Eigen::Vector3d error(end.x - pose.x, end.y - pose.y, WrapAngle(end.theta - pose.theta));
    sampled += error * error.transpose() / samples;
  }
  const Eigen::Matrix3d& stated = motion.T_node_robot().covariance;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(sampled(i, i) / stated(i, i), 1.0, 0.05);
}

}  // namespace
}  // namespace masked_mapper
