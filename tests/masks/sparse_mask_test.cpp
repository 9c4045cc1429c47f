// SPDX-License-Identifier: BSD-3-Clause
#include "masks/sparse_mask.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>

#include "hand_drawn.hpp"
#include "masks/never_always_masks.hpp"

namespace masked_mapper {
namespace {

std::vector<std::unique_ptr<Mask>> Always() {
  std::vector<std::unique_ptr<Mask>> part;
  part.push_back(std::make_unique<AlwaysMask>());
  return part;
}

SparseMaskOptions Plain() {
  SparseMaskOptions options;
  options.place_m = 4.0;
  options.pass_m = 15.0;
  options.turn_deg = 90.0;
  options.drift_share = 0.01;
  return options;
}

SparseMask MaskOf(const SparseMaskOptions& options) { return SparseMask(Always(), options); }

std::vector<Pose2> Straight(const Pose2& from, double length, double step) {
  std::vector<Pose2> poses;
  for (double x = 0.0; x <= length; x += step) poses.push_back(from * Pose2{x, 0.0, 0.0});
  return poses;
}

/// Scan nodes of Algorithm 1 along a drive: where the mask fires, `edge` apart.
std::vector<Pose2> Nodes(SparseMask& mask, const std::vector<Pose2>& drive, const Scanner& scanner,
                         double edge = 1.45) {
  const LaserScan scan = Look({}, {}, scanner);
  std::vector<Pose2> nodes;
  for (const Pose2& pose : drive) {
    mask.Observe({scan, pose});
    if (!mask.Fires() || (!nodes.empty() && Distance(nodes.back(), pose) <= edge)) continue;
    nodes.push_back(pose);
    mask.OnNode();
  }
  return nodes;
}

TEST(SparseMask, SpacesNodesOnNewGround) {
  SparseMask mask = MaskOf(Plain());
  const std::vector<Pose2> nodes = Nodes(mask, Straight({}, 100.0, 0.1), HalfCircle());
  ASSERT_EQ(nodes.size(), 25U);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    EXPECT_NEAR(Distance(nodes[i - 1], nodes[i]), 4.0, 0.11) << i;
  }
}

TEST(SparseMask, NeverFiresWhereItsPartDoesNot) {
  std::vector<std::unique_ptr<Mask>> part;
  part.push_back(std::make_unique<NeverMask>());
  SparseMask mask(std::move(part), {});
  EXPECT_FALSE(mask.Fires());
  EXPECT_TRUE(Nodes(mask, Straight({}, 20.0, 0.5), HalfCircle()).empty());
}

TEST(SparseMask, FollowsItsPartWhereTheRobotDroveBefore) {
  SparseMask mask = MaskOf(Plain());
  Nodes(mask, Straight({}, 50.0, 0.1), HalfCircle());
  // Once more the same way, a metre to the side.
  const std::vector<Pose2> again = Nodes(mask, Straight({10.0, 1.0, 0.0}, 29.9, 0.1), HalfCircle());
  EXPECT_EQ(again.size(), 20U);  // every 1.5 m
}

TEST(SparseMask, TheWayBackIsNewToAScannerThatDoesNotSeeBehind) {
  const Pose2 back{50.0, 1.0, kPi};
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    SparseMask mask = MaskOf(Plain());
    Nodes(mask, Straight({}, 50.0, 0.1), scanner);
    // Past the reach of this pass; what follows is judged alone.
    Nodes(mask, Straight(back, 20.0, 0.1), scanner);
    const std::vector<Pose2> nodes =
        Nodes(mask, Straight(back * Pose2{20.0, 0.0, 0.0}, 23.9, 0.1), scanner);
    EXPECT_EQ(nodes.size(), scanner.span_deg < 360.0 ? 6U : 16U) << scanner.span_deg;
  }
}

TEST(SparseMask, OdometryThatDriftedStillKnowsThePlace) {
  // 200 m out of the way bring odometry 5 m off, more than a place is wide; 1 % of the path is 2 m.
  for (const double off : {5.0, 7.0}) {
    SparseMask mask = MaskOf(Plain());
    Nodes(mask, Straight({}, 20.0, 0.1), FullCircle());
    Nodes(mask, Straight({20.0, 0.0, kPi / 2}, 90.0, 0.1), FullCircle());
    Nodes(mask, Straight({20.0, 90.0, -kPi / 2}, 70.0, 0.1), FullCircle());
    const LaserScan scan = Look({}, {}, FullCircle());
    mask.Observe({scan, {0.0, off, 0.0}});
    mask.OnNode();
    mask.Observe({scan, {0.5, off, 0.0}});
    EXPECT_EQ(mask.Fires(), off < 6.0) << off;
  }
}

TEST(SparseMask, RestartForgetsEverything) {
  SparseMask mask = MaskOf(Plain());
  const std::vector<Pose2> drive = Straight({}, 50.0, 0.1);
  const std::size_t first = Nodes(mask, drive, HalfCircle()).size();
  mask.Restart();
  EXPECT_EQ(Nodes(mask, drive, HalfCircle()).size(), first);
}

TEST(SparseMask, APlaceWithoutWidthChangesNothing) {
  SparseMaskOptions options = Plain();
  options.place_m = 0.0;
  SparseMask mask = MaskOf(options);
  const std::vector<Pose2> nodes = Nodes(mask, Straight({}, 20.0, 0.1), HalfCircle(), 0.0);
  EXPECT_EQ(nodes.size(), Straight({}, 20.0, 0.1).size());
}

// Every view that was ever seen is looked at, and no step along the path is trusted.
class ObviousMask {
 public:
  explicit ObviousMask(const SparseMaskOptions& options) : options_(options) {}

  void Observe(const Pose2& pose, bool sees_all_around) {
    if (!poses_.empty()) path_.push_back(path_.back() + Distance(poses_.back(), pose));
    if (poses_.empty()) path_.push_back(0.0);
    poses_.push_back(pose);
    bool apart = true;
    bool revisit = false;
    for (std::size_t i = 0; i + 1 < poses_.size(); ++i) {
      const double since = path_.back() - path_[i];
      const bool same = sees_all_around || std::abs(WrapAngle(poses_[i].theta - pose.theta)) <=
                                               DegToRad(options_.turn_deg);
      const double distance = Distance(poses_[i], pose);
      const bool is_node = !is_node_.empty() && i < is_node_.size() && is_node_[i];
      if (since < options_.pass_m && is_node && same && distance < options_.place_m) apart = false;
      // The mask remembers a view every half metre.
      if (since >= options_.pass_m && is_kept_[i] && same &&
          distance <= options_.place_m + options_.drift_share * since) {
        revisit = true;
      }
    }
    fires_ = apart || revisit;
    is_kept_.push_back(path_.back() - last_kept_ >= 0.5);
    if (is_kept_.back()) last_kept_ = path_.back();
    is_node_.push_back(false);
  }
  void OnNode() { is_node_.back() = true; }
  bool Fires() const { return fires_; }

 private:
  SparseMaskOptions options_;
  std::vector<Pose2> poses_;
  std::vector<double> path_;
  std::vector<bool> is_node_;
  std::vector<bool> is_kept_;
  double last_kept_ = -1.0;
  bool fires_ = false;
};

TEST(SparseMask, AnswersAsOneThatLooksAtEveryView) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> step(0.0, 0.9);
  std::normal_distribution<double> turn(0.0, 0.25);
  int fired = 0;
  int held = 0;
  for (const Scanner& scanner : {HalfCircle(), FullCircle()}) {
    const LaserScan scan = Look({}, {}, scanner);
    for (int drive = 0; drive < 4; ++drive) {
      SparseMask mask = MaskOf(Plain());
      ObviousMask plain(Plain());
      Pose2 pose;
      double since_node = 0.0;
      for (int i = 0; i < 1500; ++i) {
        const double length = step(random);
        pose = pose * Pose2{length, 0.0, turn(random)};
        since_node += length;
        mask.Observe({scan, pose});
        plain.Observe(pose, scan.IsFullCircle());
        ASSERT_EQ(mask.Fires(), plain.Fires()) << "drive " << drive << ", view " << i;
        (mask.Fires() ? fired : held) += 1;
        if (!mask.Fires() || since_node < 1.5) continue;
        mask.OnNode();
        plain.OnNode();
        since_node = 0.0;
      }
    }
  }
  EXPECT_GT(fired, 1000);
  EXPECT_GT(held, 1000);
}

}  // namespace
}  // namespace masked_mapper
