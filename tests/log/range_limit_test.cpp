// SPDX-License-Identifier: BSD-3-Clause
#include "log/range_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr double kStep = kPi / 180.0;

/// Ranges to the walls of a box of half sizes a, b round the origin, to the centimetre.
std::vector<float> BoxScan(const Pose2& T_box_robot, double a, double b, double sigma,
                           std::mt19937* random) {
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<float> ranges;
  for (int beam = 0; beam <= 180; ++beam) {
    const double angle = T_box_robot.theta - kPi / 2 + beam * kStep;
    const double c = std::cos(angle), s = std::sin(angle);
    const double to_a = c == 0.0 ? 1e9 : ((c > 0 ? a : -a) - T_box_robot.x) / c;
    const double to_b = s == 0.0 ? 1e9 : ((s > 0 ? b : -b) - T_box_robot.y) / s;
    const double range = std::min(to_a, to_b) + (sigma > 0.0 ? noise(*random) : 0.0);
    ranges.push_back(static_cast<float>(std::round(range * 100.0) / 100.0));
  }
  return ranges;
}

TEST(RangeLimitFinderTest, FindsEveryWordForNoReturn) {
  for (const float word : {5.6F, 25.0F, 50.0F, 51.1F, 80.0F, 81.91F, 99999.0F}) {
    std::mt19937 random(3);
    RangeLimitFinder finder;
    for (int i = 0; i < 300; ++i) {
      const Pose2 pose{-1.5 + 0.01 * i, 0.2, 0.01 * i};
      std::vector<float> ranges = BoxScan(pose, 2.0, 1.5, 0.01, &random);
      for (std::size_t beam = 0; beam < ranges.size(); ++beam) {
        if (random() % 10 == 0) ranges[beam] = word;
      }
      finder.Add(ranges, kStep, pose);
    }
    const auto finding = finder.Find();
    ASSERT_TRUE(finding) << word;
    EXPECT_EQ(finding->far_value, word);
    EXPECT_LT(finding->no_return, word);
    EXPECT_GT(finding->no_return, 0.99F * word);
    EXPECT_TRUE(finding->from_places);
  }
}

TEST(RangeLimitFinderTest, FindsTheWordFromOneScan) {
  std::mt19937 random(3);
  std::vector<float> ranges = BoxScan({}, 4.0, 2.0, 0.01, &random);
  for (std::size_t beam = 40; beam < 60; ++beam) ranges[beam] = 81.91F;
  RangeLimitFinder finder;
  finder.Add(ranges, kStep, {});
  ASSERT_TRUE(finder.Find());
  EXPECT_EQ(finder.Find()->far_value, 81.91F);
}

TEST(RangeLimitFinderTest, OneMistakeFartherOffHidesNothing) {
  std::mt19937 random(3);
  RangeLimitFinder finder;
  for (int i = 0; i < 300; ++i) {
    const Pose2 pose{-1.5 + 0.01 * i, 0.2, 0.0};
    std::vector<float> ranges = BoxScan(pose, 4.0, 2.0, 0.01, &random);
    for (std::size_t beam = 40; beam < 60; ++beam) ranges[beam] = 50.0F;
    if (i % 100 == 7) ranges[3] = 1e6F;
    finder.Add(ranges, kStep, pose);
  }
  ASSERT_TRUE(finder.Find());
  EXPECT_EQ(finder.Find()->far_value, 50.0F);
}

// A log without a beam that returned nothing must not lose its farthest walls.
TEST(RangeLimitFinderTest, TakesNoWallForNoReturn) {
  for (const double sigma : {0.0, 0.01}) {
    for (const bool moves : {false, true}) {
      for (const auto& [a, b] : std::vector<std::pair<double, double>>{
               {20.0, 1.0}, {10.0, 10.0}, {4.0, 3.0}, {30.0, 30.0}, {12.34, 2.0}}) {
        std::mt19937 random(5);
        RangeLimitFinder finder;
        for (int i = 0; i < 300; ++i) {
          const Pose2 pose{moves ? -0.4 * a + 0.8 * a * i / 300.0 : 0.0, 0.0, 0.0};
          finder.Add(BoxScan(pose, a, b, sigma, &random), kStep, pose);
        }
        EXPECT_FALSE(finder.Find())
            << a << " x " << b << " m, sigma " << sigma << (moves ? ", moving" : "");
      }
    }
  }
}

TEST(RangeLimitFinderTest, TellsWhetherAStatedLimitIsContradicted) {
  std::mt19937 random(5);
  RangeLimitFinder finder;
  for (int i = 0; i < 50; ++i) finder.Add(BoxScan({}, 20.0, 15.0, 0.01, &random), kStep, {});
  EXPECT_GT(finder.ShareBeyond(20.0), 0.01);
  EXPECT_EQ(finder.ShareBeyond(30.0), 0.0);
  EXPECT_NEAR(finder.Farthest(), 25.0, 0.1);
}

TEST(RangeLimitFinderTest, NothingIsFoundInNothing) {
  RangeLimitFinder finder;
  EXPECT_FALSE(finder.Find());
  finder.Add({}, kStep, {});
  finder.Add({std::nanf(""), -1.0F, 0.0F, std::numeric_limits<float>::infinity()}, kStep, {});
  EXPECT_FALSE(finder.Find());
  EXPECT_EQ(finder.ShareBeyond(1.0), 0.0);
}

}  // namespace
}  // namespace masked_mapper
