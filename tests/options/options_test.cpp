// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/options.hpp"

#include <gtest/gtest.h>

namespace masked_mapper {
namespace {

TEST(Options, ThreadsReachEveryRoomThatWorksOnSeveral) {
  Options options;
  options.threads = 3;
  SettleThreads(options);
  EXPECT_EQ(options.threads, 3);
  EXPECT_EQ(options.mapping.closures.matcher.threads, 3);
  EXPECT_EQ(options.mapping.threads, 3);
  EXPECT_EQ(options.grid.threads, 3);
}

TEST(Options, NoneAskedForAreThoseOfTheMachine) {
  Options options;
  SettleThreads(options);
  EXPECT_GE(options.threads, 1);
}

}  // namespace
}  // namespace masked_mapper
