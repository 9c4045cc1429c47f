// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/ros2_bag_file.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "masked_mapper/log/sqlite_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "sqlite_messages.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

constexpr unsigned char kZstdMagic[] = {0x28, 0xb5, 0x2f, 0xfd};
constexpr std::size_t kMostFiles = 100000;

bool HasEnding(const std::string& name, const std::string& ending) {
  return name.size() >= ending.size() &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

/// The .db3 files of a folder, or the one file that it is.
std::vector<fs::path> FilesOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<fs::path> files;
  std::string unreadable;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    const std::string name = entry.path().filename().string();
    if (HasEnding(name, ".db3")) files.push_back(entry.path());
    if (HasEnding(name, ".mcap") || HasEnding(name, ".db3.zstd")) {
      unreadable = std::max(unreadable, name);
    }
    if (files.size() > kMostFiles) throw InputError(path + ": too many .db3 files in this folder");
  }
  std::sort(files.begin(), files.end());
  if (!unreadable.empty() && files.empty()) {
    throw InputError(path + ": holds " + unreadable +
                     ", which is not read; `ros2 bag convert` to "
                     "sqlite3 without compression makes a bag that is");
  }
  if (files.empty()) throw InputError(path + ": this ROS 2 bag's folder holds no .db3 file");
  return files;
}

}  // namespace

class Ros2BagFile::Impl {
 public:
  explicit Impl(const std::string& path) {
    // One file is open at a time: a long drive is split into more than a process may hold open.
    std::vector<std::pair<std::int64_t, fs::path>> by_time;
    std::map<std::pair<std::string, std::string>, std::uint32_t> ids;
    for (const fs::path& name : FilesOf(path)) {
      const SqliteMessages file(name);
      by_time.emplace_back(file.first_time(), name);
      end_time_ = std::max(end_time_, file.last_time());
      for (const auto& [id, topic] : file.topics()) {
        const auto number = static_cast<std::uint32_t>(ids.size());
        if (number >= kMostBagTopics) throw InputError(path + ": too many topics");
        const auto [known, is_new] = ids.emplace(std::pair{topic.topic, topic.type}, number);
        if (is_new) connections_.emplace(number, topic);
        topics_[name.string()].emplace(id, known->second);
      }
    }
    std::sort(by_time.begin(), by_time.end());
    for (auto& [time, name] : by_time) files_.push_back(std::move(name));
  }

  std::optional<BagMessage> Next() {
    for (; file_ < files_.size(); ++file_, open_.reset()) {
      if (!open_) open_ = std::make_unique<SqliteMessages>(files_[file_]);
      const auto& topics = topics_[open_->path()];
      while (const auto row = open_->Next()) {
        const auto topic = topics.find(row->topic);
        if (topic == topics.end() || row->size == 0) {
          ++damaged_;
          continue;
        }
        if (row->size >= sizeof(kZstdMagic) &&
            std::equal(std::begin(kZstdMagic), std::end(kZstdMagic), row->data)) {
          throw InputError(open_->path() +
                           ": its messages are compressed; `ros2 bag convert` "
                           "without compression makes a bag that is read");
        }
        BagMessage message;
        message.connection = topic->second;
        message.time = 1e-9 * static_cast<double>(row->time);
        message.data = row->data;
        message.size = row->size;
        message.encoding = MessageEncoding::kCdr;
        return message;
      }
      truncated_ = truncated_ || open_->damaged();
    }
    return std::nullopt;
  }

  void Rewind() {
    open_.reset();
    file_ = 0;
    truncated_ = false;
    damaged_ = 0;
  }

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  bool truncated() const { return truncated_; }
  double end_time() const { return 1e-9 * static_cast<double>(end_time_); }
  std::uint64_t damaged() const { return damaged_; }
  double Progress() const {
    const double within = open_ ? open_->Progress() : 0.0;
    return (static_cast<double>(file_) + within) / static_cast<double>(files_.size());
  }

 private:
  std::map<std::uint32_t, BagConnection> connections_;
  std::map<std::string, std::map<std::int64_t, std::uint32_t>> topics_;  ///< by file and its id
  std::vector<fs::path> files_;  ///< in order of their first messages
  std::int64_t end_time_ = 0;    ///< ns
  std::size_t file_ = 0;
  std::unique_ptr<SqliteMessages> open_;
  bool truncated_ = false;
  std::uint64_t damaged_ = 0;
};

bool Ros2BagFile::IsBag(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return BeginsAsSqlite(path);
  if (fs::exists(fs::path(path) / "metadata.yaml", error)) return true;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    if (HasEnding(entry.path().filename().string(), ".db3")) return true;
  }
  return false;
}

Ros2BagFile::Ros2BagFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
Ros2BagFile::~Ros2BagFile() = default;

std::optional<BagMessage> Ros2BagFile::Next() { return impl_->Next(); }
void Ros2BagFile::Rewind() { impl_->Rewind(); }
const std::map<std::uint32_t, BagConnection>& Ros2BagFile::Connections() const {
  return impl_->connections();
}
std::optional<double> Ros2BagFile::EndTime() const { return impl_->end_time(); }
bool Ros2BagFile::Truncated() const { return impl_->truncated(); }
std::uint64_t Ros2BagFile::Damaged() const { return impl_->damaged(); }
double Ros2BagFile::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
