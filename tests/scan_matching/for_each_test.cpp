// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/for_each.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace masked_mapper {
namespace {

TEST(ForEach, DoesEachOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    for (const std::size_t count : {0U, 1U, 2U, 100U}) {
      std::vector<std::atomic<int>> done(count);
      ForEach(count, threads, [&](std::size_t i) { ++done[i]; });
      for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1) << threads << " threads";
    }
  }
}

TEST(ForEach, ThrowsOnWhatAWorkerThrew) {
  for (const int threads : {1, 3}) {
    EXPECT_THROW(ForEach(50, threads,
                         [](std::size_t i) {
                           if (i == 40) throw std::bad_alloc();
                         }),
                 std::bad_alloc)
        << threads << " threads";
  }
}

}  // namespace
}  // namespace masked_mapper
