// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/closure_matcher.hpp"

#include <gtest/gtest.h>

#include "mapping/ring_logs.hpp"
#include "masked_mapper/map/surroundings.hpp"

namespace masked_mapper {
namespace {

class ClosureMatcherTest : public testing::Test {
 protected:
  ClosureMatcherTest() : map_(MapOf(First(), "matcher.log")) {
    for (NodeId id = 0; static_cast<std::size_t>(id) < map_.graph.nodes().size(); ++id) {
      if (map_.graph.node(id).HasScan()) scan_nodes_.push_back(id);
    }
  }

  ClosureMatcher Matcher(bool refine = true) { return {{}, {}, {}, refine, map_}; }

  /// A node offered to itself, as if it were another, from `off` its place.
  ClosureOffer Offer(const Pose2& off, double sigma_m = 0.3) const {
    ClosureOffer offer;
    offer.older = offer.newer = scan_nodes_[1];
    offer.T_older_newer.mean = off;
    offer.T_older_newer.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 0.01;
    offer.points_in_older = PointsAt(map_, offer.older, 0.0);
    offer.points_in_newer = offer.points_in_older;
    offer.mahalanobis = 1.5;
    return offer;
  }

  BuildingMap map_;
  std::vector<NodeId> scan_nodes_;
};

TEST_F(ClosureMatcherTest, AMatchIsBroughtHome) {
  for (const bool refine : {false, true}) {
    const Closure closure =
        Matcher(refine).Match({Offer({0.3, -0.2, 0.05})}, GuessIs::kAWindow).front();
    EXPECT_EQ(closure.state, ClosureState::kHypothesis);
    EXPECT_EQ(closure.reason, ClosureReason::kTooFewVotes) << Name(closure.reason);
    EXPECT_LT(Distance(closure.T_older_newer.mean, Pose2()), 0.05) << "m";
    EXPECT_LT(std::abs(closure.T_older_newer.mean.theta), DegToRad(0.5));
    EXPECT_EQ(closure.mahalanobis, 1.5);
    EXPECT_EQ(closure.agreement > 0.0, refine);
  }
}

TEST_F(ClosureMatcherTest, WhatDoesNotMatchKeepsItsGuess) {
  ClosureOffer offer = Offer({0.1, 0.0, 0.0});
  ScanPoints::Ptr elsewhere(new ScanPoints);
  for (int i = 0; i < 50; ++i) elsewhere->push_back({0.5F * static_cast<float>(i), 20.0F});
  offer.points_in_newer = elsewhere;
  const Closure closure = Matcher().Match({offer}, GuessIs::kAWindow).front();
  EXPECT_EQ(closure.state, ClosureState::kRejectedScore);
  EXPECT_EQ(closure.reason, ClosureReason::kBelowMinScore);
  EXPECT_LT(Distance(closure.T_older_newer.mean, offer.T_older_newer.mean), 1e-9);
}

TEST_F(ClosureMatcherTest, AStraightWallIsAlikeAlongIt) {
  ClosureOffer offer = Offer({});
  ScanPoints::Ptr wall(new ScanPoints);
  for (int i = -60; i <= 60; ++i) wall->push_back({0.1F * static_cast<float>(i), 2.0F});
  offer.points_in_older = offer.points_in_newer = wall;
  const Closure closure = Matcher(false).Match({offer}, GuessIs::kAWindow).front();
  EXPECT_EQ(closure.reason, ClosureReason::kAlikeAlongALine);
  EXPECT_EQ(closure.state, ClosureState::kHypothesis);
}

TEST_F(ClosureMatcherTest, NoOfferNoClosure) {
  EXPECT_TRUE(Matcher().Match({}, GuessIs::kAWindow).empty());
}

}  // namespace
}  // namespace masked_mapper
