// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/run_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>

namespace masked_mapper {
namespace {

TEST(RunAheadTest, HandsOutInOrderWhatCannotBeCopied) {
  for (const std::size_t at_once : {1U, 7U, 2000U}) {
    RunAhead<std::unique_ptr<int>> ahead(
        3,
        [](const auto& sink) {
          for (int i = 0; i < 1000; ++i) sink(std::make_unique<int>(i));
        },
        at_once);
    for (int i = 0; i < 1000; ++i) {
      const auto item = ahead.Next();
      ASSERT_TRUE(item);
      EXPECT_EQ(**item, i);
    }
    EXPECT_FALSE(ahead.Next());
    EXPECT_FALSE(ahead.Next());
  }
}

TEST(RunAheadTest, WhatTheProducerThrowsComesBehindWhatItMade) {
  for (const std::size_t at_once : {1U, 2U}) {
    RunAhead<int> ahead(
        8,
        [](const auto& sink) {
          sink(1);
          throw std::runtime_error("broken off");
        },
        at_once);
    EXPECT_EQ(ahead.Next(), 1);
    EXPECT_THROW(ahead.Next(), std::runtime_error);
    EXPECT_FALSE(ahead.Next());
  }
}

TEST(RunAheadTest, TheProducerIsSoFarAheadAtMostAndIsLetGo) {
  std::atomic<int> made = 0;
  {
    RunAhead<int> ahead(4, [&made](const auto& sink) {
      while (sink(made)) ++made;
    });
    ASSERT_TRUE(ahead.Next());
  }
  EXPECT_LE(made, 5);
}

TEST(RunAheadTest, WhatIsThrownAndNotTakenIsForgotten) {
  RunAhead<int> ahead(1, [](const auto& sink) {
    while (sink(1)) {
    }
    throw std::runtime_error("nobody hears it");
  });
}

}  // namespace
}  // namespace masked_mapper
