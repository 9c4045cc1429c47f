// SPDX-License-Identifier: BSD-3-Clause
// `masked_mapper localize` as a user sees it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/live_program.hpp"
#include "apps/program.hpp"

namespace masked_mapper {
namespace {

class LocalizeCommand : public testing::Test {
 protected:
  void SetUp() override {
    const std::string whole = folder_ / "whole.log";
    ASSERT_EQ(RunProgram({"simulate", "--building", "office", "-o", whole, "--quiet"}).code, 0);
    const std::string text = ReadText(whole);
    std::size_t end = 0;
    for (int line = 0; line < kLines; ++line) end = text.find('\n', end) + 1;
    WriteText(log_, text.substr(0, end));
    ASSERT_EQ(RunProgram({"map", log_, "-o", map_, "--quiet"}).code, 0);
  }

  static constexpr int kLines = 900;  // as many as it takes to be found
  ScratchFolder folder_;
  std::string log_ = folder_ / "office.log";
  std::string map_ = folder_ / "map";
};

// A log that is followed is answered scan by scan, and ends as the same bytes as the whole file.
TEST_F(LocalizeCommand, FollowsAFileAndEndsAsItDoesOffline) {
  const Ran offline = RunProgram({"localize", log_, "--in", map_, "-o", folder_ / "a", "--json"});
  ASSERT_EQ(offline.code, 0) << offline.err;
  const nlohmann::json summary = nlohmann::json::parse(offline.out);
  EXPECT_TRUE(summary["found"]) << offline.out;
  RunSettings interrupted;
  interrupted.interrupt = true;
  const Ran live = RunProgram(
      {"localize", "--follow", log_, "--in", map_, "-o", folder_ / "b", "--poses"}, interrupted);
  ASSERT_EQ(live.code, 0) << live.err;
  EXPECT_EQ(LinesIn(live.out), summary["scans"].get<long>());
  const std::string first = live.out.substr(0, live.out.find('\n'));
  for (const char* key :
       {"t", "floor", "x", "y", "theta", "sigma_x", "sigma_y", "sigma_theta", "sure"}) {
    EXPECT_TRUE(nlohmann::json::parse(first).contains(key)) << key;
  }
  for (const std::string file : {"trajectory.tum", "floors.csv"}) {
    EXPECT_EQ(ReadText(folder_ / ("a/" + file)), ReadText(folder_ / ("b/" + file))) << file;
    EXPECT_FALSE(ReadText(folder_ / ("b/" + file)).empty()) << file;
  }
}

// The same of a pipe, whose writer is killed in the middle of a line.
TEST_F(LocalizeCommand, AnswersAPipeAsItComes) {
  const std::string text = ReadText(log_);
  const std::string came = text.substr(0, text.size() - 300);
  LiveProgram program({"localize", "-", "--in", map_, "-o", folder_ / "a", "--poses"}, folder_);
  program.Write(came.substr(0, came.size() / 2));
  // Answers come before the log is over.
  ASSERT_TRUE(ComesTrue([&] { return LinesIn(program.Out()) > 0; })) << program.Err();
  program.Write(came.substr(came.size() / 2));
  ASSERT_EQ(program.End(), 0) << program.Err();
  EXPECT_TRUE(Contains(program.Err(), "cut off")) << program.Err();
  EXPECT_FALSE(Contains(program.Err(), "/proc")) << program.Err();
  WriteText(folder_ / "cut.log", came);
  const Ran offline =
      RunProgram({"localize", folder_ / "cut.log", "--in", map_, "-o", folder_ / "b", "--quiet"});
  ASSERT_EQ(offline.code, 0) << offline.err;
  for (const std::string file : {"trajectory.tum", "floors.csv"}) {
    EXPECT_EQ(ReadText(folder_ / ("a/" + file)), ReadText(folder_ / ("b/" + file))) << file;
  }
}

TEST_F(LocalizeCommand, SaysWhatItNeeds) {
  ExpectUsersFault(folder_, {"localize", "--in", map_, "-o", folder_ / "c"}, "--follow");
  ExpectUsersFault(folder_, {"localize", log_, "--follow", log_, "--in", map_, "-o", folder_ / "c"},
                   "one of the two");
  ExpectUsersFault(folder_,
                   {"localize", "--follow", folder_ / "none", "--in", map_, "-o", folder_ / "c"},
                   "No such file");
}

}  // namespace
}  // namespace masked_mapper
