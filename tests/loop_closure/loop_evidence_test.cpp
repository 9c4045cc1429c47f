// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace masked_mapper {
namespace {

UncertainPose2 Loop(const Pose2& off, double sigma_m, double sigma_rad) {
  const Eigen::Vector3d sigma(sigma_m, sigma_m, sigma_rad);
  return {off, sigma.cwiseAbs2().asDiagonal()};
}

// Matches as the model has them, drawn: of those that land in a small box, how many are right.
TEST(LoopEvidence, IsTheLogOfHowMuchLikelierARightMatchIs) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::chi_squared_distribution<double> tries(30.0);
  Eigen::Matrix3d covariance;
  covariance << 0.16, 0.05, 0.004, 0.05, 0.09, -0.002, 0.004, -0.002, 0.003;
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  const auto error = [&] {
    const Eigen::Vector3d drawn(normal(random), normal(random), normal(random));
    return Eigen::Vector3d(root * drawn * std::sqrt(30.0 / tries(random)));
  };
  const auto is_wrong = [](const Eigen::Vector3d& off) {
    return off.head<2>().norm() > 0.5 || std::abs(off.z()) > DegToRad(5.0);
  };
  constexpr double kSearched = 250.0;  // m^2, around the place
  const Eigen::Vector3d half_box(0.1, 0.1, 0.02);
  constexpr int kDraws = 2000000;
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(0.1, -0.1, 0.0), Eigen::Vector3d(1.2, -0.3, 0.02),
        Eigen::Vector3d(0.9, 0.5, -0.05)}) {
    const auto is_in_box = [&](const Eigen::Vector3d& match) {
      return ((match - at).cwiseAbs().array() < half_box.array()).all();
    };
    int right = 0;
    int slipped = 0;
    int away = 0;    // wrong ones land anywhere: `at` is wrong of so many
    int turned = 0;  // as `at` is
    for (int i = 0; i < kDraws; ++i) {
      const Eigen::Vector3d off = error();
      right += is_in_box(off) ? 1 : 0;
      const Eigen::Vector2d slip = 0.5 * unit(random) * at.head<2>().normalized();
      slipped += is_in_box(error() + Eigen::Vector3d(slip.x(), slip.y(), 0.0)) ? 1 : 0;
      away += is_wrong(at - off) ? 1 : 0;
      turned += std::abs(off.z() - at.z()) < half_box.z() ? 1 : 0;
    }
    const double in_box = 4.0 * half_box.x() * half_box.y() / kSearched;
    const double anyhow = half_box.z() / kPi;
    const double wrong = in_box * away * (0.9 * turned / kDraws + 0.1 * anyhow);
    const double expected = std::log(right / (wrong + 0.02 * slipped));
    const UncertainPose2 loop{{at.x(), at.y(), at.z()}, covariance};
    EXPECT_NEAR(LoopEvidence(loop), expected, 0.5) << at.transpose();
  }
}

TEST(LoopEvidence, TheChanceToBeWrongIsNeverToldTooSmall) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (const double sigma_m : {0.05, 0.15, 0.25, 0.6}) {
    for (const double off_m : {0.0, 0.2, 0.4}) {
      const UncertainPose2 loop = Loop({off_m, 0.0, DegToRad(1.0)}, sigma_m, DegToRad(2.0));
      constexpr int kDraws = 100000;
      int wrong = 0;
      for (int i = 0; i < kDraws; ++i) {
        const double x = off_m + sigma_m * normal(random);
        const double y = sigma_m * normal(random);
        const double theta = DegToRad(1.0 + 2.0 * normal(random));
        wrong += std::hypot(x, y) > 0.5 || std::abs(theta) > DegToRad(5.0) ? 1 : 0;
      }
      EXPECT_GE(ChanceToBeWrong(loop), static_cast<double>(wrong) / kDraws)
          << sigma_m << " m, off " << off_m << " m";
    }
  }
}

TEST(LoopEvidence, ASureWaySpeaksForARightMatchAndAgainstAWrongOne) {
  EXPECT_GT(LoopEvidence(Loop({0.03, 0.02, 0.002}, 0.04, 0.006)), kEnoughNats);
  EXPECT_LT(LoopEvidence(Loop({0.5, 0.0, 0.0}, 0.04, 0.006)), -kEnoughNats);
  EXPECT_LT(LoopEvidence(Loop({0.0, 0.0, DegToRad(5.0)}, 0.04, 0.006)), -kEnoughNats);
}

TEST(LoopEvidence, AMatchThatSlippedBesideASureWayIsRefused) {
  // Doors 0.36 m apart: not false by what counts as such, and wrong by 20 sigmas.
  EXPECT_LT(LoopEvidence(Loop({0.36, 0.07, 0.005}, 0.018, 0.003)), 0.0);
}

TEST(LoopEvidence, WhatAnythingWouldCloseIsNone) {
  EXPECT_LT(LoopEvidence(Loop({}, 20.0, 1.0)), 0.0);
  EXPECT_LT(LoopEvidence(Loop({}, 5.0, 0.3)), kEnoughNats);
}

TEST(LoopEvidence, StaysANumberWhereNothingIsUnsure) {
  const UncertainPose2 exact{{}, Eigen::Matrix3d::Zero()};
  EXPECT_TRUE(std::isfinite(LoopEvidence(exact)));
  EXPECT_GT(LoopEvidence(exact), kEnoughNats);
}

TEST(LoopEvidence, AWitnessIsWorthWhatItsPlaceIsApart) {
  EXPECT_EQ(MostEvidenceOfWitness(0.0), 0.0);
  EXPECT_NEAR(MostEvidenceOfWitness(4.0), std::log(2.0), 1e-12);
  EXPECT_NEAR(MostEvidenceOfWitness(8.0) + MostEvidenceOfWitness(100.0), kEnoughNats, 1e-9);
}

}  // namespace
}  // namespace masked_mapper
