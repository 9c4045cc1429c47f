// SPDX-License-Identifier: BSD-3-Clause
// A map that is finished is never lost, whatever becomes of what it is exported as.
#include <gtest/gtest.h>

#include <iterator>
#include <sstream>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// The ring, at the end of which wheels say that the robot is `far` metres off: with cells of a
/// centimetre no octree reaches there.
std::vector<std::string> FarLog(double far) {
  std::vector<std::string> lines = RingLog(1);
  for (std::size_t i = lines.size() - 20; i < lines.size(); ++i) {
    std::istringstream line(lines[i]);
    std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
    for (const std::size_t from_end : {9U, 6U}) {
      std::string& x = words[words.size() - from_end];
      x = std::to_string(std::stod(x) + far);
    }
    lines[i].clear();
    for (const std::string& word : words) lines[i] += (lines[i].empty() ? "" : " ") + word;
  }
  return lines;
}

class FinishedMap : public testing::Test {
 protected:
  FinishedMap() { WriteText(folder_ / "ring.log", Joined(RingLog(1))); }

  std::vector<std::string> Map(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"map", folder_ / "ring.log", "-o", folder_ / out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// Whether two folders hold the same, but for what shows seconds.
  void ExpectSame(const std::string& one, const std::string& other) const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / one)) {
      const std::string name = entry.path().lexically_relative(folder_ / one).string();
      if (entry.is_directory() || name == "summary.json" || name == "report.html") continue;
      EXPECT_TRUE(ReadText(entry.path().string()) == ReadText(folder_ / (other + "/" + name)))
          << name;
    }
  }

  /// Nothing but OUT and the log: nothing half-written stays.
  void ExpectNothingAside() const {
    for (const auto& entry : fs::directory_iterator(fs::path(folder_ / "ring.log").parent_path())) {
      EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
    }
  }

  ScratchFolder folder_;
};

TEST_F(FinishedMap, StaysWhenTheOctreeIsTooLarge) {
  WriteText(folder_ / "ring.log", Joined(FarLog(400.0)));
  const std::vector<std::string> fine = {"--set", "motion.source=odometry", "--set",
                                         "grid.resolution_m=0.01"};
  const Ran ran = RunProgram(Map("out", fine));
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "building.bt could not be written: the map reaches")) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "the map itself is kept in " + folder_ / "out")) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "--resume --set grid.resolution_m=COARSER")) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "export " + folder_ / "out" + " --format all")) << ran.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/building.mmap"));
  EXPECT_TRUE(fs::exists(folder_ / "out/building.pcd"));
  EXPECT_FALSE(fs::exists(folder_ / "out/building.bt"));
  ExpectNothingAside();
  // The same again fails again, and takes nothing away.
  std::vector<std::string> again = fine;
  again.emplace_back("--resume");
  EXPECT_EQ(RunProgram(Map("out", again)).code, 1);
  EXPECT_TRUE(fs::exists(folder_ / "out/trajectory.tum"));
  // What was advised goes on: with coarser cells, from the map alone.
  std::vector<std::string> coarse = fine;
  coarse.back() = "grid.resolution_m=0.1";
  ASSERT_EQ(RunProgram(Map("whole", coarse)).code, 0);
  const Ran exported = RunProgram({"export", folder_ / "out", "--format", "all", "-o",
                                   folder_ / "new", "--set", "grid.resolution_m=0.1"});
  ASSERT_EQ(exported.code, 0) << exported.err;
  ExpectSame("whole", "new");
  coarse.emplace_back("--resume");
  const Ran resumed = RunProgram(Map("out", coarse));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_FALSE(Contains(resumed.err, "mapping")) << resumed.err;
  ExpectSame("whole", "out");
  // One that cannot be drawn so leaves what is there.
  const Ran failed = RunProgram(Map("out", again));
  EXPECT_EQ(failed.code, 1) << failed.err;
  ExpectSame("whole", "out");
}

TEST_F(FinishedMap, StaysWhenTheDiskIsFull) {
  ASSERT_EQ(RunProgram(Map("whole")).code, 0);
  RunSettings settings;  // room for the map, not for the page that shows it
  settings.largest_file = fs::file_size(folder_ / "whole/building.mmap") + 100;
  ASSERT_GT(fs::file_size(folder_ / "whole/report.html"), settings.largest_file);
  const Ran ran = RunProgram(Map("out"), settings);
  EXPECT_EQ(ran.code, 1);
  EXPECT_TRUE(Contains(ran.err, "report.html could not be written")) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "the same command with --resume")) << ran.err;
  EXPECT_FALSE(fs::exists(folder_ / "out/report.html"));
  EXPECT_EQ(ReadText(folder_ / "out/trajectory.tum"), ReadText(folder_ / "whole/trajectory.tum"));
  ExpectNothingAside();
  const Ran resumed = RunProgram(Map("out", {"--resume"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  ExpectSame("whole", "out");
  EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
  EXPECT_TRUE(Contains(RunProgram(Map("out", {"--resume"})).out, "finished already"));
}

TEST_F(FinishedMap, IsDrawnOtherwiseWithoutMappingAgain) {
  ASSERT_EQ(RunProgram(Map("out")).code, 0);
  ASSERT_EQ(RunProgram(Map("coarse", {"--set", "grid.resolution_m=0.1"})).code, 0);
  WriteText(folder_ / "out/floors/plan.txt", "mine");
  const Ran ran = RunProgram(Map("out", {"--resume", "--set", "grid.resolution_m=0.1"}));
  ASSERT_EQ(ran.code, 0) << ran.err;
  ExpectSame("coarse", "out");
  EXPECT_EQ(ReadText(folder_ / "out/floors/plan.txt"), "mine");
}

TEST_F(FinishedMap, StaysWhenItsEditsAreAtFault) {
  WriteText(folder_ / "edits.yaml", "- name_floor: {floor: 7, name: ground}\n");
  const Ran ran = RunProgram(Map("out", {"--edits", folder_ / "edits.yaml"}));
  EXPECT_EQ(ran.code, 2);
  EXPECT_TRUE(Contains(ran.err, "edits.yaml:1: ")) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "--format all --edits")) << ran.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/building.mmap"));
  EXPECT_EQ(RunProgram({"export", folder_ / "out", "--format", "all", "-o", folder_ / "new"}).code,
            0);
  ExpectUsersFault(folder_, Map("two", {"--edits", folder_ / "none.yaml"}), "none.yaml");
}

// An input that is at fault is still so when the same command is run again.
TEST_F(FinishedMap, ResumingIsNotAdvisedWhereItFailsAgain) {
  WriteText(folder_ / "none.log", "ODOM 0 0 0 0 0 0 1.0 robot 1.0\n");
  const Ran ran = RunProgram({"map", folder_ / "ring.log", folder_ / "none.log", "-o",
                              folder_ / "out", "--checkpoint", "0.000001"});
  EXPECT_EQ(ran.code, 2);
  EXPECT_FALSE(Contains(ran.err, "--resume")) << ran.err;
}

// Both drives are mapped and kept when the disk turns out to be too full for the joined map.
TEST_F(FinishedMap, NoMoreThanAllOfTheLogsIsKept) {
  const std::vector<std::string> lines = RingLog(2);
  WriteText(folder_ / "a.log", Joined({lines.begin(), lines.begin() + 420}));
  WriteText(folder_ / "b.log", Joined({lines.begin() + 150, lines.end()}));
  const std::vector<std::string> map = {"map",           folder_ / "a.log", folder_ / "b.log", "-o",
                                        folder_ / "out", "--checkpoint",    "0.000001"};
  ASSERT_EQ(RunProgram({"map", folder_ / "b.log", "-o", folder_ / "b"}).code, 0);
  RunSettings settings;
  settings.largest_file = fs::file_size(folder_ / "b/building.mmap") + 16384;
  const Ran ran = RunProgram(map, settings);
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "; 100 % of the logs is kept")) << ran.err;
}

}  // namespace
}  // namespace masked_mapper
