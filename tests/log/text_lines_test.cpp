// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/text_lines.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::vector<std::string> LinesOf(const std::string& path) {
  std::vector<std::string> lines;
  ForEachLine(path, [&](std::string_view line, const FileLine& where) {
    lines.emplace_back(line);
    EXPECT_EQ(where.number, lines.size());
    EXPECT_EQ(where.path, path);
  });
  return lines;
}

TEST(TextLines, LinesWithoutTheirBreaksAndWithTheirNumbers) {
  const TemporaryFile file(".txt", "# c\n\n1.5 -2\r\nlast");
  EXPECT_EQ(LinesOf(file.path()), (std::vector<std::string>{"# c", "", "1.5 -2", "last"}));
}

TEST(TextLines, WhatCannotBeReadOrGoesOnForEverIsRefused) {
  EXPECT_THROW(LinesOf("/no/such.txt"), InputError);
  const TemporaryFile file(".txt", "a\n" + std::string(70000, 'x') + "\n");
  try {
    LinesOf(file.path());
    FAIL() << "a line of 70000 letters was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file.path() + ":2: the line is too long");
  }
}

}  // namespace
}  // namespace masked_mapper
