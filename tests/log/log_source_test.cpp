// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_source.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>
#include <vector>

#include "log/bag_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr const char* kTextLog =
    "FLASER 3 1.0 2.0 3.0 0 0 0 0 0 0 10.0 host 10.0\n"
    "FLASER 3 1.0 2.0 3.0 1 0 0 1 0 0 11.0 host 11.0\n"
    "FLASER 3 1.0 2.0 3.0 2 0 0 2 0 0 10.5 host 11.5\n"
    "FLASER 3 1.0 2.0 3.0 3 0 0 3 0 0 12.0 host 12.0\n";

std::vector<LaserScan> ScansOf(LogReader& reader) {
  std::vector<LaserScan> scans;
  while (const std::optional<Observation> observation = reader.Next()) {
    if (const auto* scan = std::get_if<LaserScan>(&*observation)) scans.push_back(*scan);
  }
  return scans;
}

/// A pipe into which a thread writes.
class Pipe {
 public:
  explicit Pipe(std::string content) : file_(".fifo") {
    EXPECT_EQ(::mkfifo(file_.path().c_str(), 0600), 0);
    writer_ = std::thread([this, content = std::move(content)] { file_.Write(content); });
  }
  ~Pipe() { writer_.join(); }
  const std::string& path() const { return file_.path(); }

 private:
  TemporaryFile file_;
  std::thread writer_;
};

TEST(LogSourceTest, GivesTheSamePassAfterPass) {
  for (const std::string& content : {std::string(kTextLog), ScanBag(true), ScanBag(false)}) {
    const TemporaryFile file(".log", content);
    const LogSource source(file.path(), {});
    const std::size_t scans = ScansOf(*source.Read()).size();
    EXPECT_GE(scans, 4U);
    source.Read()->Next();  // one that is left in the middle
    EXPECT_EQ(ScansOf(*source.Read()).size(), scans);
    const std::unique_ptr<LogReader> one = source.Read();
    const std::unique_ptr<LogReader> other = source.Read();
    EXPECT_EQ(ScansOf(*one).size(), scans);
    EXPECT_EQ(ScansOf(*other).size(), scans);
  }
}

TEST(LogSourceTest, APipeIsReadAsOftenAsAFile) {
  for (const std::string& content :
       {std::string(kTextLog), Gzipped(kTextLog), ScanBag(true), ScanBag(false)}) {
    const TemporaryFile file(".log", content);
    const Pipe pipe(content);
    const LogSource source(pipe.path(), {});
    EXPECT_TRUE(source.is_stream());
    EXPECT_EQ(source.path(), pipe.path());
    const std::vector<LaserScan> wanted = ScansOf(*OpenLog(file.path(), {}));
    for (int pass = 0; pass < 2; ++pass) {
      const std::vector<LaserScan> scans = ScansOf(*source.Read());
      ASSERT_EQ(scans.size(), wanted.size());
      for (std::size_t i = 0; i < scans.size(); ++i) EXPECT_EQ(scans[i].stamp, wanted[i].stamp);
    }
  }
}

TEST(LogSourceTest, APipeOutlivesItsSourceWithTheReader) {
  const Pipe pipe(kTextLog);
  EXPECT_EQ(ScansOf(*OpenLog(pipe.path(), {})).size(), 4U);
}

TEST(LogSourceTest, WhatIsWrongWithAPipeIsSaidOfThePipe) {
  const Pipe pipe(std::string(100, '\0'));
  try {
    const LogSource source(pipe.path(), {});
    FAIL() << "a log of zeros";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(pipe.path() + ": ", 0), 0U) << error.what();
  }
}

TEST(LogSourceTest, ScansKeepTheStampOfTheLogBesideTheMendedOne) {
  const TemporaryFile file(".log", kTextLog);
  const std::vector<LaserScan> scans = ScansOf(*OpenLog(file.path(), {}));
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[2].log_stamp, 10.5);
  EXPECT_EQ(scans[2].stamp, 11.0) << "held";
  EXPECT_EQ(scans[3].log_stamp, scans[3].stamp);
}

}  // namespace
}  // namespace masked_mapper
