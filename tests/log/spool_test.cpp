// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/live_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::string ReadAll(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(SpoolTest, KeepsWhatIsAddedAndIsReadFromItsBeginningEachTime) {
  Spool spool("-");
  EXPECT_EQ(ReadAll(spool.path()), "");
  spool.Add("one ");
  EXPECT_EQ(ReadAll(spool.path()), "one ");
  spool.Add("two");
  spool.Add("");
  EXPECT_EQ(ReadAll(spool.path()), "one two");
}

TEST(SpoolTest, AStreamThatCannotBeOpenedIsSaidByItsName) {
  Spool spool("the pipe");
  try {
    spool.AddAllOf("/no/such/stream");
    FAIL() << "opened";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("the pipe: ", 0), 0U) << error.what();
  }
}

// As a log: as much as is kept when it is opened, in two passes alike; what is wrong with it is
// said by its name.
TEST(SpoolTest, IsALogByItsName) {
  const auto spool = std::make_shared<Spool>("-");
  EXPECT_THROW(LogSource(spool, {}), InputError);
  spool->Add("FLASER 2 1.0 2.0 0 0 0 0 0 0 5.0 robot 0.5\n");
  const LogSource source(spool, {});
  EXPECT_EQ(source.path(), "-");
  EXPECT_TRUE(source.is_stream());
  for (int pass = 0; pass < 2; ++pass) {
    int scans = 0;
    const std::unique_ptr<LogReader> log = source.Read();
    while (const auto observation = log->Next()) {
      scans += std::holds_alternative<LaserScan>(*observation) ? 1 : 0;
    }
    EXPECT_EQ(scans, 1);
  }
}

}  // namespace
}  // namespace masked_mapper
