// SPDX-License-Identifier: BSD-3-Clause
// Every file has its licence line, the three trees mirror each other, and every check that the
// linter leaves out has its reason.
#include <gtest/gtest.h>

#include <map>

#include "house/source_tree.hpp"

namespace masked_mapper::house {
namespace {

namespace fs = std::filesystem;

TEST(Files, FirstLineIsTheLicence) {
  std::vector<fs::path> files =
      CppFiles({"include", "src", "apps", "tests", "examples", "benchmarks", "fuzz"});
  for (const std::string folder : {"src", "apps", "tests", "examples", "benchmarks", "cmake",
                                   "scripts", ".ci", "config", "experiments", "fuzz"}) {
    for (const auto& file : FilesUnder(folder, {".txt", ".cmake", ".sh", ".py", ".yaml", ".smk"})) {
      if (file.extension() != ".txt" || file.filename() == "CMakeLists.txt") files.push_back(file);
    }
  }
  for (const char* single : {"CMakeLists.txt", ".clang-tidy", ".ci/run"})
    files.emplace_back(single);
  ASSERT_GT(files.size(), 30U);
  for (const fs::path& file : files) {
    const std::string text = ReadAll(Root() / file);
    // A script's first line is its interpreter.
    const std::size_t start = text.rfind("#!", 0) == 0 ? text.find('\n') + 1 : 0;
    const std::string line = text.substr(start, text.find('\n', start) - start);
    EXPECT_TRUE(line == "// SPDX-License-Identifier: BSD-3-Clause" ||
                line == "# SPDX-License-Identifier: BSD-3-Clause")
        << file << " starts with: " << line;
  }
}

TEST(Files, HeadersAreIncludedOnce) {
  for (const fs::path& file : CppFiles({"include", "src", "apps", "tests"})) {
    if (file.extension() != ".hpp") continue;
    EXPECT_NE(ReadAll(Root() / file).find("\n#pragma once\n"), std::string::npos) << file;
  }
}

/// The header that a source implements is the first that it includes.
fs::path HeaderOf(const fs::path& source) {
  const std::vector<std::string> includes = IncludesOf(source);
  return includes.empty() ? fs::path() : fs::path(includes.front());
}

/// src/<room>/x.cpp implements a header of include/masked_mapper/<room>, and has
/// tests/<room>/x_test.cpp. A source whose header stands beside it in src/ is an inner part of its
/// room, tested with the room.
TEST(Files, TreesMirrorEachOther) {
  for (const fs::path& source : FilesUnder("src", {".cpp"})) {
    const fs::path below = source.lexically_relative("src");
    if (fs::exists((Root() / source).replace_extension(".hpp"))) continue;
    const fs::path header = HeaderOf(source);
    EXPECT_EQ(header.parent_path(), fs::path("masked_mapper") / below.parent_path())
        << source << " implements no header of its room: its first is " << header;
    const fs::path test =
        fs::path("tests") / below.parent_path() / (below.stem().string() + "_test.cpp");
    EXPECT_TRUE(fs::exists(Root() / test)) << source << " has no " << test;
  }
}

TEST(Files, NoRoomForLeftovers) {
  for (const fs::path& file : CppFiles({"include", "src", "apps", "tests"})) {
    for (const fs::path& part : file) {
      const std::string name = part.stem().string();
      EXPECT_TRUE(name != "utils" && name != "util" && name != "common" && name != "types" &&
                  name != "helpers")
          << file << ": a helper lives with its user";
    }
  }
}

/// Two types of one name in one namespace make one program of parts that disagree, and no compiler
/// says so.
TEST(Files, EveryTypeHasItsOwnName) {
  const std::regex definition(
      R"((?:^|\n)(?:struct|class|enum class) (\w+)(?: final)?(?: :[^;{]*)? \{)");
  std::map<std::string, fs::path> defined_in;
  for (const fs::path& file : CppFiles({"include"})) {
    const std::string text = ReadAll(Root() / file);
    for (std::sregex_iterator it(text.begin(), text.end(), definition), end; it != end; ++it) {
      const auto [known, is_new] = defined_in.emplace((*it)[1], file);
      EXPECT_TRUE(is_new) << (*it)[1] << " is defined in " << known->second << " and " << file;
    }
  }
  EXPECT_GT(defined_in.size(), 40U);
}

TEST(Files, EveryLintCheckLeftOutHasItsReason) {
  const std::string text = ReadAll(Root() / ".clang-tidy");
  const std::regex left_out(R"(\n  (-[a-z][\w.-]+),?)");
  int count = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), left_out), end; it != end; ++it, ++count) {
    EXPECT_NE(text.find("\n# " + (*it)[1].str() + ":"), std::string::npos)
        << (*it)[1] << " is off without a written reason";
  }
  EXPECT_GT(count, 2);
}

}  // namespace
}  // namespace masked_mapper::house
