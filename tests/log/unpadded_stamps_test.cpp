// SPDX-License-Identifier: BSD-3-Clause
#include "log/unpadded_stamps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "log/temporary_file.hpp"
#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper {
namespace {

constexpr double kStart = 976055270.0;  // s

/// As a recorder writes it that prints seconds and microseconds with "%ld.%ld".
std::string Unpadded(std::int64_t microseconds) {
  return std::to_string(static_cast<std::int64_t>(kStart) + microseconds / 1000000) + "." +
         std::to_string(microseconds % 1000000);
}

/// Two sensors, each at its own rate, with jitter.
std::vector<std::pair<std::size_t, std::int64_t>> Times(int count) {
  std::mt19937 random(5);
  std::vector<std::pair<std::size_t, std::int64_t>> times;
  std::int64_t now = 0;
  for (int i = 0; i < count; ++i) {
    now += 20000 + static_cast<std::int64_t>(random() % 60000);
    times.emplace_back(i % 3 == 0 ? 1 : 0, now);
  }
  return times;
}

TEST(UnpaddedStampsTest, TimesAreFoundAgain) {
  UnpaddedStamps stamps;
  std::uint64_t wrong = 0;
  for (const auto& [stream, time] : Times(3000)) {
    const double meant = stamps.Meant(std::stod(Unpadded(time)), stream);
    wrong += std::abs(meant - kStart - 1e-6 * static_cast<double>(time)) > 1e-6 ? 1 : 0;
  }
  EXPECT_TRUE(stamps.IsFound());
  EXPECT_GT(stamps.mended(), 200U);
  EXPECT_LT(wrong, 30U) << "a few fractions mean several times between their neighbours";
}

TEST(UnpaddedStampsTest, OtherLogsAreLeftAlone) {
  UnpaddedStamps padded;
  UnpaddedStamps set_back;
  UnpaddedStamps tenths;
  for (const auto& [stream, time] : Times(3000)) {
    padded.Meant(kStart + 1e-6 * static_cast<double>(time), stream);
    const double step = time % 2000000 < 1000000 ? 0.0 : 3.0;
    set_back.Meant(kStart + 1e-6 * static_cast<double>(time) - step, stream);
  }
  for (int i = 0; i < 3000; ++i) tenths.Meant(kStart + 0.1 * i, 0);
  EXPECT_FALSE(padded.IsFound());
  EXPECT_FALSE(set_back.IsFound()) << "stamps that step back for another reason";
  EXPECT_FALSE(tenths.IsFound()) << "no fraction begins with a zero, and none need to";
}

TEST(UnpaddedStampsTest, ALogIsReadAgainAndSaysSo) {
  const TemporaryFile file(".log", "");
  std::ofstream log(file.path());
  for (const auto& [stream, time] : Times(1000)) {
    if (stream == 1) {
      log << "FLASER 3 1 2 3 0 0 0 0 0 0 " << Unpadded(time) << " robot 0\n";
    } else {
      log << "ODOM 0 0 0 0 0 0 " << Unpadded(time) << " robot 0\n";
    }
  }
  log.close();
  LogSource source(file.path(), {});
  const auto pass = [&source] {
    const std::unique_ptr<LogReader> reader = source.Read();
    while (reader->Next()) {
    }
    return reader->Statistics().stamp_jumps;
  };
  EXPECT_GT(pass(), 10U);
  EXPECT_TRUE(source.Findings().empty());
  ASSERT_TRUE(source.Reconsider());
  EXPECT_LT(pass(), 10U);
  EXPECT_FALSE(source.Reconsider());
  ASSERT_EQ(source.Findings().size(), 1U);
  EXPECT_GT(source.Findings().front().value, 50.0);
}

}  // namespace
}  // namespace masked_mapper
