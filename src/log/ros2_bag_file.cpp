// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/ros2_bag_file.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr unsigned char kZstdMagic[] = {0x28, 0xb5, 0x2f, 0xfd};
constexpr int kGreatestValue = 64 << 20;  // bytes
constexpr int kOperationsPerLook = 100000;
constexpr int kMostLooks = 100;  // of one step; an honest one takes fewer than one
constexpr std::size_t kMostConnections = 10000;
constexpr std::size_t kMostFiles = 100000;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

bool BeginsAsSqlite(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  char beginning[kSqliteMagic.size()];
  std::ifstream file(path, std::ios::binary);
  file.read(beginning, sizeof(beginning));
  return std::string_view(beginning, static_cast<std::size_t>(file.gcount())) == kSqliteMagic;
}

/// A path as a URI, in which a few characters mean something else.
std::string UriOf(const fs::path& path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char character : fs::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(character);
    if (std::isalnum(byte) != 0 || std::string_view("/.-_").find(character) != std::string::npos) {
      uri += character;
    } else {
      uri += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return uri;
}

/// Whether a recording that was not closed has left messages beside the file.
bool HasCompanion(const fs::path& path) {
  std::error_code error;
  for (const char* ending : {"-wal", "-journal"}) {
    const auto size = fs::file_size(path.string() + ending, error);
    if (!error && size > 0) return true;
  }
  return false;
}

/// One .db3 file.
class MessageFile {
 public:
  explicit MessageFile(const fs::path& path) : path_(path.string()) {
    if (!BeginsAsSqlite(path)) throw InputError(path_ + ": no ROS 2 bag (not an SQLite file)");
    sqlite3* opened = nullptr;
    // Immutable: nothing is written beside a file that may stand on a read-only medium.
    const std::string uri = UriOf(path) + (HasCompanion(path) ? "" : "?immutable=1");
    const int code =
        sqlite3_open_v2(uri.c_str(), &opened, SQLITE_OPEN_URI | SQLITE_OPEN_READONLY, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) Fail();
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kGreatestValue);
    sqlite3_progress_handler(opened, kOperationsPerLook, &OnProgress, this);
    sqlite3_exec(opened, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
    CheckTable("topics");
    CheckTable("messages");
    ReadTopics();
    ReadExtent();
  }
  MessageFile(const MessageFile&) = delete;
  MessageFile& operator=(const MessageFile&) = delete;

  const std::string& path() const { return path_; }
  const std::map<std::int64_t, BagConnection>& topics() const { return topics_; }
  std::int64_t first_time() const { return first_time_; }
  /// The file ends before its rows do.
  bool damaged() const { return damaged_; }

  struct Row {
    std::int64_t topic = 0;
    std::int64_t time = 0;  ///< ns
    const unsigned char* data = nullptr;
    std::size_t size = 0;
  };

  std::optional<Row> Next() {
    if (!messages_) messages_ = Prepare("SELECT topic_id, timestamp, data, id FROM messages");
    if (at_end_ || !messages_ || !Step(messages_.get())) {
      at_end_ = true;
      return std::nullopt;
    }
    Row row;
    row.topic = sqlite3_column_int64(messages_.get(), 0);
    row.time = sqlite3_column_int64(messages_.get(), 1);
    row.data = static_cast<const unsigned char*>(sqlite3_column_blob(messages_.get(), 2));
    row.size = static_cast<std::size_t>(sqlite3_column_bytes(messages_.get(), 2));
    if (row.data == nullptr) row.size = 0;
    last_id_ = sqlite3_column_int64(messages_.get(), 3);
    return row;
  }

  void Rewind() {
    messages_.reset();
    at_end_ = false;
    last_id_ = 0;
  }

  double Progress() const {
    if (at_end_ || greatest_id_ <= 0) return at_end_ ? 1.0 : 0.0;
    return std::clamp(static_cast<double>(last_id_) / static_cast<double>(greatest_id_), 0.0, 1.0);
  }

 private:
  static int OnProgress(void* self) {
    return ++static_cast<MessageFile*>(self)->looks_ > kMostLooks ? 1 : 0;
  }

  [[noreturn]] void Fail() const {
    throw InputError(path_ + ": cannot be read as a ROS 2 bag: " + sqlite3_errmsg(database_.get()));
  }

  /// Empty when the file does not allow it.
  Statement Prepare(const char* sql) {
    looks_ = 0;
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
      damaged_ = true;
    }
    return Statement(statement);
  }

  /// False at the end, which damage brings early.
  bool Step(sqlite3_stmt* statement) {
    looks_ = 0;
    const int code = sqlite3_step(statement);
    if (code != SQLITE_ROW && code != SQLITE_DONE) damaged_ = true;
    return code == SQLITE_ROW;
  }

  static std::string Text(sqlite3_stmt* statement, int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
    constexpr std::size_t kLongest = 256;
    return text == nullptr ? "" : std::string(std::string_view(text).substr(0, kLongest));
  }

  /// A view or a virtual table would run what the file's author wrote.
  void CheckTable(const std::string& name) {
    const std::string sql =
        "SELECT type, sql FROM sqlite_master WHERE name = '" + name + "' COLLATE NOCASE";
    const Statement statement = Prepare(sql.c_str());
    if (!statement) Fail();
    if (!Step(statement.get())) {
      if (damaged_) Fail();
      throw InputError(path_ + ": no ROS 2 bag (an SQLite file without the table `" + name + "`)");
    }
    std::string definition = Text(statement.get(), 1);
    std::transform(definition.begin(), definition.end(), definition.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const bool is_table = Text(statement.get(), 0) == "table";
    const bool is_plain = definition.rfind("CREATE TABLE", 0) == 0 && !HasComputedColumns(name);
    if (is_table && is_plain) return;
    throw InputError(path_ + ": no ROS 2 bag (`" + name + "` is not a plain table)");
  }

  bool HasComputedColumns(const std::string& table) {
    const std::string sql =
        "SELECT 1 FROM pragma_table_xinfo('" + table + "') WHERE hidden <> 0 LIMIT 1";
    const Statement statement = Prepare(sql.c_str());
    return !statement || Step(statement.get()) || damaged_;
  }

  void ReadTopics() {
    const Statement statement = Prepare("SELECT id, name, type, serialization_format FROM topics");
    if (!statement) Fail();
    while (topics_.size() < kMostConnections && Step(statement.get())) {
      BagConnection topic{Text(statement.get(), 1), Text(statement.get(), 2), ""};
      const std::string format = Text(statement.get(), 3);
      if (format != "cdr") topic.type += " as " + format;  // counted, not read
      topics_.emplace(sqlite3_column_int64(statement.get(), 0), std::move(topic));
    }
  }

  void ReadExtent() {
    const Statement last = Prepare("SELECT max(id) FROM messages");
    if (!last) Fail();
    if (Step(last.get())) greatest_id_ = sqlite3_column_int64(last.get(), 0);
    const std::optional<Row> first = Next();
    if (first) first_time_ = first->time;
    // A page that only the far end of the table needs is missed when the reading gets there.
    Rewind();
    damaged_ = false;
  }

  std::string path_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::int64_t, BagConnection> topics_;
  std::int64_t first_time_ = 0;  ///< ns
  std::int64_t greatest_id_ = 0;
  Statement messages_;
  std::int64_t last_id_ = 0;
  int looks_ = 0;
  bool at_end_ = false;
  bool damaged_ = false;
};

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
      const MessageFile file(name);
      by_time.emplace_back(file.first_time(), name);
      for (const auto& [id, topic] : file.topics()) {
        const auto number = static_cast<std::uint32_t>(ids.size());
        if (number >= kMostConnections) throw InputError(path + ": too many topics");
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
      if (!open_) open_ = std::make_unique<MessageFile>(files_[file_]);
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
  std::uint64_t damaged() const { return damaged_; }
  double Progress() const {
    const double within = open_ ? open_->Progress() : 0.0;
    return (static_cast<double>(file_) + within) / static_cast<double>(files_.size());
  }

 private:
  std::map<std::uint32_t, BagConnection> connections_;
  std::map<std::string, std::map<std::int64_t, std::uint32_t>> topics_;  ///< by file and its id
  std::vector<fs::path> files_;  ///< in order of their first messages
  std::size_t file_ = 0;
  std::unique_ptr<MessageFile> open_;
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
bool Ros2BagFile::Truncated() const { return impl_->truncated(); }
std::uint64_t Ros2BagFile::Damaged() const { return impl_->damaged(); }
double Ros2BagFile::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
