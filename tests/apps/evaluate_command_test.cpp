// SPDX-License-Identifier: BSD-3-Clause
// `evaluate --checked` from outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

TEST(EvaluateCommand, ChecksItselfAndRefusesMapsOfOtherLogs) {
  const ScratchFolder folder;
  const std::string map = folder / "map";
  const std::string other = folder / "other";
  WriteText(folder / "ring.log", Joined(RingLog(2)));
  WriteText(folder / "short.log", Joined(RingLog(1)));
  ASSERT_EQ(RunProgram({"map", folder / "ring.log", "-o", map, "--quiet"}).code, 0);
  ASSERT_EQ(RunProgram({"map", folder / "short.log", "-o", other, "--quiet"}).code, 0);
  const Ran ran = RunProgram({"evaluate", map, "--json", "--checked", map, map});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json.at("path_length").at("pairs"), 999);
  EXPECT_EQ(json.at("path_length").at("max_m"), 0.0);
  ExpectUsersFault(folder, {"evaluate", map, "--checked", other}, "is no map of the log of");
  ExpectUsersFault(folder, {"evaluate", map, "--checked", folder / "none"}, "is no folder");
  ExpectUsersFault(folder, {"evaluate", map}, "--checked");
}

}  // namespace
}  // namespace masked_mapper
