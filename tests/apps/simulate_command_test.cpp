// SPDX-License-Identifier: BSD-3-Clause
// `simulate` from outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace masked_mapper {
namespace {

TEST(SimulateCommand, WritesLogAndTruth) {
  const ScratchFolder folder;
  const std::string log = folder / "office.log.gz";
  const Ran ran = RunProgram({"simulate", "--building", "office", "-o", log, "--seed", "3"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(folder.Listing(), (std::vector<std::string>{"office.log.gz", "office.log.truth.tum",
                                                        "office.log.truth_floors.csv"}));
  const Ran info = RunProgram({"info", log, "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json.at("counts").at("bad_lines"), 0);
  EXPECT_EQ(json.at("counts").at("scans"), LinesIn(ReadText(folder / "office.log.truth.tum")));

  // A simulated log may be simulated again, with the same bytes.
  const std::string first = ReadText(log);
  const Ran again =
      RunProgram({"simulate", "--building", "office", "-o", log, "--seed", "3", "--quiet"});
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.out + again.err, "");
  EXPECT_TRUE(ReadText(log) == first);
}

TEST(SimulateCommand, TheBarometerMayBeLeftOut) {
  const ScratchFolder folder;
  const std::string log = folder / "office.log";
  ASSERT_EQ(RunProgram({"simulate", "--building", "office", "-o", log, "--quiet"}).code, 0);
  EXPECT_TRUE(Contains(ReadText(log), "\nPRESSURE "));
  ASSERT_EQ(
      RunProgram({"simulate", "--building", "office", "-o", log, "--quiet", "--without-pressure"})
          .code,
      0);
  EXPECT_FALSE(Contains(ReadText(log), "\nPRESSURE "));
}

TEST(SimulateCommand, AnAccelerometerMayBeAdded) {
  const ScratchFolder folder;
  const std::string log = folder / "office.log";
  ASSERT_EQ(RunProgram({"simulate", "--building", "office", "-o", log, "--quiet"}).code, 0);
  EXPECT_FALSE(Contains(ReadText(log), "\nACCEL "));
  ASSERT_EQ(
      RunProgram({"simulate", "--building", "office", "-o", log, "--quiet", "--with-imu"}).code, 0);
  EXPECT_TRUE(Contains(ReadText(log), "\nACCEL "));
}

TEST(SimulateCommand, MistakesAreSaid) {
  const ScratchFolder folder;
  const std::string log = folder / "new.log";
  ExpectUsersFault(folder, {"simulate", "-o", log}, "--building is required");
  ExpectUsersFault(folder, {"simulate", "--building", "offise", "-o", log}, "office");
  ExpectUsersFault(folder, {"simulate", "--building", "office"}, "--output is required");
  ExpectUsersFault(folder, {"simulate", "--building", "office", "-o", log, "--seed", "x"},
                   "--seed");
  ExpectUsersFault(folder, {"simulate", "--building", "office", "-o", log, "--length", "-5"},
                   "--length");
  ExpectUsersFault(folder, {"simulate", "--building", "office", "-o", log, "--visits", "0,99"},
                   "no floor `99`");
  ExpectUsersFault(folder, {"simulate", "--building", "office", "-o", folder / ""}, "folder");
}

TEST(SimulateCommand, ALogThatWasNotSimulatedIsNotReplaced) {
  const ScratchFolder folder;
  WriteText(folder / "real.log", "precious");
  ExpectUsersFault(folder, {"simulate", "--building", "office", "-o", folder / "real.log"},
                   "--force");
  EXPECT_EQ(ReadText(folder / "real.log"), "precious");
}

TEST(SimulateCommand, AFullDiskIsAFailureThatLeavesNothing) {
  const ScratchFolder folder;
  RunSettings settings;
  settings.largest_file = 20000;
  const Ran ran =
      RunProgram({"simulate", "--building", "office", "-o", folder / "office.log.gz"}, settings);
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_TRUE(folder.Listing().empty());
}

}  // namespace
}  // namespace masked_mapper
