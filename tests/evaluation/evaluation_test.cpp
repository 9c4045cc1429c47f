// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "evaluation/relations.hpp"
#include "evaluation/result_folder.hpp"
#include "evaluation/trajectory_error.hpp"
#include "evaluation/truth.hpp"
#include "evaluation/written_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

// A metre a second along x; the truth has it a tenth further on at the end.
EvaluationInputs StraightDrive() {
  const std::filesystem::path folder = testing::TempDir() + "/evaluated_map";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "trajectory.tum") << "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n";
  std::ofstream(folder / "summary.json") << R"({"floors": [{"label": "0", "elevation_m": 0.0}]})";
  EvaluationInputs inputs;
  inputs.folder = folder.string();
  return inputs;
}

TEST(Evaluation, SaysWhatItsPartsSayOfWhatIsGiven) {
  EvaluationInputs inputs = StraightDrive();
  inputs.truth =
      Write("evaluated.truth.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2.1 0 0 0 0 0 1\n");
  inputs.relations = Write("evaluated.relations", "0 2 2.1 0 0 0 0 0\n");
  const Evaluation evaluation = Evaluate(inputs);

  const ResultFolder map = ReadResultFolder(inputs.folder);
  const auto trajectory = CompareWithTruth(map.trajectory, ReadTruth(inputs.truth), map.floors);
  ASSERT_TRUE(evaluation.trajectory && trajectory);
  EXPECT_EQ(evaluation.trajectory->paired, 3U);
  EXPECT_EQ(evaluation.trajectory->as_it_stands.position_m.mean,
            trajectory->as_it_stands.position_m.mean);
  EXPECT_NEAR(evaluation.trajectory->as_it_stands.position_m.max, 0.1, 1e-9);
  const auto relations = CompareWithRelations(map.trajectory, ReadRelations(inputs.relations));
  ASSERT_TRUE(evaluation.relations);
  EXPECT_EQ(evaluation.relations->translation_m.mean, relations.translation_m.mean);
  EXPECT_FALSE(evaluation.closures) << "the folder holds none";
  EXPECT_FALSE(evaluation.path_length) << "nor a graph";
}

TEST(Evaluation, WhatCannotBeComparedIsTheUsersFault) {
  EvaluationInputs inputs = StraightDrive();
  inputs.checked = {inputs.folder};
  EXPECT_THROW(Evaluate(inputs), InputError) << "a map without a graph is no truth of ways";
  inputs.checked.clear();
  inputs.drive = 2;
  EXPECT_THROW(Evaluate(inputs), InputError) << "of one log there is no second drive";
}

}  // namespace
}  // namespace masked_mapper
