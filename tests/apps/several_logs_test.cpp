// SPDX-License-Identifier: BSD-3-Clause
// `map` of several logs, and onto a map that is there, from outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// A ring, and a drive through it that begins elsewhere.
class SeveralLogs : public testing::Test {
 protected:
  SeveralLogs() {
    const std::vector<std::string> lines = RingLog(2);
    WriteText(folder_ / "a.log", Joined({lines.begin(), lines.begin() + 420}));
    WriteText(folder_ / "b.log", Joined({lines.begin() + 150, lines.end()}));
  }

  std::vector<std::string> Map(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"map", folder_ / "a.log", folder_ / "b.log",
                                          "-o",  folder_ / out,     "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  nlohmann::json Summary(const std::string& out) const {
    return nlohmann::json::parse(ReadText(folder_ / (out + "/summary.json")));
  }

  void ExpectSame(const std::string& one, const std::string& other) const {
    for (const char* file :
         {"building.mmap", "building.bt", "building.pcd", "trajectory.tum", "nodes.tum",
          "graph.g2o", "closures.csv", "drives/1.tum", "drives/2.tum"}) {
      EXPECT_EQ(ReadText(folder_ / (one + "/" + file)), ReadText(folder_ / (other + "/" + file)))
          << file;
    }
  }

  ScratchFolder folder_;
};

TEST_F(SeveralLogs, AreJoinedAndSaidToBe) {
  const Ran ran = RunProgram(Map("out", {"--threads", "1"}));
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto summary = Summary("out");
  EXPECT_EQ(summary.at("log"), folder_ / "a.log");
  ASSERT_EQ(summary.at("drives").size(), 2U);
  const auto& second = summary.at("drives")[1];
  EXPECT_EQ(second.at("log"), folder_ / "b.log");
  EXPECT_EQ(second.at("joined"), true) << second.at("reason");
  EXPECT_EQ(second.at("piece"), 0);
  EXPECT_GT(second.at("closures_to_others").get<int>(), 0);
  EXPECT_GT(second.at("stamp_offset_s").get<double>(), 0.0);
  EXPECT_EQ(summary.at("floors").size(), 1U);
  EXPECT_TRUE(fs::exists(folder_ / "out/drives/2.tum"));
  EXPECT_TRUE(Contains(ReadText(folder_ / "out/report.html"), "\"breaks\":["));
  ASSERT_EQ(RunProgram(Map("two", {"--threads", "2"})).code, 0);
  ExpectSame("out", "two");
  // What is written again from the saved map is the same, and `info` tells of both.
  ASSERT_EQ(
      RunProgram({"export", folder_ / "out", "--format", "all", "-o", folder_ / "again"}).code, 0);
  ExpectSame("out", "again");
  const Ran info = RunProgram({"info", folder_ / "out"});
  EXPECT_TRUE(Contains(info.out, "drive 2")) << info.out;
  const auto json = nlohmann::json::parse(RunProgram({"info", folder_ / "out", "--json"}).out);
  EXPECT_EQ(json.at("drives"), summary.at("drives"));
}

TEST_F(SeveralLogs, OntoAMapIsTheSameAsTogether) {
  ASSERT_EQ(RunProgram(Map("out")).code, 0);
  ASSERT_EQ(RunProgram({"map", folder_ / "a.log", "-o", folder_ / "old", "--quiet"}).code, 0);
  const std::vector<std::string> onto = {"map", folder_ / "b.log", "--onto", folder_ / "old",
                                         "-o",  folder_ / "grown"};
  const Ran ran = RunProgram(onto);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(Contains(ran.out, "drive 2")) << ran.out;
  for (const char* file : {"building.bt", "building.pcd", "trajectory.tum", "nodes.tum",
                           "graph.g2o", "closures.csv", "drives/2.tum"}) {
    EXPECT_EQ(ReadText(folder_ / (std::string("out/") + file)),
              ReadText(folder_ / (std::string("grown/") + file)))
        << file;
  }
  EXPECT_EQ(Summary("grown").at("log"), folder_ / "a.log");
  // In place, when it is asked for.
  ExpectUsersFault(folder_,
                   {"map", folder_ / "b.log", "--onto", folder_ / "old", "-o", folder_ / "old"},
                   "--force");
  const Ran again = RunProgram({"map", folder_ / "b.log", "--onto", folder_ / "old", "-o",
                                folder_ / "old", "--force", "--quiet"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(Summary("old").at("drives").size(), 2U);
}

TEST_F(SeveralLogs, MistakesNameTheirFile) {
  WriteText(folder_ / "none.log", "ODOM 0 0 0 0 0 0 1.0 robot 1.0\n");
  const std::string out = folder_ / "out";
  ExpectUsersFault(folder_,
                   {"map", folder_ / "a.log", folder_ / "none.log", "-o", out, "--checkpoint", "0"},
                   "none.log");
  ExpectUsersFault(folder_, {"map", folder_ / "a.log", folder_ / "gone.log", "-o", out},
                   "gone.log");
  ExpectUsersFault(folder_, {"map", folder_ / "a.log", "--onto", folder_ / "gone", "-o", out},
                   "gone");
  WriteText(folder_ / "text.mmap", "this is no map");
  ExpectUsersFault(folder_, {"map", folder_ / "a.log", "--onto", folder_ / "text.mmap", "-o", out},
                   "not a saved map");
  ASSERT_EQ(RunProgram({"map", folder_ / "a.log", "-o", folder_ / "old", "--quiet"}).code, 0);
  std::string bytes = ReadText(folder_ / "old/building.mmap");
  WriteText(folder_ / "cut.mmap", bytes.substr(0, bytes.size() / 2));
  ExpectUsersFault(folder_, {"map", folder_ / "a.log", "--onto", folder_ / "cut.mmap", "-o", out},
                   "damaged");
  WriteText(folder_ / "floors.csv", "t,label\n100,EG\n");
  ExpectUsersFault(folder_, Map("out", {"--floors", folder_ / "floors.csv"}), "once for each");
}

TEST_F(SeveralLogs, OneScanStaysApart) {
  const std::vector<std::string> lines = RingLog(1);
  WriteText(folder_ / "one.log", lines[50] + "\n");
  const Ran ran =
      RunProgram({"map", folder_ / "a.log", folder_ / "one.log", "-o", folder_ / "out"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(Contains(ran.out, "NOT JOINED")) << ran.out;
  EXPECT_TRUE(Contains(ran.err, "stays a piece of its own")) << ran.err;
  const auto summary = Summary("out");
  EXPECT_EQ(summary.at("drives")[1].at("joined"), false);
  EXPECT_EQ(summary.at("drives")[1].at("piece"), 1);
  EXPECT_TRUE(fs::exists(folder_ / "out/floors/0.drive2.pgm"));
}

TEST_F(SeveralLogs, WhateverEndsItItGoesOn) {
  ASSERT_EQ(RunProgram(Map("whole")).code, 0);
  for (const int milliseconds : {60, 120, 200, 300, 420, 560}) {
    RunSettings settings;
    settings.kill_after_ms = milliseconds;
    RunProgram(Map("out", {"--checkpoint", "0.001", "--resume"}), settings);
  }
  const Ran ran = RunProgram(Map("out", {"--checkpoint", "0.001", "--resume"}));
  ASSERT_EQ(ran.code, 0) << ran.err;
  ExpectSame("whole", "out");
  EXPECT_FALSE(fs::exists(folder_ / ".out.unfinished"));
}

}  // namespace
}  // namespace masked_mapper
