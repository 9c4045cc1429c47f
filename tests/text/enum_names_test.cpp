// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/enum_names.hpp"

#include <gtest/gtest.h>

#include <array>

namespace masked_mapper {
namespace {

enum class Colour { kRed, kGreen };
constexpr std::array<const char*, 2> NamesOf(Colour /*any*/) { return {"red", "green"}; }

TEST(EnumNames, ThereAndBack) {
  EXPECT_STREQ(Name(Colour::kRed), "red");
  EXPECT_STREQ(Name(Colour::kGreen), "green");
  EXPECT_EQ(FromName<Colour>("green"), Colour::kGreen);
  EXPECT_FALSE(FromName<Colour>("blue"));
  EXPECT_FALSE(FromName<Colour>(""));
}

}  // namespace
}  // namespace masked_mapper
