// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/number_lines.hpp"

#include <gtest/gtest.h>

#include "evaluation/written_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(NumberLines, WordsAndNumbersWithTheLineInEveryComplaint) {
  const std::string path = Write("numbers.txt", "# c\n1.5  -2\tx\n");
  std::size_t lines = 0;
  ForEachLine(path, [&](std::string_view line, const FileLine& where) {
    const auto words = WordsOf(line);
    if (words.empty() || words[0].front() == '#') return;
    ++lines;
    ASSERT_EQ(words.size(), 3U);
    EXPECT_EQ(NumberIn(words[0], where), 1.5);
    EXPECT_EQ(NumberIn(words[1], where), -2.0);
    EXPECT_THROW(NumberIn(words[2], where), InputError);
    EXPECT_EQ(where.number, 2U);
  });
  EXPECT_EQ(lines, 1U);
  EXPECT_THROW(ForEachLine(path + ".missing", [](std::string_view, const FileLine&) {}),
               InputError);
}

}  // namespace
}  // namespace masked_mapper
