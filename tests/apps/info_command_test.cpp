// SPDX-License-Identifier: BSD-3-Clause
// `info`: what it says of a log, and of what is none.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/bad_logs.hpp"
#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

TEST(InfoCommand, InfoInWordsAndAsJson) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(1)));
  const Ran words = RunProgram({"info", folder / "ring.log"});
  EXPECT_EQ(words.code, 0) << words.err;
  EXPECT_TRUE(Contains(words.out, "181")) << words.out;
  const Ran ran = RunProgram({"info", folder / "ring.log", "--json", "--quiet"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json.at("counts").at("scans"), static_cast<int>(RingDrive(1).size()));
  EXPECT_EQ(json.at("scans_of_beams").at("181"), static_cast<int>(RingDrive(1).size()));
  EXPECT_TRUE(json.at("has_odometry"));
  EXPECT_NEAR(json.at("path_length_m"), 56.0, 1.0);
}

TEST(InfoCommand, LogsThatAreNone) {
  const ScratchFolder folder;
  for (const auto& [name, said] : WriteLogsThatAreNone(folder)) {
    ExpectUsersFault(folder, {"info", folder / name}, said);
  }
}

}  // namespace
}  // namespace masked_mapper
