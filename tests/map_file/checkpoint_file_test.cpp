// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <stdexcept>

#include "export/sample_map.hpp"
#include "mapping/ring_drive.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/mapping/map_log.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// Ends the work at a scan, as an interrupt does.
class Breaker : public ProgressSink {
 public:
  explicit Breaker(std::uint64_t scans) : scans_(scans) {}
  void Stage(const std::string& name) override { stage_ = name; }
  void Progress(double /*fraction*/, std::uint64_t scans) override {
    if (scans == scans_ && stage_ == "mapping") throw std::runtime_error("broken");
  }
  void Warn(const std::string& message) override { warnings.push_back(message); }

  std::vector<std::string> warnings;

 private:
  std::uint64_t scans_;
  std::string stage_;
};

class CheckpointFileTest : public testing::Test {
 protected:
  CheckpointFileTest() : drive_(1.3, 0.3) {
    WriteLog(drive_.scans.size());
    origin_ = {(folder_ / "ring.log").string(), "openings", {}};
  }

  void WriteLog(std::size_t scans) const {
    LogWriter writer((folder_ / "ring.log").string());
    for (std::size_t i = 0; i < scans; ++i) writer.Write(drive_.scans[i]);
    writer.Close();
  }

  /// Maps with a checkpoint after every scan, or every as many as cost little.
  BuildingMap Map(bool resume, std::uint64_t break_at = 0) {
    CheckpointFile checkpoints(folder_ / "out", origin_, 1e-9, resume);
    Breaker breaker(break_at);
    BuildingMap map =
        MapLog(origin_.log, origin_.mask, origin_.options.mapping, breaker, &checkpoints);
    EXPECT_TRUE(breaker.warnings.empty()) << breaker.warnings.front();
    return map;
  }

  std::string Refusal() {
    try {
      Map(true);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }

  fs::path File() const { return folder_ / ".out.unfinished/checkpoint.mmck"; }

  TestFolder folder_;
  RingDrive drive_;
  MapOrigin origin_;
};

TEST_F(CheckpointFileTest, GoesOnToTheSameMap) {
  const BuildingMap whole = Map(false);
  CheckpointFile(folder_ / "out", origin_, 1.0, false).Remove();
  EXPECT_FALSE(CheckpointFile::Exists(folder_ / "out"));
  for (const std::uint64_t scan : {3U, 200U, 201U, 300U}) {
    EXPECT_THROW(Map(true, scan), std::runtime_error);
    EXPECT_TRUE(CheckpointFile::Exists(folder_ / "out"));
  }
  EXPECT_TRUE(SameMap(whole, Map(true)));
}

// The front end is then ahead of the graph when a checkpoint is due, and when the work ends.
TEST_F(CheckpointFileTest, GoesOnToTheSameMapAlsoWhereStagesOverlap) {
  const BuildingMap whole = Map(false);
  CheckpointFile(folder_ / "out", origin_, 1.0, false).Remove();
  origin_.options.mapping.threads = 2;
  EXPECT_TRUE(SameMap(whole, Map(false)));
  CheckpointFile(folder_ / "out", origin_, 1.0, false).Remove();
  for (const std::uint64_t scan : {std::uint64_t{3}, std::uint64_t{300}, drive_.scans.size()}) {
    EXPECT_THROW(Map(false, scan), std::runtime_error);
    EXPECT_TRUE(CheckpointFile::Exists(folder_ / "out"));
    EXPECT_TRUE(SameMap(whole, Map(true))) << scan;
    CheckpointFile(folder_ / "out", origin_, 1.0, false).Remove();
  }
}

TEST_F(CheckpointFileTest, WithoutResumeItStartsAfresh) {
  EXPECT_THROW(Map(false, 200), std::runtime_error);
  origin_.mask = "always";
  EXPECT_NO_THROW(Map(false));
}

TEST_F(CheckpointFileTest, NothingToResumeStartsAfresh) {
  CheckpointFile checkpoints(folder_ / "out", origin_, 1.0, true);
  EXPECT_FALSE(checkpoints.Load());
  EXPECT_FALSE(checkpoints.HasCheckpoint());
  EXPECT_EQ(FilesBelow(folder_.path()), std::vector<std::string>{"ring.log"});
}

TEST_F(CheckpointFileTest, AnotherRunIsRefused) {
  EXPECT_THROW(Map(false, 200), std::runtime_error);
  const MapOrigin before = origin_;
  origin_.mask = "always";
  EXPECT_NE(Refusal().find("mask was openings, now it is always"), std::string::npos) << Refusal();
  origin_ = before;
  origin_.options.mapping.closures.matcher.min_score = 0.5;
  EXPECT_NE(Refusal().find("matcher.min_score was 0.425, now it is 0.5"), std::string::npos)
      << Refusal();
  origin_ = before;
  origin_.options.threads = 2;  // changes nothing
  EXPECT_EQ(Refusal(), "");
  WriteLog(drive_.scans.size() - 1);
  EXPECT_NE(Refusal().find("has changed"), std::string::npos) << Refusal();
}

TEST_F(CheckpointFileTest, TwoRunsAtOnceAreRefused) {
  EXPECT_THROW(Map(false, 200), std::runtime_error);
  CheckpointFile first(folder_ / "out", origin_, 1.0, true);
  ASSERT_TRUE(first.Load());
  EXPECT_NE(Refusal().find("another run"), std::string::npos) << Refusal();
}

TEST_F(CheckpointFileTest, DamageIsRefusedOrHarmless) {
  EXPECT_THROW(Map(false, 200), std::runtime_error);
  const BuildingMap whole = Map(true);
  EXPECT_THROW(Map(false, 200), std::runtime_error);
  const std::string bytes = ReadBytes(File());
  std::mt19937 random(1);
  const auto damaged = [&](const std::string& file) {
    std::ofstream(File(), std::ios::binary) << file;
    CheckpointFile checkpoints(folder_ / "out", origin_, 1.0, true);
    try {
      checkpoints.Load();
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(damaged(bytes));
  int refused = 0;
  for (int i = 0; i < 10; ++i) {
    refused += damaged(bytes.substr(0, random() % bytes.size())) ? 1 : 0;
  }
  for (int i = 0; i < 50; ++i) {
    std::string file = bytes;
    file[random() % file.size()] ^= static_cast<char>(1U << (random() % 8));
    refused += damaged(file) ? 1 : 0;
  }
  EXPECT_GT(refused, 20);
  EXPECT_FALSE(damaged(bytes));
  EXPECT_TRUE(SameMap(whole, Map(true)));
}

}  // namespace
}  // namespace masked_mapper
