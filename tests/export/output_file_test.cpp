// SPDX-License-Identifier: BSD-3-Clause
#include "export/output_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(OutputFile, HoldsWhatWasWritten) {
  const TestFolder folder;
  OutputFile file(folder / "a.bin");
  file.Write("one");
  file.Write(std::string_view("\0two", 4));
  file.Close();
  EXPECT_EQ(ReadBytes(folder / "a.bin"), std::string("one\0two", 7));
  WriteFile(folder / "a.bin", "");
  EXPECT_EQ(ReadBytes(folder / "a.bin"), "");
}

TEST(OutputFile, SaysWhichFileAndWhy) {
  const TestFolder folder;
  try {
    WriteFile(folder / "missing" / "a.bin", "x");
    FAIL() << "written into a folder that is not there";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.bin: No such file"), std::string::npos)
        << error.what();
  }
}

TEST(OutputFile, FullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  // Small enough to stay in a buffer until the end, and too large for one.
  EXPECT_THROW(WriteFile("/dev/full", "x"), std::runtime_error);
  EXPECT_THROW(WriteFile("/dev/full", std::string(1 << 20, 'x')), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
