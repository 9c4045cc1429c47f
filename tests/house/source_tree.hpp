// SPDX-License-Identifier: BSD-3-Clause
// The project's own files, as the tests of the house read them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace masked_mapper::house {

inline std::filesystem::path Root() { return MASKED_MAPPER_SOURCE_DIR; }

inline std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Files under `folder` (relative to the root) whose extension is one of `extensions`, sorted;
/// paths relative to the root.
inline std::vector<std::filesystem::path> FilesUnder(const std::string& folder,
                                                     const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> found;
  if (!std::filesystem::exists(Root() / folder)) return found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(Root() / folder)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() &&
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      found.push_back(entry.path().lexically_relative(Root()));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline std::vector<std::filesystem::path> CppFiles(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> all;
  for (const std::string& folder : folders) {
    const auto files = FilesUnder(folder, {".hpp", ".cpp"});
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

/// What stands between the brackets or quotes of every #include line.
inline std::vector<std::string> IncludesOf(const std::filesystem::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> includes;
  std::ifstream in(Root() / file);
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, pattern)) includes.push_back(match[1]);
  }
  return includes;
}

}  // namespace masked_mapper::house
