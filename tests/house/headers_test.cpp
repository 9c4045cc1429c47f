// SPDX-License-Identifier: BSD-3-Clause
// include/ is what rooms show each other, and what is installed. A header that serves its own room
// alone stands beside its source.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "house/source_tree.hpp"

namespace masked_mapper::house {
namespace {

namespace fs = std::filesystem;

/// What each file includes.
using Includes = std::map<fs::path, std::vector<std::string>>;

/// The room of include/masked_mapper/<room>/x.hpp or src/<room>/x.cpp; of other files the folder
/// that they stand in: `apps`, `examples`.
std::string PlaceOf(const fs::path& file) {
  auto part = file.begin();
  if (*part == "include") std::advance(part, 2);
  if (*part == "src") std::advance(part, 1);
  return part->string();
}

Includes IncludesOfTheHouse() {
  Includes includes;
  for (const fs::path& file : CppFiles({"include/masked_mapper", "src", "apps", "examples",
                                        "experiments", "benchmarks", "fuzz"})) {
    includes[file] = IncludesOf(file);
  }
  return includes;
}

/// The headers in include/ that no file of another room includes, and none outside the rooms.
std::set<std::string> HeadersOfOneRoom(const Includes& includes) {
  std::set<std::string> of_one_room;
  for (const auto& [file, unused] : includes) {
    if (*file.begin() == "include") of_one_room.insert(file.lexically_relative("include").string());
  }
  for (const auto& [file, headers] : includes) {
    for (const std::string& header : headers) {
      if (of_one_room.count(header) > 0 && PlaceOf(file) != PlaceOf("include" / fs::path(header))) {
        of_one_room.erase(header);
      }
    }
  }
  return of_one_room;
}

TEST(Headers, InIncludeAreThoseThatAnotherRoomIncludes) {
  const Includes includes = IncludesOfTheHouse();
  ASSERT_GT(includes.size(), 300U);
  for (const std::string& header : HeadersOfOneRoom(includes)) {
    ADD_FAILURE() << header << " is included by its own room alone: it belongs in src/"
                  << PlaceOf("include" / fs::path(header));
  }
}

TEST(Headers, OneThatServesItsRoomAloneIsFound) {
  Includes house = {
      {"include/masked_mapper/log/reader.hpp", {"masked_mapper/log/detail.hpp"}},
      {"include/masked_mapper/log/detail.hpp", {}},
      {"include/masked_mapper/log/shown.hpp", {}},
      {"src/log/reader.cpp", {"masked_mapper/log/reader.hpp", "masked_mapper/log/detail.hpp"}},
      {"src/map/map.cpp", {"masked_mapper/log/reader.hpp", "vector"}},
      {"apps/main.cpp", {"masked_mapper/log/shown.hpp"}},
  };
  EXPECT_EQ(HeadersOfOneRoom(house), std::set<std::string>{"masked_mapper/log/detail.hpp"})
      << "what only a public header of its room needs is the room's, too";
  house["src/map/map.hpp"] = {"masked_mapper/log/detail.hpp"};
  EXPECT_TRUE(HeadersOfOneRoom(house).empty());
  house["include/masked_mapper/map/map.hpp"] = {};
  EXPECT_EQ(HeadersOfOneRoom(house), std::set<std::string>{"masked_mapper/map/map.hpp"});
}

/// Only include/ is installed.
TEST(Headers, InIncludeNeedNoneBesideASource) {
  for (const fs::path& file : CppFiles({"include"})) {
    for (const std::string& include : IncludesOf(file)) {
      EXPECT_TRUE(fs::path(include).extension() != ".hpp" ||
                  fs::exists(Root() / "include" / include))
          << file << " includes " << include << ", which is not installed";
    }
  }
}

}  // namespace
}  // namespace masked_mapper::house
