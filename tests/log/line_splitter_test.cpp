// SPDX-License-Identifier: BSD-3-Clause
#include "log/line_splitter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace masked_mapper {
namespace {

TEST(LineSplitterTest, CutsTheSameLinesWhateverTheBlocks) {
  const std::string text = "one\n\ntwo three\nfour";
  for (std::size_t block = 1; block <= text.size(); ++block) {
    LineSplitter splitter;
    std::vector<std::string> lines;
    const auto on_line = [&](const char* begin, const char* end, bool too_long) {
      EXPECT_FALSE(too_long);
      EXPECT_EQ(*end, '\n');
      lines.emplace_back(begin, end);
    };
    for (std::size_t at = 0; at < text.size(); at += block) {
      splitter.Add(std::string_view(text).substr(at, block), on_line);
    }
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "", "two three"}));
    EXPECT_TRUE(splitter.Finish(on_line));
    EXPECT_EQ(lines.back(), "four");
    EXPECT_FALSE(splitter.Finish(on_line));
  }
}

TEST(LineSplitterTest, GivesUpEndlessLinesButNotWhatFollows) {
  LineSplitter splitter;
  std::vector<std::string> lines;
  int too_long_lines = 0;
  const auto on_line = [&](const char* begin, const char* end, bool too_long) {
    too_long_lines += too_long ? 1 : 0;
    EXPECT_LE(end - begin, 100);
    lines.emplace_back(begin, end);
  };
  const std::string block(1 << 20, 'x');
  for (int i = 0; i < 20; ++i) splitter.Add(block, on_line);
  splitter.Add("\nnext\n", on_line);
  EXPECT_EQ(too_long_lines, 1);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1], "next");
}

}  // namespace
}  // namespace masked_mapper
