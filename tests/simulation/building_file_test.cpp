// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/building_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

constexpr const char* kTwoFloors = R"(# two corridors, one above the other
building pair
elevator lift 12.4 0 180 2 2 1.1
floor up 3.5
wall -1 -1 11 -1
wall -1 1 11 1
point a 0 0
point b 10 0
corridor a b
stop lift b
floor ground 0
wall -1 -1 11 -1   # along the corridor
wall -1 1 11 1
glass -1 -1 -1 1
box 4 0.8 90 0.2 1
point a 0 0
point b 10 0
way a b
stop lift b
start ground a
visit ground up ground
rest 0.5
)";

Building Read(const std::string& text) {
  std::istringstream stream(text);
  return ReadBuilding(stream, "plan.txt");
}

std::string Complaint(const std::string& text) {
  try {
    Read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BuildingFile, ReadsABuilding) {
  const Building building = Read(kTwoFloors);
  EXPECT_EQ(building.name, "pair");
  ASSERT_EQ(building.floors.size(), 2U);
  EXPECT_EQ(building.floors[0].label, "ground");
  EXPECT_EQ(building.floors[0].segments.size(), 7U);
  EXPECT_FALSE(building.floors[0].passages[0].must_visit);
  EXPECT_TRUE(building.floors[1].passages[0].must_visit);
  ASSERT_EQ(building.elevators[0].landings.size(), 2U);
  EXPECT_EQ(building.elevators[0].landings[0].floor, 1U);
  EXPECT_EQ(building.usual_tour.start_floor, 0U);
  EXPECT_EQ(building.usual_tour.visits, (std::vector<std::size_t>{0, 1, 0}));
  EXPECT_EQ(building.usual_tour.rest_per_metre, 0.5);
  EXPECT_NO_THROW(CheckBuilding(building, 0.4));
}

TEST(BuildingFile, WritesWhatItReads) {
  for (const std::string& name : BuildingNames()) {
    const Building building = *NamedBuilding(name, 3);
    const std::string text = WriteBuilding(building);
    const Building again = Read(text);
    ASSERT_EQ(again.floors.size(), building.floors.size());
    for (std::size_t f = 0; f < building.floors.size(); ++f) {
      const FloorPlan& a = building.floors[f];
      const FloorPlan& b = again.floors[f];
      EXPECT_EQ(a.label, b.label);
      EXPECT_EQ(a.elevation, b.elevation);
      ASSERT_EQ(a.segments.size(), b.segments.size());
      for (std::size_t i = 0; i < a.segments.size(); ++i) {
        EXPECT_EQ(a.segments[i].a, b.segments[i].a);
        EXPECT_EQ(a.segments[i].b, b.segments[i].b);
        EXPECT_EQ(a.segments[i].surface, b.segments[i].surface);
      }
      EXPECT_EQ(a.passages.size(), b.passages.size());
    }
    EXPECT_EQ(again.usual_tour.visits, building.usual_tour.visits);
    EXPECT_NO_THROW(CheckBuilding(again, 0.4)) << name;
  }
}

TEST(BuildingFile, SaysWhichLineIsWrong) {
  EXPECT_EQ(Complaint("floor 0 0\nwall 1 2 3\n"),
            "plan.txt:2: expected 'wall X1 Y1 X2 Y2 ...', found 3 numbers");
  EXPECT_EQ(Complaint("floor 0 0\nwall 1 2 3 x\n"), "plan.txt:2: 'x' is not a number");
  EXPECT_EQ(Complaint("floor 0 0\nwall 1 2 3 nan\n"), "plan.txt:2: 'nan' is not a number");
  EXPECT_EQ(Complaint("wall 0 0 1 1\n"), "plan.txt:1: 'wall' before the first 'floor'");
  EXPECT_EQ(Complaint("floor 0 0\ncoridor a b\n").substr(0, 36),
            "plan.txt:2: unknown item 'coridor' (");
  EXPECT_EQ(Complaint("floor 0 0\npoint a 0 0\ncorridor a z\n"),
            "plan.txt:3: floor 0 has no point 'z'");
  EXPECT_EQ(Complaint("floor 0 0\npoint a 0 0\nstop lift a\n"),
            "plan.txt:3: there is no elevator 'lift'");
  EXPECT_EQ(Complaint("floor 0 0\nstart 1 a\n"), "plan.txt:2: there is no floor '1'");
  EXPECT_EQ(Complaint(""), "plan.txt: no floor in it");
  EXPECT_EQ(Complaint(std::string("fl\0or", 5)), "plan.txt:1: this is no text");
  EXPECT_EQ(Complaint(std::string(100'000, 'a')), "plan.txt:1: the line is too long");
  EXPECT_EQ(Complaint("stairs s 0 0\nfloor 0 0\npoint a 0 0\nfoot s a\n"),
            "plan.txt: stairs s need a 'foot' and a 'head'");
}

TEST(BuildingFile, EveryCutOfAFileIsReadOrRefused) {
  const std::string text = kTwoFloors;
  for (std::size_t length = 0; length < text.size(); ++length) {
    try {
      CheckBuilding(Read(text.substr(0, length)), 0.4);
    } catch (const InputError&) {
    }
  }
}

TEST(BuildingFile, TheExampleInTheDocumentationCanBeDriven) {
  std::ifstream file(std::string(MASKED_MAPPER_SOURCE_DIR) + "/docs/simulation.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t begin = page.find("building pair");
  ASSERT_NE(begin, std::string::npos);
  const Building building = Read(page.substr(begin, page.find("```", begin) - begin));
  EXPECT_EQ(building.floors.size(), 2U);
  EXPECT_NO_THROW(CheckBuilding(building, 0.4));
}

TEST(BuildingFile, UnknownNamesAreTheUsersFault) {
  EXPECT_THROW(LoadBuilding("no/such/file", 1), InputError);
  EXPECT_THROW(LoadBuilding("/", 1), InputError);
  EXPECT_EQ(LoadBuilding("office", 1).name, "office");
}

}  // namespace
}  // namespace masked_mapper
