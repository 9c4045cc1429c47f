// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/sqlite_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace masked_mapper {
namespace {

TEST(SqliteFile, IsKnownByItsBeginning) {
  const std::string path = ::testing::TempDir() + "sqlite_file_test";
  EXPECT_FALSE(BeginsAsSqlite(path));
  EXPECT_FALSE(BeginsAsSqlite(::testing::TempDir()));
  std::ofstream(path) << "SQLite format 3";
  EXPECT_FALSE(BeginsAsSqlite(path)) << "cut";
  std::ofstream(path) << std::string("SQLite format 3\0 and so on", 26);
  EXPECT_TRUE(BeginsAsSqlite(path));
  std::remove(path.c_str());
}

TEST(SqliteFile, APathIsNoUri) {
  EXPECT_EQ(SqliteUri("/a/B-1_2.db3"), "file:/a/B-1_2.db3");
  EXPECT_EQ(SqliteUri("/odd?%#\xff"), "file:/odd%3F%25%23%FF");
}

}  // namespace
}  // namespace masked_mapper
