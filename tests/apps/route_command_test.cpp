// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "apps/ring_log.hpp"

namespace masked_mapper {
namespace {

class RouteCommand : public testing::Test {
 protected:
  RouteCommand() {
    WriteText(folder_ / "ring.log", Joined(RingLog(2)));
    WriteText(folder_ / "edits.yaml",
              "- name_floor: {floor: \"0\", name: \"-1\"}\n"
              "- places: {start: [\"-1\", 0.0, 0.0]}\n");
    const Ran ran =
        RunProgram({"map", folder_ / "ring.log", "-o", folder_ / "out", "--edits",
                    folder_ / "edits.yaml", "--set", "nodes.min_edge_length_m=2", "--quiet"});
    EXPECT_EQ(ran.code, 0) << ran.err;
  }

  nlohmann::json Route(const std::string& from, const std::string& to) {
    const Ran ran =
        RunProgram({"route", folder_ / "out", "--from=" + from, "--to=" + to, "--json"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    return nlohmann::json::parse(ran.out);
  }

  ScratchFolder folder_;
};

TEST_F(RouteCommand, FindsAWayBetweenPlacesHoweverNamed) {
  const nlohmann::json way = Route("-1,0,0", "-1,3,0");
  EXPECT_TRUE(way.at("found").get<bool>());
  EXPECT_NEAR(way.at("length_m").get<double>(), 3.0, 0.2);
  ASSERT_EQ(way.at("legs").size(), 1U);
  EXPECT_EQ(way["legs"][0].at("floor"), "-1");
  EXPECT_GE(way["legs"][0].at("points").size(), 2U);
  EXPECT_EQ(way["legs"][0].at("length_m"), way.at("length_m"));
  EXPECT_TRUE(way.at("transits").empty());
  // The place that was named is kept in the map.
  EXPECT_EQ(Route("start", "-1,3,0").at("length_m"), way.at("length_m"));
  const Ran table =
      RunProgram({"route", folder_ / "out/building.mmap", "--from", "start", "--to=-1,3,0"});
  EXPECT_EQ(table.code, 0);
  EXPECT_TRUE(Contains(table.out, "floor -1")) << table.out;
}

TEST_F(RouteCommand, TheReportShowsTheWay) {
  const std::string out = folder_ / "out";
  const std::string page = folder_ / "way.html";
  const Ran ran = RunProgram({"route", out, "--from=-1,0,0", "--to=-1,3,0", "--report", page});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(Contains(ReadText(page), "\"route\":{\"length_m\":"));
  const std::string none = folder_ / "none.html";
  EXPECT_EQ(RunProgram({"route", out, "--from=-1,0,0", "--to=-1,500,0", "--report", none}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(none));
  ExpectUsersFault(folder_, {"route", out, "--from=-1,0,0", "--to=-1,3,0", "--report", out},
                   "is not a file");
}

TEST_F(RouteCommand, NoWayIsAnAnswer) {
  const nlohmann::json none = Route("start", "-1,500,0");
  EXPECT_FALSE(none.at("found").get<bool>());
  EXPECT_TRUE(none.at("length_m").is_null());
  EXPECT_TRUE(none.at("legs").empty());
  EXPECT_FALSE(none.at("reason").get<std::string>().empty());
  EXPECT_EQ(none.at("nearest").at("floor"), "-1");
  EXPECT_GT(none.at("nearest").at("distance_m").get<double>(), 400.0);
}

TEST_F(RouteCommand, TheUsersFaultsAreOneLine) {
  const std::string out = folder_ / "out";
  ExpectUsersFault(folder_, {"route", out, "--from", "start"}, "--to");
  ExpectUsersFault(folder_, {"route", out, "--from", "strat", "--to", "start"}, "start");
  ExpectUsersFault(folder_, {"route", out, "--from", "7,0,0", "--to", "start"}, "no floor");
  ExpectUsersFault(folder_, {"route", out, "--from", "t=3", "--to", "start"}, "no scan");
  ExpectUsersFault(folder_, {"route", folder_ / "nowhere", "--from", "start", "--to", "start"},
                   "no such file");
}

TEST_F(RouteCommand, MapsAreHandedOver) {
  for (const char* format : {"nav2", "rmf"}) {
    const std::string target = folder_ / format;
    const std::vector<std::string> command = {"export", folder_ / "out", "--format", format,
                                              "-o",     target};
    Ran ran = RunProgram(command);
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(std::filesystem::exists(target + "/frame.yaml"));
    EXPECT_EQ(RunProgram(command).code, 2) << "it is there already";
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "nav2/floors/-1/map.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "rmf/building.building.yaml"));
  const Ran plan =
      RunProgram({"export", folder_ / "out", "--format", "svg", "-o", folder_ / "plan.svg"});
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_TRUE(Contains(ReadText(folder_ / "plan.svg"), "floor_-1"));
}

}  // namespace
}  // namespace masked_mapper
