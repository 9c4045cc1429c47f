// SPDX-License-Identifier: BSD-3-Clause
#include "log/read_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Batches of one odometry reading, with stamps 0, 1, 2 ..., until nobody wants any more.
ReadAhead::Producer Counting(int readings, std::atomic<int>* produced = nullptr) {
  return [=](const ReadAhead::Sink& sink) {
    for (int i = 0; i < readings; ++i) {
      ObservationBatch batch;
      batch.observations.emplace_back(OdometryReading{static_cast<double>(i), {}});
      batch.statistics.odometry = static_cast<std::uint64_t>(i) + 1;
      batch.progress = (i + 1.0) / readings;
      if (produced != nullptr) ++*produced;
      if (!sink(std::move(batch))) return;
    }
  };
}

TEST(ReadAheadTest, HandsOutEverythingInOrderWithTheStatisticsOfThatPlace) {
  LogStatistics before;
  before.max_range = 30.0;
  ReadAhead reader(before, Counting(500));
  EXPECT_EQ(reader.Statistics().max_range, 30.0);
  for (int i = 0; i < 500; ++i) {
    const auto observation = reader.Next();
    ASSERT_TRUE(observation);
    EXPECT_EQ(Stamp(*observation), i);
    EXPECT_EQ(reader.Statistics().odometry, static_cast<std::uint64_t>(i) + 1);
  }
  EXPECT_EQ(reader.Progress(), 1.0);
  EXPECT_FALSE(reader.Next());
  EXPECT_FALSE(reader.Next());
}

TEST(ReadAheadTest, EmptyBatchesAndEmptyLogs) {
  ReadAhead none({}, [](const ReadAhead::Sink&) {});
  EXPECT_FALSE(none.Next());
  ReadAhead empty({}, [](const ReadAhead::Sink& sink) {
    sink(ObservationBatch{});
    Counting(1)(sink);
  });
  EXPECT_TRUE(empty.Next());
  EXPECT_FALSE(empty.Next());
}

TEST(ReadAheadTest, WhatTheProducerThrowsComesAfterWhatItProduced) {
  ReadAhead reader({}, [](const ReadAhead::Sink& sink) {
    Counting(3)(sink);
    throw InputError("broken off");
  });
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(reader.Next());
  EXPECT_THROW(reader.Next(), InputError);
  EXPECT_FALSE(reader.Next());
}

TEST(ReadAheadTest, TheProducerRunsAheadOnlySoFarAndIsLetGo) {
  std::atomic<int> produced = 0;
  {
    ReadAhead reader({}, Counting(1'000'000, &produced));
    ASSERT_TRUE(reader.Next());
  }
  EXPECT_LT(produced, 100);
}

}  // namespace
}  // namespace masked_mapper
