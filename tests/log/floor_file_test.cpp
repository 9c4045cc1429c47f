// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/floor_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

class FloorFile : public ::testing::Test {
 protected:
  std::vector<FloorLabel> Read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return ReadFloorFile(path_);
  }
  std::string ErrorOf(const std::string& text) {
    try {
      Read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  const std::string path_ = ::testing::TempDir() + "floors_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                            ".csv";
};

TEST_F(FloorFile, HoldsStampsAndLabels) {
  const std::vector<FloorLabel> labels =
      Read("t,label\r\n# made by hand\n\n 12.5 , EG\r\n100,-\n1.1e2,OG.1\n110,OG.1");
  ASSERT_EQ(labels.size(), 4U);
  EXPECT_EQ(labels[0].stamp, 12.5);
  EXPECT_EQ(labels[0].label, "EG");
  EXPECT_EQ(labels[1].label, "-");
  EXPECT_EQ(labels[2].stamp, 110.0);
  EXPECT_EQ(labels[3].label, "OG.1");
}

TEST_F(FloorFile, WhatIsWrongIsSaidWithItsLine) {
  for (const char* line : {"1", "1;EG", "x,EG", ",EG", "1 2,EG", "nan,EG", "inf,EG", "1,", "1,a b",
                           "1,../x", "1,..", "1,a,b", "t,label", "1,\xc3\xa4"}) {
    const std::string error = ErrorOf(std::string("0,EG\n") + line + "\n");
    EXPECT_NE(error.find(path_ + ":2: "), std::string::npos) << line << ": " << error;
  }
  EXPECT_NE(ErrorOf("0,EG\n\n5,OG\n4,EG\n").find(":4: the stamp steps back"), std::string::npos);
}

TEST_F(FloorFile, EndlessAndBinaryLinesAreRefused) {
  EXPECT_NE(ErrorOf(std::string(1 << 20, '1')).find(":1: the line is longer"), std::string::npos);
  EXPECT_NE(ErrorOf("0," + std::string(195, 'x') + "\n").find(":1: "), std::string::npos);
  EXPECT_NE(ErrorOf(std::string("0,E\0G\n1,OG\n", 11)).find(":1: a label"), std::string::npos);
}

TEST_F(FloorFile, AFileThatSaysNoFloorIsRefused) {
  for (const char* text : {"", "\n", "t,label\n", "1,-\n"}) {
    EXPECT_NE(ErrorOf(text).find("no line says a floor"), std::string::npos) << text;
  }
}

TEST_F(FloorFile, AMissingFileOrADirectoryIsRefused) {
  EXPECT_THROW(ReadFloorFile(path_ + ".none"), InputError);
  EXPECT_THROW(ReadFloorFile(::testing::TempDir()), InputError);
}

}  // namespace
}  // namespace masked_mapper
