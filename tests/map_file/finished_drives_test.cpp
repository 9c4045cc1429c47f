// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "export/sample_map.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

class FinishedDrivesTest : public testing::Test {
 protected:
  FinishedDrivesTest() {
    WriteLog("a log that nobody reads");
    origin_ = {(folder_ / "ring.log").string(), "openings", {}};
  }

  void WriteLog(const std::string& text) const { std::ofstream(folder_ / "ring.log") << text; }

  TestFolder folder_;
  MapOrigin origin_;
};

TEST_F(FinishedDrivesTest, AreKeptUntilAllAreDone) {
  origin_.later_logs = {{(folder_ / "ring.log").string(), ""}};
  const BuildingMap whole = SampleMap();
  const fs::path checkpoint = folder_ / ".out.unfinished/checkpoint.mmck";
  fs::create_directory(checkpoint.parent_path());
  std::ofstream(checkpoint) << "a checkpoint";
  EXPECT_FALSE(FinishedDrives(folder_ / "out", origin_, true).Load(0));
  {
    FinishedDrives finished(folder_ / "out", origin_, false);
    finished.Save(0, whole);
    EXPECT_FALSE(finished.Load(0)) << "without --resume nothing is taken up";
  }
  EXPECT_FALSE(fs::exists(checkpoint)) << "the drive's checkpoint is of no use any more";
  EXPECT_TRUE(CheckpointFile::Exists(folder_ / "out"));
  FinishedDrives finished(folder_ / "out", origin_, true);
  const std::optional<BuildingMap> kept = finished.Load(0);
  ASSERT_TRUE(kept);
  EXPECT_TRUE(SameMap(whole, *kept));
  EXPECT_FALSE(finished.Load(1));
  // Another's, or another log of the same name, is not taken for it.
  const auto refusal = [&](const MapOrigin& origin) {
    try {
      FinishedDrives(folder_ / "out", origin, true).Load(0);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  MapOrigin other = origin_;
  other.onto = "old";
  EXPECT_NE(refusal(other).find("--onto was not known, now it is old"), std::string::npos)
      << refusal(other);
  other = origin_;
  other.later_logs.clear();
  EXPECT_NE(refusal(other).find("now there is none"), std::string::npos) << refusal(other);
  WriteLog("a shorter one");
  EXPECT_NE(refusal(origin_).find("has changed"), std::string::npos) << refusal(origin_);
  finished.Remove();
  EXPECT_FALSE(fs::exists(folder_ / ".out.unfinished"));
  // Of a first drive that was too short to be kept there is no trace.
  FinishedDrives(folder_ / "out", origin_, false).Save(1, whole);
  EXPECT_TRUE(CheckpointFile::Exists(folder_ / "out"));
  finished.Remove();
  // The map that is grown is a folder, or the file in it.
  fs::create_directory(folder_ / "old");
  std::ofstream(folder_ / "old/building.mmap") << "one";
  origin_.onto = (folder_ / "old").string();
  FinishedDrives(folder_ / "out", origin_, false).Save(0, whole);
  EXPECT_EQ(refusal(origin_), "");
  std::ofstream(folder_ / "old/building.mmap") << "another";
  EXPECT_NE(refusal(origin_).find("has changed"), std::string::npos) << refusal(origin_);
  finished.Remove();
}

}  // namespace
}  // namespace masked_mapper
