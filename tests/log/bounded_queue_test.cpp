// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/run_ahead.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace masked_mapper {
namespace {

TEST(BoundedQueueTest, PassesEverythingInOrder) {
  BoundedQueue<int> queue(3);
  std::thread producer([&queue] {
    for (int i = 0; i < 1000; ++i) queue.Push(i);
    queue.Close();
  });
  int expected = 0;
  while (const std::optional<int> item = queue.Pop()) EXPECT_EQ(*item, expected++);
  producer.join();
  EXPECT_EQ(expected, 1000);
}

TEST(BoundedQueueTest, AProducerIsLetGoWhenNobodyTakes) {
  BoundedQueue<int> queue(1);
  std::thread producer([&queue] {
    while (queue.Push(1)) {
    }
  });
  queue.Close();
  producer.join();
  EXPECT_FALSE(queue.Push(2));
}

}  // namespace
}  // namespace masked_mapper
