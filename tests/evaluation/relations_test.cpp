// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/relations.hpp"

#include <gtest/gtest.h>

#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(Relations, ErrorsByHand) {
  // Straight along x at 1 m/s.
  const std::vector<StampedPose> drive = {{0.0, {0, 0, 0}}, {1.0, {1, 0, 0}}, {2.0, {2, 0, 0}}};
  const RelationsError error =
      CompareWithRelations(drive, {{0.0, 1.0, {1, 0, 0}},               // right
                                   {0.5, 1.5, {0.7, 0.4, 0}},           // 0.5 m off
                                   {0.0, 2.0, {2, 0, DegToRad(90.0)}},  // 90 degrees off
                                   {0.0, 2.4, {2, 0, 0}},               // within the slack
                                   {0.0, 2.6, {2, 0, 0}}});             // outside
  EXPECT_EQ(error.count, 5U);
  EXPECT_EQ(error.used, 4U);
  EXPECT_NEAR(error.translation_m.mean, 0.125, 1e-12);
  EXPECT_NEAR(error.translation_m.max, 0.5, 1e-12);
  EXPECT_NEAR(error.translation_m.std, std::sqrt(0.25 / 4 - 0.125 * 0.125), 1e-12);
  EXPECT_NEAR(error.rotation_deg.mean, 22.5, 1e-9);
  EXPECT_NEAR(error.rotation_deg.median, 0.0, 1e-9);
}

TEST(Relations, BadLinesAreNamed) {
  const TemporaryFile file(".relations");
  for (const std::string line : {"1 2 3", "1 2 x 0 0 0 0 0", "1 2 nan 0 0 0 0 0", ""}) {
    file.Write("0 1 1 0 0 0 0 0\n# comment\n" + line + "\n");
    if (line.empty()) {
      EXPECT_EQ(ReadRelations(file.path()).size(), 1U);
      continue;
    }
    try {
      ReadRelations(file.path());
      ADD_FAILURE() << line;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(":3: "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace masked_mapper
