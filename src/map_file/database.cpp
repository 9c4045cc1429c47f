// SPDX-License-Identifier: BSD-3-Clause
#include "database.hpp"

#include <sqlite3.h>

#include <new>

#include "masked_mapper/log/sqlite_file.hpp"

namespace masked_mapper {
namespace {

[[noreturn]] void ThrowCode(int code, const std::string& message) {
  if ((code & 0xff) == SQLITE_NOMEM) throw std::bad_alloc();
  throw DatabaseError(message, (code & 0xff) == SQLITE_BUSY);
}

ValueType TypeOf(int type) {
  switch (type) {
    case SQLITE_INTEGER:
      return ValueType::kInteger;
    case SQLITE_FLOAT:
      return ValueType::kReal;
    case SQLITE_TEXT:
      return ValueType::kText;
    case SQLITE_BLOB:
      return ValueType::kBlob;
    default:
      return ValueType::kNull;
  }
}

}  // namespace

void Database::Closer::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Database::Database(const std::filesystem::path& path, OpenMode mode) {
  const bool reads = mode == OpenMode::kRead;
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(
      (SqliteUri(path) + (reads ? "?immutable=1" : "")).c_str(), &opened,
      SQLITE_OPEN_URI | (reads ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE),
      nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) ThrowCode(code, sqlite3_errmsg(opened));
  // A file from elsewhere may bring views and triggers along.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  Run("PRAGMA cell_size_check = ON");
}

Database Database::CopyInMemory(const Database& from) {
  Database copy;
  sqlite3* opened = nullptr;
  int code =
      sqlite3_open_v2(":memory:", &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  copy.database_.reset(opened);
  if (code != SQLITE_OK) ThrowCode(code, sqlite3_errmsg(opened));
  sqlite3_backup* backup = sqlite3_backup_init(opened, "main", from.handle(), "main");
  if (backup == nullptr) ThrowCode(sqlite3_errcode(opened), sqlite3_errmsg(opened));
  sqlite3_backup_step(backup, -1);
  code = sqlite3_backup_finish(backup);
  if (code != SQLITE_OK) ThrowCode(code, sqlite3_errmsg(opened));
  return copy;
}

void Database::Run(const std::string& sql) {
  const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) ThrowCode(code, sqlite3_errmsg(handle()));
}

std::int64_t Database::Number(const std::string& sql) {
  Statement statement(*this, sql);
  if (!statement.Next()) throw DatabaseError("a number is missing");
  return statement.Integer();
}

std::string Database::Text(const std::string& sql) {
  Statement statement(*this, sql);
  if (!statement.Next()) throw DatabaseError("a text is missing");
  return std::string(statement.Text());
}

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(const Database& database, const std::string& sql)
    : database_(database.handle()) {
  sqlite3_stmt* prepared = nullptr;
  const int code = sqlite3_prepare_v2(database_, sql.c_str(), -1, &prepared, nullptr);
  statement_.reset(prepared);
  if (code != SQLITE_OK) Fail();
}

void Statement::Fail() const { ThrowCode(sqlite3_errcode(database_), sqlite3_errmsg(database_)); }

void Statement::Check(int code) const {
  if (code != SQLITE_OK) Fail();
}

Statement& Statement::Bind(std::int64_t value) {
  Check(sqlite3_bind_int64(statement_.get(), ++column_, value));
  return *this;
}

Statement& Statement::Bind(double value) {
  Check(sqlite3_bind_double(statement_.get(), ++column_, value));
  return *this;
}

Statement& Statement::BindText(std::string_view value) {
  // An empty view may have no address, which SQLite would take for NULL.
  Check(sqlite3_bind_text64(statement_.get(), ++column_, value.empty() ? "" : value.data(),
                            value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::BindBlob(std::string_view value) {
  Check(sqlite3_bind_blob64(statement_.get(), ++column_, value.empty() ? "" : value.data(),
                            value.size(), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::BindNull() {
  Check(sqlite3_bind_null(statement_.get(), ++column_));
  return *this;
}

void Statement::Put() {
  if (sqlite3_step(statement_.get()) != SQLITE_DONE) Fail();
  Check(sqlite3_reset(statement_.get()));
  column_ = 0;
}

bool Statement::Next() {
  column_ = 0;
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) Fail();
  return code == SQLITE_ROW;
}

int Statement::columns() const { return sqlite3_column_count(statement_.get()); }

ValueType Statement::NextType() const {
  return TypeOf(sqlite3_column_type(statement_.get(), column_));
}

void Statement::Take(ValueType type) {
  if (NextType() != type) {
    const char* name = sqlite3_column_name(statement_.get(), column_);
    throw DatabaseError("a value of another type in column " +
                        std::string(name == nullptr ? "?" : name));
  }
  ++column_;
}

std::int64_t Statement::Integer() {
  Take(ValueType::kInteger);
  return sqlite3_column_int64(statement_.get(), column_ - 1);
}

double Statement::Real() {
  Take(ValueType::kReal);
  return sqlite3_column_double(statement_.get(), column_ - 1);
}

std::string_view Statement::Text() {
  Take(ValueType::kText);
  const auto* text =
      reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column_ - 1));
  if (text == nullptr) Fail();
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column_ - 1))};
}

std::string_view Statement::Blob() {
  Take(ValueType::kBlob);
  const void* bytes = sqlite3_column_blob(statement_.get(), column_ - 1);
  if (bytes == nullptr) return {};
  return {static_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column_ - 1))};
}

Transaction::~Transaction() {
  if (committed_) return;
  try {
    database_.Run("ROLLBACK");
  } catch (const std::exception&) {  // undone with the file's next opening
  }
}

void Transaction::Commit() {
  database_.Run("COMMIT");
  committed_ = true;
}

}  // namespace masked_mapper
