// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/random_generator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

TEST(RandomGenerator, GivesThePublishedSequence) {
  // SplitMix64 from state 0, as its authors' reference gives it.
  RandomGenerator random(0);
  EXPECT_EQ(random.Next(), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(random.Next(), 0x6e789e6aa1b965f4ULL);
  EXPECT_EQ(random.Next(), 0x06c45d188009454fULL);
}

TEST(RandomGenerator, NormalHasItsMoments) {
  RandomGenerator random(3);
  constexpr int kCount = 200'000;
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.Normal();
    sum += value;
    squares += value * value;
    if (std::abs(value) > 2.0) ++beyond_two;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.01);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, 0.0455, 0.003);
}

TEST(RandomGenerator, StreamsOfOneSeedDiffer) {
  RandomGenerator lidar(1, "lidar");
  RandomGenerator odometry(1, "odometry");
  RandomGenerator again(1, "lidar");
  const std::uint64_t first = lidar.Next();
  EXPECT_NE(first, odometry.Next());
  EXPECT_EQ(first, again.Next());
}

TEST(RandomGenerator, UniformStaysInside) {
  RandomGenerator random(9);
  for (int i = 0; i < 10'000; ++i) {
    const double value = random.Uniform(-2.0, 3.0);
    EXPECT_GE(value, -2.0);
    EXPECT_LT(value, 3.0);
    EXPECT_LT(random.Below(7), 7U);
  }
}

}  // namespace
}  // namespace masked_mapper
