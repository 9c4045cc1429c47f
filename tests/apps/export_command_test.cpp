// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// A map of the ring in `folder`/out.
void MapRing(const ScratchFolder& folder) {
  WriteText(folder / "ring.log", Joined(RingLog(2)));
  const Ran ran = RunProgram({"map", folder / "ring.log", "-o", folder / "out", "--set",
                              "nodes.min_edge_length_m=2", "--quiet"});
  ASSERT_EQ(ran.code, 0) << ran.err;
}

TEST(ExportCommand, WritesWhatMapWroteWithoutTheLog) {
  const ScratchFolder folder;
  MapRing(folder);
  fs::remove(folder / "ring.log");
  for (const auto& [format, name] :
       std::vector<std::pair<std::string, std::string>>{{"octomap", "building.bt"},
                                                        {"pcd", "building.pcd"},
                                                        {"ply", "building.ply"},
                                                        {"tum", "trajectory.tum"},
                                                        {"g2o", "graph.g2o"},
                                                        {"grid", "floors/0.pgm"}}) {
    const std::string file = folder / fs::path(name).filename().string();
    const Ran ran = RunProgram(
        {"export", folder / "out/building.mmap", "--format", format, "-o", file, "--floor", "0"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(ReadText(file) == ReadText(folder / ("out/" + name))) << name;
  }
  EXPECT_EQ(ReadText(folder / "0.yaml"), ReadText(folder / "out/floors/0.yaml"));
  // Nothing of what was written aside stays.
  for (const std::string& name : folder.Listing()) {
    EXPECT_EQ(name.find("partial"), std::string::npos) << name;
  }
}

TEST(ExportCommand, ResolutionMakesItCoarser) {
  const ScratchFolder folder;
  MapRing(folder);
  const Ran ran = RunProgram({"export", folder / "out", "--format", "octomap", "-o",
                              folder / "coarse.bt", "--resolution", "0.2"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_LT(fs::file_size(folder / "coarse.bt"), fs::file_size(folder / "out/building.bt") / 2);
}

TEST(ExportCommand, TheUsersFaultsAreOneLine) {
  const ScratchFolder folder;
  MapRing(folder);
  fs::create_directory(folder / "empty");
  const std::string out = folder / "out";
  const std::string file = folder / "x";
  const std::vector<std::string> before = folder.Listing();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"export", out, "--format", "dxf", "-o", file},
           {"export", out, "--format", "pcd", "-o", file, "--floor", "9"},
           {"export", out, "--format", "pcd", "-o", folder / "empty"},
           {"export", out, "--format", "pcd", "-o", folder / "missing/x"},
           {"export", out, "--format", "pcd", "-o", file, "--resolution", "7"},
           {"export", out, "--format", "tum", "-o", file, "--zmin", "0"},
           {"export", out, "--format", "pcd", "-o", file, "--zmin", "2", "--zmax", "1"},
           {"export", out, "--format", "pcd", "-o", file, "--zmin", "nan"},
           {"export", out, "--format", "pcd"},
           {"export", folder / "empty", "--format", "pcd", "-o", file},
           {"export", folder / "missing", "--format", "pcd", "-o", file},
           {"export", folder / "ring.log", "--format", "pcd", "-o", file}}) {
    const Ran ran = RunProgram(arguments);
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_EQ(LinesIn(ran.err), 1) << ran.err;
  }
  EXPECT_EQ(folder.Listing(), before);
}

TEST(ExportCommand, AllOfItIsWhatMapWrote) {
  const ScratchFolder folder;
  MapRing(folder);
  const std::vector<std::string> all = {"export", folder / "out", "--format",
                                        "all",    "-o",           folder / "again"};
  ASSERT_EQ(RunProgram(all).code, 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) {
    const std::string name = entry.path().lexically_relative(folder / "out").string();
    if (entry.is_directory() || name == "summary.json" || name == "report.html") continue;
    EXPECT_TRUE(ReadText(entry.path().string()) == ReadText(folder / ("again/" + name))) << name;
  }
  EXPECT_EQ(RunProgram(all).code, 2);  // it is there already
}

TEST(ExportCommand, EditsMendTheMap) {
  const ScratchFolder folder;
  MapRing(folder);
  WriteText(folder / "edits.yaml", "- name_floor: {floor: \"0\", name: ground}\n");
  const Ran ran = RunProgram({"export", folder / "out", "--format", "all", "-o", folder / "mended",
                              "--edits", folder / "edits.yaml"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ReadText(folder / "mended/floors/ground.pgm"), ReadText(folder / "out/floors/0.pgm"));
  EXPECT_EQ(ReadText(folder / "mended/trajectory.tum"), ReadText(folder / "out/trajectory.tum"));
  const Ran mapped = RunProgram({"map", folder / "ring.log", "-o", folder / "mapped", "--set",
                                 "nodes.min_edge_length_m=2", "--edits", folder / "edits.yaml"});
  ASSERT_EQ(mapped.code, 0) << mapped.err;
  EXPECT_TRUE(ReadText(folder / "mapped/building.mmap") ==
              ReadText(folder / "mended/building.mmap"));
  WriteText(folder / "edits.yaml", "\n- name_floor: {floor: 7, name: ground}\n");
  const Ran failed = RunProgram({"export", folder / "out", "--format", "pcd", "-o", folder / "x",
                                 "--edits", folder / "edits.yaml"});
  EXPECT_EQ(failed.code, 2);
  EXPECT_TRUE(Contains(failed.err, "edits.yaml:2: ")) << failed.err;
}

TEST(ExportCommand, InfoTellsOfTheMap) {
  const ScratchFolder folder;
  MapRing(folder);
  const Ran words = RunProgram({"info", folder / "out"});
  ASSERT_EQ(words.code, 0) << words.err;
  EXPECT_NE(words.out.find("floor 0"), std::string::npos) << words.out;
  const auto summary = nlohmann::json::parse(ReadText(folder / "out/summary.json"));
  for (const std::string& map : {folder / "out", folder / "out/building.mmap"}) {
    const Ran ran = RunProgram({"info", map, "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto info = nlohmann::json::parse(ran.out);
    EXPECT_EQ(info.at("log"), folder / "ring.log");
    EXPECT_EQ(info.at("mask"), "openings");
    EXPECT_EQ(info.at("counts").at("nodes"), summary.at("counts").at("nodes"));
    EXPECT_EQ(info.at("counts").at("validated"), summary.at("counts").at("validated"));
    EXPECT_EQ(info.at("floors").at(0).at("nodes"), summary.at("floors").at(0).at("nodes"));
    EXPECT_NEAR(info.at("floors").at(0).at("area_m2"), summary.at("floors").at(0).at("area_m2"),
                0.01);
    EXPECT_EQ(info.at("changed_options").at("nodes.min_edge_length_m"), "2");
  }
  fs::resize_file(folder / "out/building.mmap", 5000);
  const Ran damaged = RunProgram({"info", folder / "out"});
  EXPECT_EQ(damaged.code, 2);
  EXPECT_EQ(LinesIn(damaged.err), 1) << damaged.err;
}

}  // namespace
}  // namespace masked_mapper
