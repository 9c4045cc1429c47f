// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/heading_tie.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

TEST(HeadingTie, TellsTheTurnAndNoPlace) {
  const Edge tie = HeadingTie(3, 7, 2.0 * M_PI + 0.1, 0.001);
  EXPECT_TRUE(IsHeadingTie(tie));
  EXPECT_EQ(tie.from, 3);
  EXPECT_EQ(tie.to, 7);
  EXPECT_NEAR(tie.T_from_to.mean.theta, 0.1, 1e-12);
  EXPECT_NEAR(std::sqrt(tie.T_from_to.covariance(2, 2)), 0.001, 1e-12);
}

TEST(HeadingTie, IsNoWayHoweverUnsure) {
  Edge way{0, 1, {}};
  EXPECT_FALSE(IsHeadingTie(way));
  way.T_from_to.covariance = 1e6 * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(IsHeadingTie(way));
}

}  // namespace
}  // namespace masked_mapper
