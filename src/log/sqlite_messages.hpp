// SPDX-License-Identifier: BSD-3-Clause
// The messages of one .db3 file of a ROS 2 bag, in the order of recording; the one door to SQLite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ros_bag.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace masked_mapper {

constexpr std::size_t kMostBagTopics = 10000;

class SqliteMessages {
 public:
  /// Throws InputError, with `shown_name` for the file: no SQLite file, not the tables of a bag,
  /// cannot be opened.
  SqliteMessages(const std::filesystem::path& path, std::string shown_name);
  ~SqliteMessages();
  SqliteMessages(const SqliteMessages&) = delete;
  SqliteMessages& operator=(const SqliteMessages&) = delete;

  const std::map<std::int64_t, BagConnection>& topics() const { return topics_; }
  /// ns, of the message with the greatest id.
  std::int64_t last_time() const { return last_time_; }
  /// The file ends before its rows do.
  bool damaged() const { return damaged_; }

  struct Row {
    std::int64_t topic = 0;
    std::int64_t time = 0;  ///< ns
    const unsigned char* data = nullptr;
    std::size_t size = 0;
  };
  std::optional<Row> Next();
  void Rewind();
  double Progress() const;

 private:
  struct CloseDatabase {
    void operator()(sqlite3* database) const;
  };
  struct CloseStatement {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

  static int OnProgress(void* self);
  [[noreturn]] void Fail() const;
  /// Empty when the file does not allow it.
  Statement Prepare(const char* sql);
  /// False at the end, which damage brings early.
  bool Step(sqlite3_stmt* statement);
  /// A view or a virtual table would run what the file's author wrote.
  void CheckTable(const std::string& name);
  bool HasComputedColumns(const std::string& table);
  void ReadTopics();
  void ReadExtent();

  std::string name_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::int64_t, BagConnection> topics_;
  std::int64_t last_time_ = 0;  ///< ns
  std::int64_t greatest_id_ = 0;
  Statement messages_;
  std::int64_t last_id_ = 0;
  int looks_ = 0;
  bool at_end_ = false;
  bool damaged_ = false;
};

}  // namespace masked_mapper
