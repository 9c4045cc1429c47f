// SPDX-License-Identifier: BSD-3-Clause
#include "open_bag.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <vector>

#include "bag_around_bag.hpp"
#include "bag_file.hpp"
#include "bag_sequence.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "mcap_file.hpp"
#include "ros2_bag_file.hpp"
#include "spooled_file.hpp"
#include "text_source.hpp"
#include "unpacking.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 100000;

enum class BagKind { kNone, kRos1, kSqlite, kMcap };

constexpr std::string_view kRos1Magic = "#ROSBAG V";
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::string_view kMcapOfAnyVersion("\x89MCAP", 5);

BagKind KindByMagic(std::string_view beginning) {
  const auto begins = [beginning](std::string_view magic) {
    return beginning.substr(0, magic.size()) == magic;
  };
  if (begins(kRos1Magic)) return BagKind::kRos1;
  if (begins(kSqliteMagic)) return BagKind::kSqlite;
  if (begins(kMcapOfAnyVersion)) return BagKind::kMcap;
  return BagKind::kNone;
}

struct Beginning {
  BagKind kind = BagKind::kNone;
  bool is_packed = false;
};

Beginning BeginningOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::array<char, 16> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), bytes.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  if (PackingOf(reinterpret_cast<const unsigned char*>(bytes.data()), count) == Packing::kNone) {
    return {KindByMagic({bytes.data(), count}), false};
  }
  try {
    TextSource source(path);
    return {KindByMagic({bytes.data(), source.Read(bytes.data(), bytes.size())}), true};
  } catch (const InputError&) {
    return {};
  }
}

std::unique_ptr<RosBag> OpenPlain(BagKind kind, const std::string& path, const std::string& shown) {
  if (kind == BagKind::kSqlite) return OpenSqliteBag(path, shown);
  if (kind == BagKind::kMcap) return OpenMcap(path, shown);
  return OpenRos1Bag(path, shown);
}

/// What is unpacked of a bag. A cut stream does not show in all kinds of file.
class SpooledBag final : public BagAroundBag {
 public:
  // The file stays readable while it is open, and is gone whatever happens to the program.
  SpooledBag(BagKind kind, const SpooledFile& spooled, const std::string& shown)
      : BagAroundBag(OpenPlain(kind, spooled.path(), shown)), truncated_(spooled.truncated()) {}

  bool Truncated() const override { return truncated_ || BagAroundBag::Truncated(); }

 private:
  bool truncated_;
};

/// .db3 and .mcap files, packed or not.
bool IsNamedAsBag(const fs::path& path) {
  static const std::set<std::string> packed = {".zstd", ".zst", ".gz", ".bz2"};
  const fs::path name = packed.count(path.extension().string()) > 0 ? path.stem() : path.filename();
  return name.extension() == ".db3" || name.extension() == ".mcap";
}

std::vector<std::string> FilesOf(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (IsNamedAsBag(entry.path())) files.push_back(entry.path().string());
    if (files.size() > kMostFiles) throw InputError(folder + ": too many files of a bag");
  }
  std::sort(files.begin(), files.end());
  // What was unpacked by hand stands beside what it was unpacked from.
  const std::set<std::string> all(files.begin(), files.end());
  files.erase(std::remove_if(files.begin(), files.end(),
                             [&all](const std::string& file) {
                               return all.count(fs::path(file).replace_extension("").string()) > 0;
                             }),
              files.end());
  return files;
}

}  // namespace

bool IsBag(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return BeginningOf(path).kind != BagKind::kNone;
  return fs::exists(fs::path(path) / "metadata.yaml", error) || !FilesOf(path).empty();
}

std::unique_ptr<RosBag> OpenBag(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const std::vector<std::string> files = FilesOf(path);
    if (!files.empty()) return std::make_unique<BagSequence>(files, BagSequence::Order::kByTime);
    throw InputError(path + ": this folder of a ROS 2 bag holds no .db3 and no .mcap file");
  }
  const Beginning beginning = BeginningOf(path);
  if (beginning.is_packed && beginning.kind != BagKind::kNone) {
    return std::make_unique<SpooledBag>(beginning.kind, SpooledFile(path), path);
  }
  if (beginning.kind == BagKind::kNone && fs::is_regular_file(path, error)) {
    throw InputError(path + ": is not a ROS bag (.bag, .db3 or .mcap)");
  }
  return OpenPlain(beginning.kind, path, path);
}

}  // namespace masked_mapper
