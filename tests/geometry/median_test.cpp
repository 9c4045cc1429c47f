// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/median.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(Median, IsTheMiddleOfTheSorted) {
  EXPECT_EQ(Median(std::vector<double>{3.0, -1.0, 2.0}), 2.0);
  EXPECT_EQ(Median(std::vector<float>{4.0F, 1.0F, 2.0F, 3.0F}), 3.0);
  EXPECT_EQ(Median(std::vector<double>{}), 0.0);
}

}  // namespace
}  // namespace masked_mapper
