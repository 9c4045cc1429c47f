// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/simulation.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "masked_mapper/log/log_reader.hpp"
#include "simulation/building_plans.hpp"
#include "simulation/simulate.hpp"

namespace masked_mapper {
namespace {

class SimulationFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("masked_mapper_simulation_") + test->name() + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string Bytes(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

TEST_F(SimulationFiles, LogAndTruthFitTogether) {
  SimulationOptions options;
  options.floor_labels = true;
  const std::string log = (folder_ / "office.log.gz").string();
  const SimulationSummary summary = SimulateToFiles(OfficeBuilding(), options, {}, log, nullptr);
  EXPECT_LT(std::filesystem::file_size(log), 3'000'000U);

  const auto reader = OpenLog(log, {});
  std::ifstream truth(folder_ / "office.log.truth.tum");
  std::ifstream floors(folder_ / "office.log.truth_floors.csv");
  std::string line;
  std::getline(floors, line);
  EXPECT_EQ(line, "t,label");
  std::string label;
  std::uint64_t scans = 0;
  while (const auto observation = reader->Next()) {
    if (const auto* floor = std::get_if<FloorLabel>(&*observation)) label = floor->label;
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr) continue;
    ++scans;
    ASSERT_EQ(scan->size(), 361U);
    EXPECT_NEAR(RadToDeg(scan->angle_step * 360.0), 270.0, 1e-6) << "deg";
    EXPECT_NEAR(scan->T_robot_laser.x, 0.12, 1e-6) << "m";
    double stamp = 0.0;
    ASSERT_TRUE(truth >> stamp);
    EXPECT_NEAR(stamp, scan->stamp, 1e-6) << "s";
    std::getline(truth, line);
    ASSERT_TRUE(std::getline(floors, line));
    EXPECT_EQ(line.substr(line.find(',') + 1), label);
  }
  EXPECT_EQ(scans, summary.scans);
  EXPECT_EQ(reader->Statistics().bad_lines, 0U);
  EXPECT_EQ(reader->Statistics().stamp_jumps, 0U);
  EXPECT_FALSE(std::getline(floors, line));
}

TEST_F(SimulationFiles, SameSeedSameBytes) {
  for (const char* name : {"a.log.gz", "b.log.gz"}) {
    SimulateToFiles(OfficeBuilding(), {}, {}, (folder_ / name).string(), nullptr);
  }
  EXPECT_EQ(Bytes(folder_ / "a.log.gz"), Bytes(folder_ / "b.log.gz"));
  EXPECT_EQ(Bytes(folder_ / "a.log.truth.tum"), Bytes(folder_ / "b.log.truth.tum"));
  EXPECT_EQ(Bytes(folder_ / "a.log.truth_floors.csv"), Bytes(folder_ / "b.log.truth_floors.csv"));
}

TEST_F(SimulationFiles, NothingIsLeftHalfWritten) {
  const std::string log = (folder_ / "missing" / "x.log").string();
  EXPECT_THROW(SimulateToFiles(OfficeBuilding(), {}, {}, log, nullptr), std::runtime_error);
  // A simulation that fails once the files are open.
  EXPECT_ANY_THROW(SimulateToFiles(Building(), {}, {}, (folder_ / "x.log").string(), nullptr));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(SimulationFiles, NamesLoseOnlyTheirGzip) {
  EXPECT_EQ(PathsOf("d/campus.log.gz").truth, "d/campus.log.truth.tum");
  EXPECT_EQ(PathsOf("campus.log").truth_floors, "campus.log.truth_floors.csv");
}

}  // namespace
}  // namespace masked_mapper
