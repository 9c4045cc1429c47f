// SPDX-License-Identifier: BSD-3-Clause
#include "export/floor_label.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(FloorLabel, NamesOfFiles) {
  for (const char* good : {"0", "-1", "EG", "level_2.5", "..."}) EXPECT_TRUE(IsFileName(good));
  for (const char* bad : {"", ".", "..", "a/b", "../x", "a b", "\xc3\xa4", "a\nb", "a\\b"}) {
    EXPECT_FALSE(IsFileName(bad)) << bad;
  }
  EXPECT_TRUE(IsFileName(std::string(100, 'x')));
  EXPECT_FALSE(IsFileName(std::string(101, 'x')));
}

TEST(FloorLabel, BadOrSharedLabelsAreRefused) {
  EXPECT_NO_THROW(CheckFloorLabels({}));
  EXPECT_NO_THROW(CheckFloorLabels({{"0"}, {"1"}}));
  EXPECT_THROW(CheckFloorLabels({{"0"}, {"../../etc"}}), InputError);
  EXPECT_THROW(CheckFloorLabels({{"0"}, {"1"}, {"0"}}), InputError);
}

}  // namespace
}  // namespace masked_mapper
