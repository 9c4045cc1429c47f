// SPDX-License-Identifier: BSD-3-Clause
// `map` from outside: what it writes, what it refuses, and what it makes of real life.
#include <gtest/gtest.h>
#include <zlib.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "apps/bad_logs.hpp"
#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

std::string Gzipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

const std::vector<std::string>& Ring() {
  static const std::vector<std::string> lines = RingLog(1);
  return lines;
}

TEST(MapCommand, HelpListsEveryOption) {
  const Ran help = RunProgram({"map", "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_TRUE(Contains(help.out, "openings")) << help.out;
  const Ran options = RunProgram({"map", "--help-options"});
  EXPECT_EQ(options.code, 0);
  EXPECT_TRUE(Contains(options.out, "min_score: 0.425"));
}

TEST(MapCommand, MistypedFlagsMasksAndOptions) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  const std::string log = folder / "ring.log";
  const std::string out = folder / "out";
  ExpectUsersFault(folder, {"map", log}, "--output is required");
  ExpectUsersFault(folder, {"map", "-o", out}, "LOG is required");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--thread", "2"},
                   "unknown flag `--thread` (did you mean `--threads`?)");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--mask", "openingz"},
                   "did you mean `openings`?");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--mask", "any(openings"}, "mask expression");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--set", "matcher.min_scor=0.5"},
                   "did you mean `matcher.min_score`?");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--set", "matcher.min_score=5"},
                   "matcher.min_score must be 0 to 1");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--set", "nodes.min_edge_length_m=20"},
                   "must not be above nodes.max_edge_length_m");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--threads", "many"}, "--threads");
  ExpectUsersFault(folder, {"map", log, "-o", out, "--threads", "-1"}, "--threads");
}

TEST(MapCommand, ConfigurationsThatAreWrong) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  const auto expect = [&](const std::string& text, const std::string& said) {
    const std::string file = folder / "my.yaml";
    WriteText(file, text);
    ExpectUsersFault(folder, {"map", folder / "ring.log", "-o", folder / "out", "--config", file},
                     said);
  };
  expect("matcher: {min_score: 0.5", "my.yaml:");
  expect("matcher:\n  min_scor: 0.5\n", "my.yaml:2: unknown option `matcher.min_scor`");
  expect("matcher:\n  min_score: 7\n", "my.yaml:2: matcher.min_score must be 0 to 1");
  ExpectUsersFault(
      folder, {"map", folder / "ring.log", "-o", folder / "out", "--config", folder / "no.yaml"},
      "no such configuration file");
}

TEST(MapCommand, LogsThatAreNone) {
  const ScratchFolder folder;
  for (const auto& [name, said] : WriteLogsThatAreNone(folder)) {
    ExpectUsersFault(folder, {"map", folder / name, "-o", folder / "out"}, said);
  }
  const std::string endless(300, 'a');
  ExpectUsersFault(folder, {"map", folder / endless, "-o", folder / "out"}, "File name too long");
}

TEST(MapCommand, LogsWithoutOneValidScanAreTheUsersFault) {
  const ScratchFolder folder;
  WriteText(folder / "odometry.log",
            "ODOM 0 0 0 0 0 0 1.0 robot 1.0\nODOM 1 0 0 0 0 0 2.0 robot 2.0\n");
  ExpectUsersFault(folder, {"map", folder / "odometry.log", "-o", folder / "out"}, "odometry.log");
  WriteText(folder / "broken.log", "FLASER 3 1.0 2.0\nFLASER x\n");
  ExpectUsersFault(folder, {"map", folder / "broken.log", "-o", folder / "out"}, "broken.log");
}

TEST(MapCommand, FloorsFromAFile) {
  const ScratchFolder folder;
  const std::vector<Pose2> drive = RingDrive(1);
  const double last = 100.0 + 0.2 * static_cast<double>(drive.size() - 1);
  std::vector<std::string> lines = Ring();
  lines.push_back("FLOOR log_says_so 100.0 robot 0.0");
  WriteText(folder / "ring.log", Joined(lines));
  const std::string log = folder / "ring.log";
  const std::string out = folder / "out";
  WriteText(folder / "floors.csv", "t,label\n100,EG\n" + std::to_string(last - 20.0) + ",OG\n");
  const Ran ran = RunProgram({"map", log, "-o", out, "--floors", folder / "floors.csv"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(fs::exists(out + "/floors/EG.pgm"));
  EXPECT_TRUE(fs::exists(out + "/floors/OG.pgm"));
  EXPECT_FALSE(fs::exists(out + "/floors/log_says_so.pgm"));
  const auto summary = nlohmann::json::parse(ReadText(out + "/summary.json"));
  EXPECT_EQ(summary.at("options").at("floors.file"), folder / "floors.csv");

  const std::string other = folder / "other";
  const auto expect = [&](const std::string& text, const std::string& said) {
    WriteText(folder / "wrong.csv", text);
    ExpectUsersFault(folder, {"map", log, "-o", other, "--floors", folder / "wrong.csv"}, said);
  };
  expect("", "no line says a floor");
  expect("t,label\n100,EG\nnoon,OG\n", "wrong.csv:3: expected `t,label`");
  expect("100,EG\n110,a/b\n", "wrong.csv:2: a label");
  expect("110,EG\n100,OG\n", "wrong.csv:2: the stamp steps back");
  expect("1,EG\n2,OG\n", "wrong.csv: no label falls into the time of the log");
  expect(std::string("\0\x01\x02", 3), "wrong.csv:1:");
  ExpectUsersFault(folder, {"map", log, "-o", other, "--floors", folder / "none.csv"}, "none.csv");
  ExpectUsersFault(folder,
                   {"map", log, "-o", other, "--floors", folder / "floors.csv", "--set",
                    "floors.source=pressure"},
                   "floors.source");
}

TEST(MapCommand, AnExistingOutputIsNotReplacedUnasked) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  const std::string log = folder / "ring.log";
  const std::string out = folder / "out";
  fs::create_directory(out);
  WriteText(out + "/mine.txt", "mine");
  ExpectUsersFault(folder, {"map", log, "-o", out}, "--force");
  EXPECT_EQ(RunProgram({"map", log, "-o", out, "--force"}).code, 0);
  EXPECT_TRUE(fs::exists(out + "/summary.json"));
  EXPECT_EQ(ReadText(out + "/mine.txt"), "mine");
  WriteText(folder / "file", "");
  ExpectUsersFault(folder, {"map", log, "-o", folder / "file", "--force"}, "not a folder");
}

TEST(MapCommand, ResumeWithoutAnythingToResumeStartsAfresh) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  fs::create_directory(folder / "empty");
  for (const char* out : {"missing", "empty"}) {
    const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / out, "--resume"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(fs::exists(folder / out + "/summary.json"));
  }
  // A finished map is not gone on with; one that was asked for otherwise is not replaced either.
  const std::string summary = ReadText(folder / "missing/summary.json");
  const std::vector<std::string> again = {"map", folder / "ring.log", "-o", folder / "missing",
                                          "--resume"};
  const Ran ran = RunProgram(again);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(Contains(ran.out, "finished already")) << ran.out;
  EXPECT_EQ(ReadText(folder / "missing/summary.json"), summary);
  std::vector<std::string> otherwise = again;
  otherwise.insert(otherwise.end(), {"--mask", "always"});
  ExpectUsersFault(folder, otherwise, "mask was openings, now it is always");
}

TEST(MapCommand, SettingsWinOverTheConfigurationAndTheConfigurationOverDefaults) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  WriteText(folder / "my.yaml", "matcher: {min_score: 0.5, max_window_m: 5.5}\n");
  const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / "out", "--set",
                              "matcher.min_score=0.6", "--config", folder / "my.yaml"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto summary = nlohmann::json::parse(ReadText(folder / "out/summary.json"));
  EXPECT_EQ(summary.at("options").at("matcher.min_score"), 0.6);
  EXPECT_EQ(summary.at("options").at("matcher.max_window_m"), 5.5);
}

TEST(MapCommand, AnInterruptLeavesNothing) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(20)));
  const std::vector<std::string> before = folder.Listing();
  RunSettings settings;
  settings.interrupt = true;
  const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / "out", "--mask", "always",
                              "--checkpoint", "3600"},
                             settings);
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "interrupted")) << ran.err;
  EXPECT_EQ(folder.Listing(), before);
}

TEST(MapCommand, AKilledRunGoesOnToTheSameBytes) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(12)));
  const std::string out = folder / "out";
  std::vector<std::string> map = {"map",    folder / "ring.log", "-o",      out, "--mask",
                                  "always", "--checkpoint",      "0.000001"};
  ASSERT_EQ(
      RunProgram({"map", folder / "ring.log", "-o", folder / "whole", "--mask", "always"}).code, 0);
  map.emplace_back("--resume");
  RunSettings settings;
  int killed = 0;
  for (const int milliseconds : {40, 80, 120, 160, 200}) {
    settings.kill_after_ms = milliseconds;
    killed += RunProgram(map, settings).code == -1 ? 1 : 0;
  }
  EXPECT_GT(killed, 0);
  // A kill may leave a file in which nothing is said yet; an interrupt leaves a checkpoint.
  settings = RunSettings();
  settings.interrupt = true;
  RunProgram(map, settings);
  if (fs::exists(folder / ".out.unfinished/checkpoint.mmck")) {
    // What was done is not thrown away unasked, nor for other wishes.
    std::vector<std::string> afresh(map.begin(), map.end() - 1);
    ExpectUsersFault(folder, afresh, "--resume");
    std::vector<std::string> otherwise = map;
    otherwise.insert(otherwise.end(), {"--set", "matcher.min_score=0.5"});
    const Ran refused = RunProgram(otherwise);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(Contains(refused.err, "matcher.min_score was 0.425, now it is 0.5")) << refused.err;
  }
  const Ran ran = RunProgram(map);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_FALSE(fs::exists(folder / ".out.unfinished"));
  for (const auto& entry : fs::recursive_directory_iterator(folder / "whole")) {
    const std::string name = entry.path().lexically_relative(folder / "whole").string();
    if (entry.is_directory() || name == "summary.json" || name == "report.html") continue;
    EXPECT_TRUE(ReadText(entry.path().string()) == ReadText(out + "/" + name)) << name;
  }
}

TEST(MapCommand, AnInterruptKeepsWhatIsDone) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(20)));
  const std::vector<std::string> map = {
      "map",    folder / "ring.log", "-o",      folder / "out", "--mask",
      "always", "--checkpoint",      "0.000001"};
  RunSettings settings;
  settings.interrupt = true;
  const Ran ran = RunProgram(map, settings);
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_TRUE(Contains(ran.err, "--resume goes on")) << ran.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_TRUE(fs::exists(folder / ".out.unfinished/checkpoint.mmck"));
  // Afresh, when that is wanted.
  std::vector<std::string> afresh = map;
  afresh.emplace_back("--force");
  EXPECT_EQ(RunProgram(afresh).code, 0);
  EXPECT_FALSE(fs::exists(folder / ".out.unfinished"));
}

TEST(MapCommand, MapWritesTheContract) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log.gz", Gzipped(Joined(RingLog(2))));
  const std::string out = folder / "out";
  // With one thread stages follow each other.
  const Ran ran = RunProgram({"map", folder / "ring.log.gz", "-o", out, "--threads", "1"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  for (const char* name :
       {"building.mmap", "building.bt", "building.pcd", "building.ply", "floors/0.pcd",
        "floors/0.pgm", "floors/0.yaml", "floors/0.g2o", "trajectory.tum", "nodes.tum", "graph.g2o",
        "closures.csv", "summary.json", "report.html"}) {
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
  }
  EXPECT_EQ(ReadText(out + "/closures.csv")
                .rfind("t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason\n", 0),
            0U);
  const auto summary = nlohmann::json::parse(ReadText(out + "/summary.json"));
  EXPECT_EQ(summary.at("log"), folder / "ring.log.gz");
  EXPECT_EQ(summary.at("mask"), "openings");
  double stages = 0.0;
  for (const auto& [stage, seconds] : summary.at("seconds").items()) {
    if (stage != "total") stages += seconds.get<double>();
  }
  const double total = summary.at("seconds").at("total");
  EXPECT_LE(stages, total + 0.01);  // no stage is counted twice
  EXPECT_GT(stages, 0.5 * total);   // and little is in none
  EXPECT_EQ(summary.at("counts").at("scans"), static_cast<int>(RingDrive(2).size()));
  EXPECT_EQ(summary.at("options").at("matcher.min_score"), 0.425);
  EXPECT_EQ(LinesIn(ReadText(out + "/trajectory.tum")), static_cast<long>(RingDrive(2).size()));
  EXPECT_TRUE(Contains(ran.out, "validated"));  // the closing table
  EXPECT_TRUE(Contains(ran.err, "mapping"));
}

TEST(MapCommand, QuietIsSilent) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / "out", "--quiet"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.out + ran.err, "");
  const Ran failed = RunProgram({"map", folder / "ring.log", "-o", folder / "out", "--quiet"});
  EXPECT_EQ(failed.code, 2);
  EXPECT_EQ(LinesIn(failed.err), 1);
}

TEST(MapCommand, ATerminalGetsABarAndAPipeDoesNot) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(4)));
  const std::vector<std::string> arguments = {
      "map", folder / "ring.log", "-o", folder / "out", "--force", "--mask", "always"};
  const Ran plain = RunProgram(arguments);
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_FALSE(Contains(plain.err, "\r"));
  if (!HasPseudoTerminals()) GTEST_SKIP() << "no pseudo-terminal can be had here (/dev/pts)";
  RunSettings settings;
  settings.terminal = true;
  const Ran seen = RunProgram(arguments, settings);
  ASSERT_EQ(seen.code, 0) << seen.err;
  EXPECT_TRUE(Contains(seen.err, "scans/s")) << seen.err;
}

TEST(MapCommand, TheSameBytesAtAnyNumberOfThreads) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(2)));
  const std::vector<std::vector<std::string>> runs = {
      {"a"}, {"b"}, {"c", "--threads", "1"}, {"d", "--threads", "2"}};
  for (const auto& run : runs) {
    std::vector<std::string> arguments = {"map", folder / "ring.log", "-o", folder / run[0]};
    arguments.insert(arguments.end(), run.begin() + 1, run.end());
    const Ran ran = RunProgram(arguments);
    ASSERT_EQ(ran.code, 0) << ran.err;
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder / "a")) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = entry.path().lexically_relative(folder / "a");
    for (const char* other : {"b", "c", "d"}) {
      std::string first = ReadText(entry.path());
      std::string second = ReadText(fs::path(folder / other) / name);
      if (name == "summary.json") {
        for (std::string* text : {&first, &second}) {
          auto json = nlohmann::json::parse(*text);
          EXPECT_EQ(json.erase("seconds") + json.erase("peak_memory_mib"), 2U);
          *text = json.dump();
        }
      }
      if (name == "report.html") {  // which shows the summary
        for (std::string* text : {&first, &second}) {
          const std::size_t seconds = text->find("\n  \"seconds\": {");
          const std::size_t options = text->find("\n  \"options\": {");
          ASSERT_TRUE(seconds < options && options != std::string::npos);
          text->erase(seconds, options - seconds);
        }
      }
      EXPECT_TRUE(first == second) << name << " differs in " << other;
    }
  }
}

struct LifeCase {
  const char* name;
  std::function<std::string(std::vector<std::string>)> spoil;
  const char* said;  ///< in what the program prints
};
void PrintTo(const LifeCase& life, std::ostream* out) { *out << life.name; }

class RealLife : public ::testing::TestWithParam<LifeCase> {};

TEST_P(RealLife, IsSkippedCountedAndSaid) {
  const ScratchFolder folder;
  WriteText(folder / "life.log", GetParam().spoil(Ring()));
  const Ran ran = RunProgram({"map", folder / "life.log", "-o", folder / "out"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(Contains(ran.err, GetParam().said)) << ran.err;
  EXPECT_TRUE(fs::exists(folder / "out/summary.json"));
}

INSTANTIATE_TEST_SUITE_P(
    MapCommand, RealLife,
    ::testing::Values(LifeCase{"CountThatDoesNotMatch",
                               [](std::vector<std::string> lines) {
                                 lines[20].replace(0, 10, "FLASER 182");
                                 return Joined(lines);
                               },
                               "1 bad line"},
                      LifeCase{"NotANumber",
                               [](std::vector<std::string> lines) {
                                 lines[20].replace(11, 3, "nan");
                                 lines[21] = "ODOM nan inf 1e400 0 0 0 104.1 robot 4.1";
                                 return Joined(lines);
                               },
                               "bad line"},
                      LifeCase{"HugeNumbers",
                               [](std::vector<std::string> lines) {
                                 lines[20] = "FLASER 99999999999 1 2 3";
                                 lines[21] = "ODOM 1e300 -1e300 1e300 0 0 0 104.1 robot 4.1";
                                 return Joined(lines);
                               },
                               "bad line"},
                      LifeCase{"CutLastLine",
                               [](const std::vector<std::string>& lines) {
                                 const std::string text = Joined(lines);
                                 return text.substr(0, text.size() - 300);
                               },
                               "cut"},
                      LifeCase{"CutInsideGzip",
                               [](const std::vector<std::string>& lines) {
                                 const std::string packed = Gzipped(Joined(lines));
                                 return packed.substr(0, packed.size() * 2 / 3);
                               },
                               "cut"},
                      LifeCase{"StampsThatJump",
                               [](std::vector<std::string> lines) {
                                 for (std::size_t i = lines.size() / 2; i < lines.size(); ++i) {
                                   const std::size_t host = lines[i].rfind(" robot");
                                   const std::size_t stamp = lines[i].rfind(' ', host - 1);
                                   lines[i].replace(
                                       stamp, host - stamp,
                                       " " + std::to_string(5.0 + 0.2 * static_cast<double>(i)));
                                 }
                                 return Joined(lines);
                               },
                               "stamp"}),
    [](const ::testing::TestParamInfo<LifeCase>& info) { return info.param.name; });

TEST(MapCommand, AFullDiskIsAFailureThatLeavesNothing) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(Ring()));
  const std::vector<std::string> before = folder.Listing();
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{512}, rlim_t{4096}, rlim_t{20000}}) {
    RunSettings settings;
    settings.largest_file = bytes;
    const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / "out"}, settings);
    EXPECT_EQ(ran.code, 1) << bytes << " bytes: " << ran.err;
    EXPECT_TRUE(Contains(ran.err, "masked_mapper: ")) << ran.err;
    EXPECT_EQ(folder.Listing(), before) << bytes << " bytes";
  }
}

}  // namespace
}  // namespace masked_mapper
