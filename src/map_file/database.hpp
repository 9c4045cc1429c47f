// SPDX-License-Identifier: BSD-3-Clause
// The one door to SQLite: a connection, and a statement being run. Whatever goes wrong is a
// DatabaseError; who holds the file says what that means for its user.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace masked_mapper {

/// What SQLite said. `is_busy`: another program holds the file.
class DatabaseError : public std::runtime_error {
 public:
  explicit DatabaseError(const std::string& message, bool busy = false)
      : std::runtime_error(message), is_busy(busy) {}
  bool is_busy;
};

enum class OpenMode {
  kRead,  ///< must exist; as it lies there: journals beside it are not looked at, nothing is locked
  kWrite,  ///< made if missing
};

class Database {
 public:
  Database(const std::filesystem::path& path, OpenMode mode);
  /// A copy in memory, to be changed without the file.
  static Database CopyInMemory(const Database& from);

  /// Runs statements that give no rows.
  void Run(const std::string& sql);
  /// The first value of the first row, which is a number.
  std::int64_t Number(const std::string& sql);
  /// The first value of the first row, which is text.
  std::string Text(const std::string& sql);
  sqlite3* handle() const { return database_.get(); }

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };
  Database() = default;

  std::unique_ptr<sqlite3, Closer> database_;
};

enum class ValueType { kNull, kInteger, kReal, kText, kBlob };

/// A prepared statement. For writing, the values of a row are bound one after another and put; for
/// reading, the values of the current row are taken one after another.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  Statement& Bind(std::int64_t value);
  Statement& Bind(double value);
  Statement& BindText(std::string_view value);
  Statement& BindBlob(std::string_view value);
  Statement& BindNull();
  /// Runs the statement with the values bound and makes it ready for the next ones.
  void Put();

  /// Goes to the next row; false behind the last.
  bool Next();
  int columns() const;
  /// Of the value that is taken next.
  ValueType NextType() const;
  // Each throws DatabaseError when the value has another type. Views are good until Next().
  std::int64_t Integer();
  double Real();
  std::string_view Text();
  std::string_view Blob();
  void Skip() { ++column_; }

 private:
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };
  [[noreturn]] void Fail() const;
  void Take(ValueType type);
  void Check(int code) const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  int column_ = 0;
};

/// All or nothing: what is not committed is undone.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.Run("BEGIN"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void Commit();

 private:
  Database& database_;
  bool committed_ = false;
};

}  // namespace masked_mapper
