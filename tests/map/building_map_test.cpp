// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/building_map.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(StageSeconds, AddUpStageByStage) {
  StageSeconds sum;
  sum.matching = 1.0;
  StageSeconds more;
  more.read = 0.5;
  more.matching = 2.0;
  more.export_ = 4.0;
  more.total = 8.0;
  sum += more;
  EXPECT_EQ(sum.read, 0.5);
  EXPECT_EQ(sum.matching, 3.0);
  EXPECT_EQ(sum.export_, 4.0);
  EXPECT_EQ(sum.total, 8.0);
  EXPECT_EQ(sum.motion, 0.0);
}

}  // namespace
}  // namespace masked_mapper
