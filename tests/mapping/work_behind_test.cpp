// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/work_behind.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace masked_mapper {
namespace {

TEST(WorkBehindTest, AllIsDoneInOrderWithAThreadAndWithout) {
  for (const bool in_thread : {true, false}) {
    std::vector<int> done;
    WorkBehind<int> behind(3, in_thread, [&done](int item) { done.push_back(item); });
    for (int i = 0; i < 1000; ++i) behind.Add(i);
    behind.Finish();
    ASSERT_EQ(done.size(), 1000U);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
  }
}

TEST(WorkBehindTest, WhatTheWorkThrowsIsThrownAndHoldsNobodyUp) {
  WorkBehind<int> behind(1, true, [](int item) {
    if (item == 3) throw std::runtime_error("three");
  });
  for (int i = 0; i < 100; ++i) behind.Add(i);
  EXPECT_THROW(behind.Finish(), std::runtime_error);
  WorkBehind<int> at_once(1, false, [](int /*item*/) { throw std::runtime_error("all"); });
  EXPECT_THROW(at_once.Add(1), std::runtime_error);
}

TEST(WorkBehindTest, WhatNobodyWaitsForIsForgotten) {
  std::atomic<bool> may_go_on = false;
  std::atomic<int> done = 0;
  {
    WorkBehind<int> behind(100, true, [&](int /*item*/) {
      while (!may_go_on) {
      }
      ++done;
    });
    for (int i = 0; i < 100; ++i) behind.Add(i);
    may_go_on = true;
  }
  EXPECT_LE(done, 100);
}

}  // namespace
}  // namespace masked_mapper
