// SPDX-License-Identifier: BSD-3-Clause
// `evaluate` from outside, and by it, what `map` makes of real logs.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

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

std::string SharedPath(const std::string& file) { return MASKED_MAPPER_REAL_LOGS "/" + file; }

std::string OutputOf(const std::string& command) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) {
    output.append(buffer, got);
  }
  pclose(pipe);
  return output;
}

/// Mean, deviation and median, of metres and of degrees, as they are printed.
std::vector<std::string> PrintedErrors(const std::string& text) {
  const std::regex pattern(R"(([0-9.]+) \+- ([0-9.]+) (m|deg) \(median ([0-9.]+))");
  std::vector<std::string> errors;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
    for (const std::size_t group : {1U, 2U, 3U, 4U}) errors.push_back((*it)[group]);
  }
  return errors;
}

TEST(EvaluateCommand, AgreesWithAnotherProgramToAllPrintedDigits) {
  const std::string tool = SharedPath("tools/relations_error.py");
  if (!fs::exists(tool)) GTEST_SKIP() << tool << " is not there";
  for (const std::string log : {"aces", "fr079"}) {
    const std::string path = SharedPath("data/" + log + ".clf.gz");
    const std::string relations = SharedPath("data/" + log + ".relations");
    if (!fs::exists(path) || !fs::exists(relations)) GTEST_SKIP() << path << " is not there";
    const ScratchFolder folder;
    const std::string out = folder / "out";
    ASSERT_EQ(RunProgram({"map", path, "-o", out, "--quiet"}).code, 0);
    const Ran ran = RunProgram({"evaluate", out, "--relations", relations});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::vector<std::string> ours = PrintedErrors(ran.out);
    ASSERT_EQ(ours.size(), 8U) << ran.out;
    EXPECT_EQ(ours, PrintedErrors(OutputOf("/usr/bin/python3 '" + tool + "' '" + out +
                                           "/trajectory.tum' '" + relations + "'")))
        << log;
  }
}

TEST(EvaluateCommand, CsailLiesOnItsReference) {
  const std::string log = SharedPath("data/mit-csail.clf.gz");
  const std::string reference = SharedPath("data/mit-csail.reference.txt");
  if (!fs::exists(log) || !fs::exists(reference)) GTEST_SKIP() << log << " is not there";
  const ScratchFolder folder;
  ASSERT_EQ(RunProgram({"map", log, "-o", folder / "out", "--quiet"}).code, 0);
  const Ran ran = RunProgram({"evaluate", folder / "out", "--truth", reference, "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_GE(json.at("trajectory").at("paired"), 400);
  EXPECT_LE(json.at("trajectory").at("aligned").at("mean_m"), 0.10);
  EXPECT_EQ(json.at("closures").at("false"), 0);
}

struct RelationsMean {
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};

RelationsMean MeanErrorOf(const std::string& map, const std::string& relations) {
  const Ran ran = RunProgram({"evaluate", map, "--relations", relations, "--json"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out).at("relations");
  EXPECT_EQ(json.at("used"), json.at("count"));
  return {json.at("translation_m").at("mean"), json.at("rotation_deg").at("mean")};
}

struct CutCase {
  const char* source;  ///< what tells floors apart
  const char* view;    ///< what the scanner sees on a ride
};
void PrintTo(const CutCase& cut, std::ostream* out) { *out << cut.source << '_' << cut.view; }

/// ACES, cut in two by a ride up, a drive through FR079, and a ride back.
class CutLog : public ::testing::TestWithParam<CutCase> {};

TEST_P(CutLog, IsTwoFloorsAndTheHalvesOfTheFirstFit) {
  const std::string aces = SharedPath("data/aces");
  const std::string other = SharedPath("data/fr079");
  for (const std::string& file : {aces + ".clf.gz", other + ".clf.gz"}) {
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
  }
  const ScratchFolder folder;
  const std::string command =
      "/usr/bin/python3 '" MASKED_MAPPER_SOURCE_DIR "/tests/apps/write_cut_log.py' '" + aces +
      ".clf.gz' '" + aces + ".relations' '" + other + ".clf.gz' '" + other + ".reference.txt' '" +
      folder / "" + "' " + GetParam().source + " " + GetParam().view;
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string out = folder / "out";
  const Ran ran = RunProgram({"map", folder / "cut.log", "-o", out, "--quiet"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto floors = nlohmann::json::parse(ReadText(out + "/summary.json")).at("floors");
  ASSERT_EQ(floors.size(), 2U);
  EXPECT_EQ(floors[0].at("label"), "0");
  EXPECT_EQ(floors[1].at("label"), "1");
  if (std::string(GetParam().source) != "floor") {
    EXPECT_NEAR(floors[1].at("elevation_m"), 4.0, 0.3);
  }
  for (const char* half : {"before.relations", "after.relations"}) {
    const RelationsMean error = MeanErrorOf(out, folder / half);
    EXPECT_LT(error.translation_m, 0.05) << half;
    EXPECT_LT(error.rotation_deg, 0.5) << half;
  }
  // Those that cross the cut span hundreds of seconds: 0.07 m and 0.6 deg in the log as it is.
  const RelationsMean across = MeanErrorOf(out, folder / "across.relations");
  EXPECT_LT(across.translation_m, 0.10);
  EXPECT_LT(across.rotation_deg, 0.8);
}

INSTANTIATE_TEST_SUITE_P(EvaluateCommand, CutLog,
                         ::testing::Values(CutCase{"pressure", "cab"}, CutCase{"accel", "cab"},
                                           CutCase{"floor", "silent"},
                                           CutCase{"pressure", "silent"}),
                         [](const ::testing::TestParamInfo<CutCase>& info) {
                           return std::string(info.param.source) + "_" + info.param.view;
                         });

/// Mapped by lidar and wheels alone, with `said` among what `map` says.
void ExpectRightFloorsByScans(const std::string& building, const std::string& seed,
                              const std::string& said) {
  const ScratchFolder folder;
  const std::string log = folder / "drive.log";
  ASSERT_EQ(RunProgram({"simulate", "--building", building, "--seed", seed, "-o", log, "--quiet",
                        "--without-pressure"})
                .code,
            0);
  const Ran mapped = RunProgram({"map", log, "-o", folder / "out"});
  ASSERT_EQ(mapped.code, 0) << mapped.err;
  EXPECT_TRUE(Contains(mapped.err, said)) << mapped.err;
  const Ran evaluated =
      RunProgram({"evaluate", folder / "out", "--truth", folder / "drive.log.truth.tum", "--json"});
  ASSERT_EQ(evaluated.code, 0) << evaluated.err;
  const nlohmann::json json = nlohmann::json::parse(evaluated.out);
  EXPECT_EQ(json.at("floors").at("right"), 1.0);
  EXPECT_EQ(json.at("closures").at("false"), 0);
  EXPECT_LT(json.at("trajectory").at("max_m"), 0.2) << "m";
}

TEST(EvaluateCommand, ByLidarAndWheelsAloneAFloorMetAgainIsOneFloor) {
  ExpectRightFloorsByScans("office", "1", "floor 0 was met again");
}

// Three floors of one plan, tied by stairs: what parts them are the walls that would have been
// driven through.
TEST(EvaluateCommand, ByLidarAndWheelsAloneStairsBetweenFloorsOfOnePlanAreFound) {
  ExpectRightFloorsByScans("random", "22", "is taken for one to another floor");
}

}  // namespace
}  // namespace masked_mapper
