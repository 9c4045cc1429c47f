// SPDX-License-Identifier: BSD-3-Clause
// A short run of what fuzz/run.sh does for long: the kept corpus, and spoilt copies of it that are
// the same every time, through the same entries. A finding ends the test program, or a sanitizer
// does.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz/entries.hpp"

namespace masked_mapper::fuzz {
namespace {

namespace fs = std::filesystem;

struct Entry {
  const char* name;
  void (*read)(const std::uint8_t* data, std::size_t size);
  int spoilt_copies;  ///< of each file
};
void PrintTo(const Entry& entry, std::ostream* out) { *out << entry.name; }

class CorpusTest : public ::testing::TestWithParam<Entry> {};

std::vector<std::string> Corpus(const std::string& name) {
  std::vector<fs::path> files;
  const fs::path folder = fs::path(MASKED_MAPPER_SOURCE_DIR) / "fuzz/corpus" / name;
  for (const fs::directory_entry& file : fs::directory_iterator(folder)) files.push_back(file);
  std::sort(files.begin(), files.end());
  std::vector<std::string> contents;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return contents;
}

/// Cut, or with a few bytes, numbers or pieces changed.
std::string Spoilt(std::string bytes, std::mt19937* random) {
  const auto below = [random](std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>((*random)()) % limit;
  };
  for (std::size_t change = 0, changes = 1 + below(6); change < changes && !bytes.empty();
       ++change) {
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), "\xff\xff\xff\x7f");
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(64)));
        break;
      case 4:
        bytes.erase(at, below(64));
        break;
      default:
        bytes[at] = "0123456789-.e\n :[{\0\xff"[below(20)];
    }
  }
  return bytes;
}

TEST_P(CorpusTest, IsReadOrRefused) {
  const Entry& entry = GetParam();
  const std::vector<std::string> corpus = Corpus(entry.name);
  ASSERT_FALSE(corpus.empty());
  std::mt19937 random(1);
  const auto read = [&entry](const std::string& bytes) {
    entry.read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  read("");
  for (const std::string& bytes : corpus) {
    read(bytes);
    for (int i = 0; i < entry.spoilt_copies; ++i) read(Spoilt(bytes, &random));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Fuzz, CorpusTest,
    ::testing::Values(Entry{"carmen", &CarmenLog, 100}, Entry{"rosbag1", &RosBag1, 100},
                      Entry{"rosbag2", &RosBag2, 100}, Entry{"mcap", &Mcap, 200},
                      Entry{"messages", &RosMessages, 500},
                      Entry{"packed_cloud", &PackedCloud, 500},
                      Entry{"configuration", &Configuration, 200}, Entry{"edits", &Edits, 100},
                      Entry{"map_file", &MapFile, 50}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace masked_mapper::fuzz
