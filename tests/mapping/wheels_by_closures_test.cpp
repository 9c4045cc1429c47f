// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/wheels_by_closures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

// Of a robot whose wheels are `truth` and pull to one side; every fourth goes round a corner. A
// share of the closures is wrong.
std::vector<WheelTie> TiesOf(const DeadReckoningOptions& truth, double travel_factor,
                             double pull_deg_per_m, double wrong_share, unsigned seed,
                             std::size_t count = 200) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<WheelTie> ties;
  for (std::size_t i = 0; i < count; ++i) {
    WheelTie tie;
    tie.travelled_m = tie.counted_m = 2.0 + 6.0 * uniform(random);
    tie.turned_rad = i % 4 == 0 ? 0.5 * kPi : 0.05;
    const double variance =
        std::pow(DegToRad(0.1), 2) +  // of a match
        std::pow(DegToRad(truth.sigma_heading_deg_per_sqrt_m), 2) * tie.travelled_m +
        std::pow(DegToRad(truth.sigma_heading_deg_per_sqrt_rad), 2) * tie.turned_rad;
    tie.turn_error_rad =
        std::sqrt(variance) * normal(random) + DegToRad(pull_deg_per_m) * tie.travelled_m;
    tie.matched_m = travel_factor * tie.counted_m +
                    truth.sigma_position_per_sqrt_m * std::sqrt(tie.counted_m) * normal(random);
    if (uniform(random) < wrong_share) {
      tie.turn_error_rad += DegToRad(10.0) * normal(random);
      tie.matched_m += 2.0 * normal(random);
    }
    ties.push_back(tie);
  }
  return ties;
}

DeadReckoningOptions Wheels(double deg_per_sqrt_m, double deg_per_sqrt_rad, double per_sqrt_m) {
  DeadReckoningOptions wheels;
  wheels.sigma_heading_deg_per_sqrt_m = deg_per_sqrt_m;
  wheels.sigma_heading_deg_per_sqrt_rad = deg_per_sqrt_rad;
  wheels.sigma_position_per_sqrt_m = per_sqrt_m;
  return wheels;
}

TEST(WheelsByClosures, FindsWheelsThatAreBetterThanFeared) {
  const DeadReckoningOptions truth = Wheels(0.2, 0.5, 0.012);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const double wrong_share : {0.0, 0.05}) {
      const std::string label = "seed " + std::to_string(seed);
      const auto learnt =
          WheelsByClosures(TiesOf(truth, 0.98, 0.0, wrong_share, seed), Wheels(2.0, 3.0, 0.05));
      ASSERT_TRUE(learnt) << label;
      // A little too large, to be on the safe side; never much too small.
      EXPECT_GT(learnt->noise.sigma_heading_deg_per_sqrt_m, 0.19) << label;
      EXPECT_LT(learnt->noise.sigma_heading_deg_per_sqrt_m, 0.35) << label;
      EXPECT_GT(learnt->noise.sigma_heading_deg_per_sqrt_rad, 0.45) << label;
      EXPECT_LT(learnt->noise.sigma_heading_deg_per_sqrt_rad, 1.6) << label;
      EXPECT_GT(learnt->noise.sigma_position_per_sqrt_m, 0.011) << label;
      EXPECT_LT(learnt->noise.sigma_position_per_sqrt_m, 0.020) << label;
      EXPECT_NEAR(learnt->travel_factor, 0.98, 0.003) << label;
    }
  }
}

// Over 100 m they turn the robot by 20 degrees, which a random walk has to allow for.
TEST(WheelsByClosures, TakesAPullToOneSideForWhatItComesTo) {
  const DeadReckoningOptions truth = Wheels(0.05, 0.5, 0.012);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto learnt =
        WheelsByClosures(TiesOf(truth, 1.0, 0.2, 0.0, seed), Wheels(4.0, 3.0, 0.05));
    ASSERT_TRUE(learnt) << "seed " << seed;
    EXPECT_NEAR(learnt->noise.sigma_heading_deg_per_sqrt_m, 2.0, 0.3) << "seed " << seed;
  }
}

TEST(WheelsByClosures, LeavesWheelsThatAreAsToldOrWorse) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const double worse : {1.0, 3.0}) {
      const DeadReckoningOptions truth = Wheels(2.0 * worse, 3.0 * worse, 0.05 * worse);
      EXPECT_FALSE(WheelsByClosures(TiesOf(truth, 1.0, 0.0, 0.0, seed), Wheels(2.0, 3.0, 0.05)))
          << "seed " << seed;
    }
  }
}

TEST(WheelsByClosures, FewTellNothing) {
  const DeadReckoningOptions perfect = Wheels(0.001, 0.001, 0.0001);
  EXPECT_FALSE(WheelsByClosures({}, Wheels(2.0, 3.0, 0.05)));
  EXPECT_FALSE(WheelsByClosures(TiesOf(perfect, 0.9, 0.0, 0.0, 1, 3), Wheels(2.0, 3.0, 0.05)));
}

TEST(WheelTies, AreClosuresAlongAShortWay) {
  constexpr double kTurnedPerStep = 0.01;  // rad, which the wheels add
  BuildingMap map;
  map.graph.AddFloor({"0"});
  Pose2 T_odom_robot;
  for (int i = 0; i < 5; ++i) {
    Node node;
    node.stamp = i;
    node.T_odom_robot = T_odom_robot;
    node.T_world_robot = {3.0 * i, 0.0, 0.0};
    TrajectoryPose pose;
    pose.stamp = i;
    pose.node_before = map.graph.AddNode(node);
    pose.T_odom_robot = T_odom_robot;
    map.trajectory.push_back(pose);
    T_odom_robot = T_odom_robot * Pose2{3.0, 0.0, kTurnedPerStep};
  }
  const auto close = [&](NodeId older, NodeId newer, double metres, ClosureState state) {
    Closure closure;
    closure.older = older;
    closure.newer = newer;
    closure.state = state;
    closure.T_older_newer.mean = {metres, 0.0, 0.0};
    map.closures.push_back(closure);
  };
  close(0, 1, 2.9, ClosureState::kValidated);
  close(1, 4, 8.8, ClosureState::kValidated);
  close(0, 4, 11.7, ClosureState::kValidated);  // too long a way
  close(1, 3, 5.8, ClosureState::kHypothesis);
  const std::vector<WheelTie> ties = WheelTies(map);
  ASSERT_EQ(ties.size(), 2U);
  EXPECT_NEAR(ties[0].counted_m, 3.0, 1e-9);
  EXPECT_NEAR(ties[0].matched_m, 2.9, 1e-9);
  EXPECT_NEAR(ties[0].turn_error_rad, kTurnedPerStep, 1e-9);
  EXPECT_NEAR(ties[1].counted_m, 9.0, 0.01);
  EXPECT_NEAR(ties[1].travelled_m, 9.0, 1e-9);
  EXPECT_NEAR(ties[1].matched_m, 8.8, 1e-9);
  EXPECT_NEAR(ties[1].turned_rad, 3.0 * kTurnedPerStep, 1e-9);
  EXPECT_NEAR(ties[1].turn_error_rad, 3.0 * kTurnedPerStep, 1e-9);
}

}  // namespace
}  // namespace masked_mapper
