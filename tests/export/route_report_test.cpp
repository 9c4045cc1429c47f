// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(RouteReport, HoldsTheWayAsItIs) {
  const BuildingMap map = SampleMap();
  Route route;
  route.is_found = true;
  route.length_m = 5.0;
  route.legs = {{0, 2.0, {{0.0, 0.0}, {2.0, 0.0}}}, {1, 3.0, {{2.0, 0.0}, {2.0, 3.0}}}};
  const TestFolder folder;
  WriteRouteReport(map, {}, RenderFloors(map, {}), 30.0, route, folder / "way.html");
  std::ifstream file(folder / "way.html");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string start = R"(id="report-data">)";
  const std::size_t begin = page.find(start) + start.size();
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script", begin) - begin)).at("map");
  const auto& way = data.at("route");
  EXPECT_EQ(way.at("length_m"), 5.0);
  ASSERT_EQ(way.at("legs").size(), 2U);
  for (std::size_t leg = 0; leg < 2; ++leg) {
    EXPECT_EQ(way["legs"][leg].at("floor"), route.legs[leg].floor);
    ASSERT_EQ(way["legs"][leg].at("points").size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(way["legs"][leg]["points"][i][0], route.legs[leg].points_in_world[i].x());
      EXPECT_EQ(way["legs"][leg]["points"][i][1], route.legs[leg].points_in_world[i].y());
    }
  }
}

}  // namespace
}  // namespace masked_mapper
