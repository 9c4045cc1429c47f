// SPDX-License-Identifier: BSD-3-Clause
// Which reader a file gets is told by what is in it, not by its name.
#include "masked_mapper/log/log_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::string Message(const std::string& path) {
  try {
    OpenLog(path, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OpenLogTest, RefusesWhatIsNoLogWithOneLine) {
  EXPECT_EQ(Message("/no/such/file.log"), "/no/such/file.log: no such file");
  // One of its own: beside other tests' bags it would be a recording.
  const TemporaryFile folder(".folder");
  std::filesystem::create_directory(folder.path());
  EXPECT_NE(Message(folder.path()).find("directory"), std::string::npos);
  const TemporaryFile empty(".log");
  empty.Write("");
  EXPECT_NE(Message(empty.path()).find("is empty"), std::string::npos);
  const TemporaryFile empty_gzip(".gz", Gzipped(""));
  EXPECT_NE(Message(empty_gzip.path()).find("is empty"), std::string::npos);
  const TemporaryFile binary(".log", std::string("\x7f"
                                                 "ELF\x02\x01\x01\0\0\0",
                                                 10));
  EXPECT_NE(Message(binary.path()).find("binary"), std::string::npos);
  const TemporaryFile no_gzip(".log.gz", "FLASER 3 1 1 1 0 0 0 0 0 0 1.0 h 0\n");
  EXPECT_NE(Message(no_gzip.path()).find("not gzip"), std::string::npos);
  const TemporaryFile broken_gzip(".log", "\x1f\x8b and then nothing of the kind");
  EXPECT_NE(Message(broken_gzip.path()).find("cannot be unpacked"), std::string::npos);
  const TemporaryFile tiny_gzip(".gz", "\x1f\x8b");
  EXPECT_NE(Message(tiny_gzip.path()).find("cannot be unpacked"), std::string::npos);
}

TEST(OpenLogTest, ANameDoesNotMakeABag) {
  const TemporaryFile text(".bag", "FLASER 3 1 1 1 0 0 0 0 0 0 1.0 h 0\n");
  const std::unique_ptr<LogReader> reader = OpenLog(text.path(), {});
  ASSERT_TRUE(reader->Next());
  EXPECT_EQ(reader->Statistics().scans, 1U);
}

TEST(OpenLogTest, ABagIsKnownByItsFirstBytes) {
  const TemporaryFile cut(".log", "#ROSBAG V2.0\n");
  EXPECT_NE(Message(cut.path()).find(cut.path()), std::string::npos);
  const TemporaryFile old(".log", "#ROSBAG V1.2\n");
  EXPECT_NE(Message(old.path()).find("1.2"), std::string::npos) << Message(old.path());
}

}  // namespace
}  // namespace masked_mapper
