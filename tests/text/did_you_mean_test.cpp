// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace masked_mapper {
namespace {

/// The definition, without a table.
std::size_t Plain(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  std::size_t least = Plain(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
  least = std::min({least, Plain(a.substr(1), b) + 1, Plain(a, b.substr(1)) + 1});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    least = std::min(least, Plain(a.substr(2), b.substr(2)) + 1);
  }
  return least;
}

TEST(DidYouMean, DistanceIsThatOfTheDefinition) {
  const std::vector<std::string> words = {"", "a", "ab", "ba", "abc", "acb", "cab", "bcab", "aabb"};
  for (const std::string& a : words) {
    for (const std::string& b : words) EXPECT_EQ(EditDistance(a, b), Plain(a, b)) << a << ' ' << b;
  }
}

TEST(DidYouMean, SuggestsTheNearestOrNothing) {
  const std::vector<std::string> masks = {"always", "eccentricity", "never", "openings"};
  EXPECT_EQ(DidYouMean("openingz", masks), " (did you mean `openings`?)");
  EXPECT_EQ(DidYouMean("nevre", masks), " (did you mean `never`?)");
  EXPECT_EQ(DidYouMean("xyz", masks), "");
  EXPECT_EQ(DidYouMean("", masks), "");
  EXPECT_EQ(DidYouMean("a", {}), "");
  EXPECT_EQ(DidYouMean(std::string(1'000'000, 'x'), masks), "");
}

}  // namespace
}  // namespace masked_mapper
