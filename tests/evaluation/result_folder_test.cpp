// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/result_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "masked_mapper/log/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(ResultFolder, FloorsAreFoundByHeight) {
  const std::vector<MappedFloor> floors = {{"0", 0.0}, {"1", 4.0}, {"-1", -3.5}};
  EXPECT_EQ(NearestFloor(floors, 0.4), 0U);
  EXPECT_EQ(NearestFloor(floors, 3.0), 1U);
  EXPECT_EQ(NearestFloor(floors, -9.0), 2U);
}

TEST(ResultFolder, AFolderThatIsNoMapIsTheUsersFault) {
  EXPECT_THROW(ReadResultFolder(testing::TempDir() + "/nowhere"), InputError);
  const std::string empty = testing::TempDir() + "/empty_result";
  std::filesystem::create_directories(empty);
  EXPECT_THROW(ReadResultFolder(empty), InputError);
}

}  // namespace
}  // namespace masked_mapper
