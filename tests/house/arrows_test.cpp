// SPDX-License-Identifier: BSD-3-Clause
// The house stands as src/CMakeLists.txt draws it: arrows between rooms point down and only where
// the link lists say, and each big dependency stops at its one door.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "house/source_tree.hpp"

namespace masked_mapper::house {
namespace {

namespace fs = std::filesystem;

struct Room {
  int floor = -1;
  std::set<std::string> uses;       ///< rooms, as linked
  std::set<std::string> passes_on;  ///< those of them that are PUBLIC
};

/// The rooms of src/CMakeLists.txt; a comment that is one number says the floor of what follows.
std::map<std::string, Room> ReadRooms() {
  const std::string text = ReadAll(Root() / "src/CMakeLists.txt");
  const std::regex token(R"((?:^|\n)# (\d+)|masked_mapper_room\((\w+)([^)]*)\))");
  std::map<std::string, Room> rooms;
  int floor = -1;
  for (std::sregex_iterator it(text.begin(), text.end(), token), end; it != end; ++it) {
    if ((*it)[1].matched) {
      floor = std::stoi((*it)[1]);
      continue;
    }
    Room room;
    room.floor = floor;
    std::istringstream words((*it)[3]);
    bool is_public = true;
    for (std::string word; words >> word;) {
      if (word == "PUBLIC" || word == "PRIVATE") is_public = word == "PUBLIC";
      const std::string prefix = "masked_mapper_";
      if (word.rfind(prefix, 0) != 0) continue;
      room.uses.insert(word.substr(prefix.size()));
      if (is_public) room.passes_on.insert(word.substr(prefix.size()));
    }
    rooms[(*it)[2]] = room;
  }
  return rooms;
}

/// Rooms whose headers `name` may include: what it links, and what those pass on.
std::set<std::string> Reachable(const std::map<std::string, Room>& rooms, const std::string& name) {
  std::set<std::string> reached;
  std::vector<std::string> open(rooms.at(name).uses.begin(), rooms.at(name).uses.end());
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!reached.insert(next).second) continue;
    const auto& further = rooms.at(next).passes_on;
    open.insert(open.end(), further.begin(), further.end());
  }
  reached.insert(name);
  return reached;
}

/// The room of include/masked_mapper/<room>/x.hpp or src/<room>/x.cpp.
std::string RoomOf(const fs::path& file) {
  auto part = file.begin();
  std::advance(part, *file.begin() == "include" ? 2 : 1);
  return part->string();
}

TEST(Arrows, LinkListsPointToLowerFloors) {
  const auto rooms = ReadRooms();
  ASSERT_GE(rooms.size(), 14U);
  for (const auto& [name, room] : rooms) {
    EXPECT_GE(room.floor, 0) << name << " stands on no floor";
    for (const std::string& used : room.uses) {
      ASSERT_TRUE(rooms.count(used)) << name << " links the unknown room " << used;
      EXPECT_LT(rooms.at(used).floor, room.floor) << name << " -> " << used;
    }
  }
}

TEST(Arrows, MappingNeverSeesSimulation) {
  EXPECT_FALSE(Reachable(ReadRooms(), "mapping").count("simulation"));
}

TEST(Arrows, IncludesFollowTheLinkLists) {
  const auto rooms = ReadRooms();
  for (const fs::path& file : CppFiles({"include/masked_mapper", "src"})) {
    const std::string room = RoomOf(file);
    ASSERT_TRUE(rooms.count(room)) << file << " stands in no room of src/CMakeLists.txt";
    const std::set<std::string> allowed = Reachable(rooms, room);
    for (const std::string& include : IncludesOf(file)) {
      const std::string prefix = "masked_mapper/";
      if (include.rfind(prefix, 0) != 0) continue;
      const std::string target =
          include.substr(prefix.size(), include.find('/', prefix.size()) - prefix.size());
      EXPECT_TRUE(allowed.count(target)) << file << " includes " << include << ": the link list of "
                                         << room << " does not permit " << target;
    }
  }
}

TEST(Arrows, EveryLinkHasAnInclude) {
  const auto rooms = ReadRooms();
  std::map<std::string, std::set<std::string>> included;
  for (const fs::path& file : CppFiles({"include/masked_mapper", "src"})) {
    for (const std::string& include : IncludesOf(file)) {
      const std::string prefix = "masked_mapper/";
      if (include.rfind(prefix, 0) != 0) continue;
      const std::size_t end = include.find('/', prefix.size());
      included[RoomOf(file)].insert(include.substr(prefix.size(), end - prefix.size()));
    }
  }
  for (const auto& [name, room] : rooms) {
    for (const std::string& used : room.uses) {
      EXPECT_TRUE(included[name].count(used))
          << name << " links " << used << ", and includes nothing of it";
    }
  }
}

TEST(Arrows, NoSourceIncludesTestsOrApps) {
  for (const fs::path& file : CppFiles({"include/masked_mapper", "src"})) {
    for (const std::string& include : IncludesOf(file)) {
      EXPECT_TRUE(include.find("..") == std::string::npos && include.rfind("apps/", 0) != 0 &&
                  include.rfind("tests/", 0) != 0 && include.rfind("gtest/", 0) != 0)
          << file << " includes " << include;
    }
  }
}

/// A package, the rooms (or `apps`) that may include it, and in how many files of each.
struct Door {
  std::string include_prefix;
  std::set<std::string> rooms;
  std::size_t files_per_room;
};

TEST(Arrows, EachPackageStopsAtItsDoor) {
  constexpr std::size_t kAny = 1000;
  const std::vector<Door> doors = {
      {"ceres/", {"optimization"}, kAny},
      {"glog/", {"optimization"}, kAny},
      {"octomap/", {"rendering"}, 1},
      {"yaml-cpp/", {"text"}, 1},
      {"sqlite3.h", {"map_file", "log"}, 1},
      {"fastcdr/", {"log"}, 1},
      {"pcl/io/", {"export"}, 1},
      {"CLI/", {"apps"}, kAny},
  };
  for (const Door& door : doors) {
    std::map<std::string, std::set<std::string>> stems;
    for (const fs::path& file : CppFiles({"include/masked_mapper", "src", "apps"})) {
      const std::string room = *file.begin() == "apps" ? "apps" : RoomOf(file);
      for (const std::string& include : IncludesOf(file)) {
        if (include.rfind(door.include_prefix, 0) != 0) continue;
        EXPECT_TRUE(door.rooms.count(room)) << file << " includes " << include;
        stems[room].insert(file.stem().string());
      }
    }
    for (const auto& [room, files] : stems) {
      EXPECT_LE(files.size(), door.files_per_room)
          << door.include_prefix << " is included by several files of " << room;
    }
  }
}

TEST(Arrows, PclIsThePointTypeAndNoMore) {
  const std::set<std::string> point_type = {"pcl/point_cloud.h", "pcl/point_types.h"};
  for (const fs::path& file : CppFiles({"include/masked_mapper", "src", "apps"})) {
    for (const std::string& include : IncludesOf(file)) {
      if (include.rfind("pcl/", 0) != 0 || include.rfind("pcl/io/", 0) == 0) continue;
      EXPECT_TRUE(point_type.count(include) || RoomOf(file) == "export")
          << file << " includes " << include;
    }
  }
}

}  // namespace
}  // namespace masked_mapper::house
