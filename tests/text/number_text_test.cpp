// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/number_text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

namespace masked_mapper {
namespace {

TEST(NumberText, FixedDecimals) {
  EXPECT_EQ(FixedText(1.5, 3), "1.500");
  EXPECT_EQ(FixedText(-2.0004, 3), "-2.000");
  EXPECT_EQ(FixedText(12.5, 0), "12");
  EXPECT_EQ(FixedText(1e22, 1), "10000000000000000000000.0");
}

TEST(NumberText, ZeroHasNoSign) {
  EXPECT_EQ(FixedText(-0.0, 2), "0.00");
  EXPECT_EQ(FixedText(-0.0004, 3), "0.000");
  EXPECT_EQ(ExactText(-0.0), "0");
}

TEST(NumberText, ExactReadsBack) {
  EXPECT_EQ(ExactText(1000000000.25), "1000000000.25");
  EXPECT_EQ(ExactText(1e9), "1000000000");
  EXPECT_EQ(ExactText(0.05), "0.05");
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> stamp(0.0, 2e9);
  for (int i = 0; i < 1000; ++i) {
    const double value = stamp(random);
    EXPECT_EQ(std::strtod(ExactText(value).c_str(), nullptr), value);
  }
}

TEST(NumberText, ExtremesFit) {
  EXPECT_EQ(FixedText(std::numeric_limits<double>::max(), 9).size(), 309U + 10U);
  EXPECT_FALSE(ExactText(std::numeric_limits<double>::denorm_min()).empty());
}

TEST(NumberText, ShortAsPeopleWriteIt) {
  EXPECT_EQ(ShortText(0.05), "0.05");
  EXPECT_EQ(ShortText(1013.25), "1013.25");
  EXPECT_EQ(ShortText(101325.125), "101325");
  EXPECT_EQ(ShortText(1e-7), "1e-07");
  EXPECT_EQ(ShortText(1357924680.25, 10), "1357924680");
}

}  // namespace
}  // namespace masked_mapper
