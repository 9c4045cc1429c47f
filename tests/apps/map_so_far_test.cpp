// SPDX-License-Identifier: BSD-3-Clause
// `masked_mapper map` of a log that is still coming, as a user sees it.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/live_program.hpp"
#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

class MapSoFar : public testing::Test {
 protected:
  MapSoFar() {
    const std::size_t middle = text_.find('\n', text_.size() / 2) + 1;
    first_half_ = text_.substr(0, middle);
    second_half_ = text_.substr(middle);
    WriteText(log_, text_);
  }

  /// Whether the map so far is there; asks for it, and waits.
  bool IsWritten(const LiveProgram& program) const {
    return ComesTrue([&] {
      if (Contains(program.Err(), "map so far: ")) return true;
      program.Signal(SIGUSR1);
      return false;
    });
  }
  /// Once it listens it answers the signal, which would end it before.
  static bool Listens(const LiveProgram& program, const std::string& out) {
    return ComesTrue([&] { return Contains(program.Err(), "listening to " + out); });
  }

  void ExpectSameMap(const std::string& a, const std::string& b) const {
    int compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / a)) {
      const std::string name = entry.path().lexically_relative(folder_ / a).string();
      if (entry.is_directory() || name == "summary.json" || name == "report.html") continue;
      EXPECT_TRUE(ReadText(entry.path().string()) == ReadText(folder_ / b + "/" + name)) << name;
      ++compared;
    }
    EXPECT_GT(compared, 8);
  }

  /// As many bytes as came: the poses of the map so far are those of a map of that much.
  void ExpectSamePosesAs(const std::string& bytes) const {
    WriteText(folder_ / "prefix.log", bytes);
    ASSERT_EQ(RunProgram({"map", folder_ / "prefix.log", "-o", folder_ / "prefix", "--quiet"}).code,
              0);
    const std::string poses = folder_ / "poses.tum";
    const Ran exported =
        RunProgram({"export", folder_ / "out", "--format", "tum", "-o", poses, "--quiet"});
    ASSERT_EQ(exported.code, 0) << exported.err;
    EXPECT_TRUE(ReadText(poses) == ReadText(folder_ / "prefix/trajectory.tum"));
  }

  ScratchFolder folder_;
  std::string text_ = Joined(RingLog(2));
  std::string first_half_;
  std::string second_half_;
  std::string log_ = folder_ / "ring.log";
};

TEST_F(MapSoFar, OfAPipeIsAMapOfWhatCameAndTheEndIsThatOfTheFile) {
  LiveProgram program({"map", "-", "-o", folder_ / "out"}, folder_);
  const std::string half_a_line = second_half_.substr(0, 100);
  program.Write(first_half_ + half_a_line);
  ASSERT_TRUE(Listens(program, "-"));
  ASSERT_TRUE(IsWritten(program)) << program.Err();
  const Ran info = RunProgram({"info", folder_ / "out", "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_TRUE(Contains(info.out, "this is the map so far")) << info.out;
  ExpectSamePosesAs(first_half_);
  program.Write(second_half_.substr(half_a_line.size()));
  ASSERT_EQ(program.End(), 0) << program.Err();
  // Of the file by the name of standard input, since the saved map holds it.
  ASSERT_EQ(std::system((std::string(MASKED_MAPPER_PROGRAM) + " map - -o " + (folder_ / "whole") +
                         " --quiet < " + log_)
                            .c_str()),
            0);
  ExpectSameMap("whole", "out");
}

TEST_F(MapSoFar, OfAFileThatGrowsIsWrittenUnasked) {
  WriteText(log_, first_half_);
  LiveProgram program({"map", "--follow", log_, "-o", folder_ / "out", "--every", "0.1"}, folder_);
  ASSERT_TRUE(ComesTrue([&] { return Contains(program.Err(), "map so far: "); })) << program.Err();
  std::ofstream(log_, std::ios::binary | std::ios::app) << second_half_;
  program.Signal(SIGINT);
  ASSERT_EQ(program.End(), 0) << program.Err();
  ASSERT_EQ(RunProgram({"map", log_, "-o", folder_ / "whole", "--quiet"}).code, 0);
  ExpectSameMap("whole", "out");
}

TEST_F(MapSoFar, StaysWhenTheProgramIsKilledAndIsTakenForNoFinishedMap) {
  {
    LiveProgram program({"map", "--follow", log_, "-o", folder_ / "out"}, folder_);
    ASSERT_TRUE(Listens(program, log_));
    ASSERT_TRUE(IsWritten(program)) << program.Err();
    program.Signal(SIGKILL);
  }
  EXPECT_EQ(RunProgram({"info", folder_ / "out"}).code, 0);
  ExpectUsersFault(folder_, {"map", log_, "-o", folder_ / "out"}, "--force");
  const Ran ran = RunProgram({"map", log_, "-o", folder_ / "out", "--resume"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_FALSE(Contains(ran.out, "finished already")) << ran.out;
  ASSERT_EQ(RunProgram({"map", log_, "-o", folder_ / "whole", "--quiet"}).code, 0);
  ExpectSameMap("whole", "out");
}

// The writer is killed in the middle of a line: a log that is cut off, and so it is said.
TEST_F(MapSoFar, AKilledWriterLeavesTheMapOfWhatCame) {
  LiveProgram program({"map", "-", "-o", folder_ / "out"}, folder_);
  program.Write(first_half_ + second_half_.substr(0, 100));
  ASSERT_EQ(program.End(), 0) << program.Err();
  EXPECT_TRUE(Contains(program.Err(), "cut off")) << program.Err();
  ExpectSamePosesAs(first_half_);
}

// A writer that stalls in the middle of a line is waited for, and both is said, once.
TEST_F(MapSoFar, ASilentPipeIsSaidAndWaitedFor) {
  LiveProgram program({"map", "-", "-o", folder_ / "out"}, folder_);
  const std::string half_a_line = second_half_.substr(0, 100);
  program.Write(first_half_ + half_a_line);
  ASSERT_TRUE(ComesTrue([&] { return Contains(program.Err(), "nothing came for 10 s"); }))
      << program.Err();
  EXPECT_TRUE(IsWritten(program)) << program.Err();
  EXPECT_FALSE(Contains(program.Err(), "goes on")) << program.Err();
  program.Write(second_half_.substr(half_a_line.size()));
  ASSERT_EQ(program.End(), 0) << program.Err();
  EXPECT_TRUE(Contains(program.Err(), "goes on")) << program.Err();
  EXPECT_FALSE(Contains(program.Err(), "cut off")) << program.Err();
  ExpectSamePosesAs(text_);
}

TEST_F(MapSoFar, OfNothingIsSaidAndTheListeningGoesOn) {
  LiveProgram program({"map", "-", "-o", folder_ / "out"}, folder_);
  program.Write("# nothing yet\n");
  ASSERT_TRUE(Listens(program, "-"));
  program.Signal(SIGUSR1);
  ASSERT_TRUE(ComesTrue([&] { return Contains(program.Err(), "no map so far: -: "); }))
      << program.Err();
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  program.Write(text_);
  EXPECT_EQ(program.End(), 0) << program.Err();
  LiveProgram empty({"map", "-", "-o", folder_ / "none"}, folder_);
  EXPECT_EQ(empty.End(), 2);
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(MapSoFar, FlagsThatNeedALogThatComesLive) {
  ExpectUsersFault(folder_, {"map", log_, "-o", folder_ / "out", "--every", "1"}, "--every");
  ExpectUsersFault(folder_, {"map", "-o", folder_ / "out"}, "--follow");
  ExpectUsersFault(folder_, {"map", log_, "--follow", log_, "-o", folder_ / "out"},
                   "one of the two");
  ExpectUsersFault(folder_, {"map", "--follow", folder_ / "none", "-o", folder_ / "out"},
                   "No such file");
  ExpectUsersFault(folder_, {"map", "--follow", log_, "-o", folder_ / "out", "--every", "-1"},
                   "--every");
}

// A file that gets shorter is no log that grows; what is there by then stays.
TEST_F(MapSoFar, StaysWhenTheFileGetsShorter) {
  LiveProgram program({"map", "--follow", log_, "-o", folder_ / "out"}, folder_);
  ASSERT_TRUE(Listens(program, log_));
  ASSERT_TRUE(IsWritten(program)) << program.Err();
  fs::resize_file(log_, 1000);
  EXPECT_EQ(program.End(), 2);
  EXPECT_TRUE(Contains(program.Err(), "got shorter")) << program.Err();
  EXPECT_TRUE(Contains(program.Err(), "the map so far stays in")) << program.Err();
  EXPECT_EQ(RunProgram({"info", folder_ / "out"}).code, 0);
}

}  // namespace
}  // namespace masked_mapper
