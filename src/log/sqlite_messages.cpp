// SPDX-License-Identifier: BSD-3-Clause
#include "sqlite_messages.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "masked_mapper/log/sqlite_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

constexpr int kGreatestValue = 64 << 20;  // bytes
constexpr int kOperationsPerLook = 100000;
constexpr int kMostLooks = 100;  // of one step; an honest one takes fewer than one

/// Whether a recording that was not closed has left messages beside the file.
bool HasCompanion(const fs::path& path) {
  std::error_code error;
  for (const char* ending : {"-wal", "-journal"}) {
    const auto size = fs::file_size(path.string() + ending, error);
    if (!error && size > 0) return true;
  }
  return false;
}

std::string Text(sqlite3_stmt* statement, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
  constexpr std::size_t kLongest = 256;
  return text == nullptr ? "" : std::string(std::string_view(text).substr(0, kLongest));
}

}  // namespace

void SqliteMessages::CloseDatabase::operator()(sqlite3* database) const { sqlite3_close(database); }
void SqliteMessages::CloseStatement::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteMessages::SqliteMessages(const fs::path& path, std::string shown_name)
    : name_(std::move(shown_name)) {
  if (!BeginsAsSqlite(path)) throw InputError(name_ + ": no ROS 2 bag (not an SQLite file)");
  sqlite3* opened = nullptr;
  // Immutable: nothing is written beside a file that may stand on a read-only medium.
  const std::string uri = SqliteUri(path) + (HasCompanion(path) ? "" : "?immutable=1");
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

SqliteMessages::~SqliteMessages() = default;

std::optional<SqliteMessages::Row> SqliteMessages::Next() {
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

void SqliteMessages::Rewind() {
  messages_.reset();
  at_end_ = false;
  last_id_ = 0;
}

double SqliteMessages::Progress() const {
  if (at_end_ || greatest_id_ <= 0) return at_end_ ? 1.0 : 0.0;
  return std::clamp(static_cast<double>(last_id_) / static_cast<double>(greatest_id_), 0.0, 1.0);
}

int SqliteMessages::OnProgress(void* self) {
  return ++static_cast<SqliteMessages*>(self)->looks_ > kMostLooks ? 1 : 0;
}

void SqliteMessages::Fail() const {
  throw InputError(name_ + ": cannot be read as a ROS 2 bag: " + sqlite3_errmsg(database_.get()));
}

SqliteMessages::Statement SqliteMessages::Prepare(const char* sql) {
  looks_ = 0;
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    damaged_ = true;
  }
  return Statement(statement);
}

bool SqliteMessages::Step(sqlite3_stmt* statement) {
  looks_ = 0;
  const int code = sqlite3_step(statement);
  if (code != SQLITE_ROW && code != SQLITE_DONE) damaged_ = true;
  return code == SQLITE_ROW;
}

void SqliteMessages::CheckTable(const std::string& name) {
  const std::string sql =
      "SELECT type, sql FROM sqlite_master WHERE name = '" + name + "' COLLATE NOCASE";
  const Statement statement = Prepare(sql.c_str());
  if (!statement) Fail();
  if (!Step(statement.get())) {
    if (damaged_) Fail();
    throw InputError(name_ + ": no ROS 2 bag (an SQLite file without the table `" + name + "`)");
  }
  std::string definition = Text(statement.get(), 1);
  std::transform(definition.begin(), definition.end(), definition.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const bool is_table = Text(statement.get(), 0) == "table";
  const bool is_plain = definition.rfind("CREATE TABLE", 0) == 0 && !HasComputedColumns(name);
  if (is_table && is_plain) return;
  throw InputError(name_ + ": no ROS 2 bag (`" + name + "` is not a plain table)");
}

bool SqliteMessages::HasComputedColumns(const std::string& table) {
  const std::string sql =
      "SELECT 1 FROM pragma_table_xinfo('" + table + "') WHERE hidden <> 0 LIMIT 1";
  const Statement statement = Prepare(sql.c_str());
  return !statement || Step(statement.get()) || damaged_;
}

void SqliteMessages::ReadTopics() {
  const Statement statement = Prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!statement) Fail();
  while (topics_.size() < kMostBagTopics && Step(statement.get())) {
    BagConnection topic{Text(statement.get(), 1), Text(statement.get(), 2), ""};
    const std::string format = Text(statement.get(), 3);
    if (format != "cdr") topic.type += " as " + format;  // counted, not read
    topics_.emplace(sqlite3_column_int64(statement.get(), 0), std::move(topic));
  }
}

void SqliteMessages::ReadExtent() {
  const Statement last = Prepare("SELECT id, timestamp FROM messages ORDER BY id DESC LIMIT 1");
  if (!last) Fail();
  if (Step(last.get())) {
    greatest_id_ = sqlite3_column_int64(last.get(), 0);
    last_time_ = sqlite3_column_int64(last.get(), 1);
  }
  // A page that only the far end of the table needs is missed when the reading gets there.
  damaged_ = false;
}

}  // namespace masked_mapper
