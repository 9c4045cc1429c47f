// SPDX-License-Identifier: BSD-3-Clause
// `export --clouds` from outside: a map alone tells of space what its log told.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// A drive up and down a hall with some furniture, by its clouds, in `folder`/`name`.mcap.
std::string SimulateHall(const ScratchFolder& folder, const std::string& name,
                         const std::string& tour) {
  WriteText(folder / "hall.txt",
            "building hall\nfloor 0 0\nwall -2 -3 12 -3 12 3 8 3 8 4 6 4 6 3 -2 3 -2 -3\n"
            "box 3 2 20 1 0.5\nbox 7 -2 0 0.5 0.5\npoint a 0 0\npoint b 10 0\ncorridor a b\n");
  const std::string log = folder / (name + ".mcap");
  const Ran ran = RunProgram({"simulate", "--building", folder / "hall.txt", "--lidar", "vlp16",
                              "--lidar-rate", "2", "--tour", tour, "-o", log, "--quiet"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  return log;
}

void ExpectDone(const std::vector<std::string>& arguments) {
  const Ran ran = RunProgram(arguments);
  EXPECT_EQ(ran.code, 0) << ran.err;
}

std::size_t KeptCloudsOf(const std::string& map) {
  const Ran ran = RunProgram({"info", map, "--json"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  return nlohmann::json::parse(ran.out).at("counts").at("kept_clouds");
}

using Cell = std::array<int, 3>;

/// Cells of 10 cm in which points of a PLY lie.
std::set<Cell> CellsOf(const std::string& ply) {
  const std::string bytes = ReadText(ply);
  constexpr std::size_t kPoint = 12 + 3 + 4 + 4;
  std::set<Cell> cells;
  for (std::size_t at = bytes.find("end_header\n") + 11; at + kPoint <= bytes.size();
       at += kPoint) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), bytes.data() + at, sizeof(p));
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<int>(std::floor(p[axis] / 0.1F));
    }
    cells.insert(cell);
  }
  return cells;
}

/// Share of the cells that the others have, too, or one of their neighbours.
double ShareIn(const std::set<Cell>& cells, const std::set<Cell>& others) {
  const auto is_near = [&others](const Cell& cell) {
    for (int i = 0; i < 27; ++i) {
      if (others.count({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1}) > 0) {
        return true;
      }
    }
    return false;
  };
  return static_cast<double>(std::count_if(cells.begin(), cells.end(), is_near)) /
         static_cast<double>(cells.size());
}

TEST(ExportSpace, TheMapAloneTellsWhatTheLogTold) {
  const ScratchFolder folder;
  const std::string log = SimulateHall(folder, "hall", "1");
  const std::string out = folder / "out";
  ExpectDone({"map", log, "-o", out, "--quiet"});
  EXPECT_GT(KeptCloudsOf(out), 20U);
  ExpectDone({"export", out, "--format", "ply", "--clouds", log, "-o", folder / "log.ply"});
  ExpectDone({"map", log, "-o", out, "--resume"});
  fs::remove(log);
  ExpectDone({"export", out, "--format", "ply", "--clouds", "-o", folder / "map.ply"});
  const std::set<Cell> of_log = CellsOf(folder / "log.ply");
  const std::set<Cell> of_map = CellsOf(folder / "map.ply");
  EXPECT_GT(ShareIn(of_map, of_log), 0.99);
  EXPECT_GT(ShareIn(of_log, of_map), 0.97);
  for (const std::vector<std::string>& format : std::vector<std::vector<std::string>>{
           {"las"}, {"pcd", "--clouds"}, {"octomap", "--clouds"}, {"grid", "--clouds"}}) {
    std::vector<std::string> arguments = {"export", out, "-o", folder / ("a." + format[0]),
                                          "--format"};
    arguments.insert(arguments.end(), format.begin(), format.end());
    ExpectDone(arguments);
  }
  EXPECT_TRUE(fs::exists(folder / "a.octomap"));
  ExpectDone({"export", out, "--format", "all", "-o", folder / "again"});
  EXPECT_TRUE(ReadText(out + "/building.mmap") == ReadText(folder / "again/building.mmap"));
}

TEST(ExportSpace, JoinedMapsKeepTheCloudsOfAll) {
  const ScratchFolder folder;
  const std::string first = SimulateHall(folder, "first", "1");
  const std::string second = SimulateHall(folder, "second", "2");
  ExpectDone({"map", first, "-o", folder / "one", "--quiet"});
  ExpectDone({"map", second, "-o", folder / "two", "--quiet"});
  ExpectDone({"map", second, "--onto", folder / "one", "-o", folder / "grown", "--quiet"});
  ExpectDone({"map", first, second, "-o", folder / "both", "--quiet"});
  const std::size_t all = KeptCloudsOf(folder / "one") + KeptCloudsOf(folder / "two");
  EXPECT_EQ(KeptCloudsOf(folder / "grown"), all);
  EXPECT_EQ(KeptCloudsOf(folder / "both"), all);
}

TEST(ExportSpace, AMapWithoutCloudsSaysSo) {
  const ScratchFolder folder;
  WriteText(folder / "ring.log", Joined(RingLog(1)));
  ExpectDone({"map", folder / "ring.log", "-o", folder / "out", "--quiet"});
  ExpectUsersFault(folder,
                   {"export", folder / "out", "--format", "pcd", "--clouds", "-o", folder / "x"},
                   "keeps no clouds");
  ExpectUsersFault(folder, {"export", folder / "out", "--format", "las", "-o", folder / "x"},
                   "keeps no clouds");
}

}  // namespace
}  // namespace masked_mapper
