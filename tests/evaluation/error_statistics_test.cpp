// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/error_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace masked_mapper {
namespace {

TEST(ErrorStatistics, OfFourErrors) {
  const ErrorStatistics s = StatisticsOf({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.median, 3.0) << "the upper of two middle values";
  EXPECT_DOUBLE_EQ(s.p99, 4.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
}

TEST(ErrorStatistics, OfOneErrorAllAreThatOne) {
  const ErrorStatistics s = StatisticsOf({0.7});
  EXPECT_EQ(s.mean, 0.7);
  EXPECT_EQ(s.std, 0.0);
  EXPECT_EQ(s.median, 0.7);
  EXPECT_EQ(s.p99, 0.7);
}

}  // namespace
}  // namespace masked_mapper
