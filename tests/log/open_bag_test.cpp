// SPDX-License-Identifier: BSD-3-Clause
#include "log/open_bag.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "log/bag_bytes.hpp"
#include "log/mcap_bytes.hpp"
#include "log/ros2_bag_writing.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// Stamps of the scans of a log, and whether it was cut.
std::pair<std::vector<double>, bool> Scans(const std::string& path) {
  const std::unique_ptr<LogReader> reader = OpenLog(path, {});
  std::vector<double> stamps;
  while (const std::optional<Observation> observation = reader->Next()) {
    if (std::holds_alternative<LaserScan>(*observation)) stamps.push_back(Stamp(*observation));
  }
  return {stamps, reader->Statistics().truncated};
}

std::string Refusal(const std::string& path) {
  try {
    Scans(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string ScanMcap(int first_second, int seconds) {
  std::string records =
      McapSchemaBytes(1, "sensor_msgs/msg/LaserScan") + McapChannelBytes(1, 1, "/scan");
  for (int second = first_second; second < first_second + seconds; ++second) {
    records += McapMessageBytes(1, second + 0.5, CdrScan(second, {1, 2, 3}));
  }
  return McapBytes(McapZstdChunk(first_second, records));
}

class OpenBagTest : public ::testing::Test {
 protected:
  OpenBagTest() : folder_(name_.path() + ".folder") {
    fs::create_directory(folder_);
    fs::create_directory(unpacked_);
    // A folder of this test's own: beside others that run at the same time, only here is what is
    // left behind its own.
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", unpacked_.c_str(), 1);
  }
  ~OpenBagTest() override {
    if (before_) {
      setenv("TMPDIR", before_->c_str(), 1);
    } else {
      unsetenv("TMPDIR");
    }
    fs::remove_all(folder_);
    fs::remove_all(unpacked_);
  }

  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
  }
  std::string Sqlite(int first_second, int seconds) const {
    const TemporaryFile file(".db3");
    WriteDrive(file.path(), first_second, seconds);
    return file.Read();
  }

  const TemporaryFile name_{".bags"};
  const fs::path folder_;
  const fs::path unpacked_{name_.path() + ".unpacked"};
  std::optional<std::string> before_;
};

TEST_F(OpenBagTest, AnMcapFileIsALog) {
  const auto [stamps, truncated] = Scans(Write("x.mcap", ScanMcap(100, 5)));
  EXPECT_EQ(stamps, (std::vector<double>{100.5, 101.5, 102.5, 103.5, 104.5}));
  EXPECT_FALSE(truncated);
}

TEST_F(OpenBagTest, PackedBagsOfEveryKind) {
  EXPECT_EQ(Scans(Write("x.mcap.zstd", ZstdPacked(ScanMcap(100, 5)))).first.size(), 5U);
  EXPECT_EQ(Scans(Write("x.db3.zstd", ZstdPacked(Sqlite(100, 5)))).first.size(), 5U);
  EXPECT_EQ(Scans(Write("x.bag.gz", Gzipped(ScanBag(true)))).first.size(), 12U);
  EXPECT_TRUE(fs::is_empty(unpacked_)) << "left behind: " << *fs::directory_iterator(unpacked_);
}

TEST_F(OpenBagTest, ACutPackedBagGivesWhatItHas) {
  const std::string packed = Gzipped(ScanBag(true, 400));
  const auto [stamps, truncated] =
      Scans(Write("x.bag.gz", packed.substr(0, packed.size() * 2 / 3)));
  EXPECT_GT(stamps.size(), 300U);
  EXPECT_TRUE(truncated);
}

TEST_F(OpenBagTest, WhatUnpacksWithoutEndIsRefused) {
  const TemporaryFile zeros(".zeros");
  std::string bytes = "#ROSBAG V2.0\n";
  bytes.resize(std::size_t{1} << 24U, '\0');
  std::string packed;
  for (int i = 0; i < 64; ++i) packed += ZstdPacked(bytes);
  EXPECT_NE(Refusal(Write("x.bag.zst", packed)).find("1000 times its size"), std::string::npos);
}

TEST_F(OpenBagTest, FilesOfAFolderAreOneRecordingInOrderOfTime) {
  Write("drive_2.mcap", ScanMcap(110, 5));
  Write("drive_10.mcap.zstd", ZstdPacked(ScanMcap(115, 5)));
  Write("drive_0.db3", Sqlite(100, 5));
  Write("drive_1.db3.zstd", ZstdPacked(Sqlite(105, 5)));
  Write("drive_1.db3", Sqlite(105, 5));  // unpacked beside it
  Write("readme.txt", "of no interest");
  const auto [stamps, truncated] = Scans(folder_.string());
  ASSERT_EQ(stamps.size(), 20U);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_EQ(stamps[i], 100.5 + static_cast<double>(i));
  }
  EXPECT_FALSE(truncated);
}

TEST_F(OpenBagTest, TheLastFileOfAFolderMayBeCut) {
  Write("drive_0.mcap", ScanMcap(100, 5));
  const std::string last = ScanMcap(105, 5);
  Write("drive_1.mcap", last.substr(0, last.size() - 40));
  const auto [stamps, truncated] = Scans(folder_.string());
  EXPECT_EQ(stamps.size(), 10U);
  EXPECT_TRUE(truncated);
}

TEST_F(OpenBagTest, WhatHoldsNoScanIsToldByItsTopicsAndWhatHelps) {
  const auto refusal = [this](const std::string& type, const std::string& encoding) {
    return Refusal(Write(
        "x.mcap", McapBytes(McapSchemaBytes(1, type) + McapChannelBytes(1, 1, "/topic", encoding) +
                            McapMessageBytes(1, 1.0, "abcd"))));
  };
  const std::string odometry = refusal("nav_msgs/msg/Odometry", "cdr");
  EXPECT_NE(odometry.find("no sensor_msgs/LaserScan and no PointCloud2 (topics: 1 on /topic "
                          "(nav_msgs/msg/Odometry))"),
            std::string::npos)
      << odometry;
  EXPECT_NE(refusal("foxglove.LaserScan", "protobuf").find("serialised as protobuf"),
            std::string::npos);
  EXPECT_NE(refusal("velodyne_msgs/msg/VelodyneScan", "cdr").find("velodyne_pointcloud"),
            std::string::npos);
  EXPECT_NE(refusal("ouster_sensor_msgs/msg/PacketMsg", "cdr").find("ouster_ros"),
            std::string::npos);
  EXPECT_EQ(odometry.find('\n'), std::string::npos);
}

TEST_F(OpenBagTest, RosOneMessagesInMcapAreRead) {
  const std::string path =
      Write("x.mcap", McapBytes(McapSchemaBytes(1, "sensor_msgs/LaserScan", "ros1msg") +
                                McapChannelBytes(1, 1, "/scan", "ros1") +
                                McapMessageBytes(1, 7.0, LaserScanBytes(7, 5)) +
                                McapMessageBytes(1, 8.0, LaserScanBytes(8, 5))));
  EXPECT_EQ(Scans(path).first, (std::vector<double>{7.0, 8.0}));
}

TEST_F(OpenBagTest, TheRealFilesHaveTheirTopicsAndCounts) {
  const std::string shared = std::string(MASKED_MAPPER_REAL_LOGS) + "/bags/mcap/";
  if (!fs::exists(shared)) GTEST_SKIP() << shared << " is not here";
  EXPECT_NE(Refusal(shared + "nav2_turtlebot_odom_tf_amcl_zstd.mcap")
                .find("2639 on /odom (nav_msgs/msg/Odometry)"),
            std::string::npos);
  EXPECT_NE(Refusal(shared + "imu_jointstates_uncompressed_4chunks_humble_jazzy.mcap")
                .find("4712 on /imu/data (sensor_msgs/msg/Imu)"),
            std::string::npos);
  EXPECT_NE(Refusal(shared + "json_zstd_2chunks_webdemo.mcap").find("serialised as json"),
            std::string::npos);
  EXPECT_NE(Refusal(shared + "rosbag2_wrong_rmw_test_0.mcap").find("serialised as wrong_format"),
            std::string::npos);
  for (int part = 0; part < 3; ++part) {
    const std::string name = "rosbag2_multiple_files_" + std::to_string(part) + ".mcap";
    fs::copy_file(shared + name, folder_ / name);
  }
  EXPECT_NE(Refusal(folder_.string()).find("3177 on /chatter (std_msgs/msg/String)"),
            std::string::npos);
}

TEST_F(OpenBagTest, WhatIsNoBagIsSaid) {
  EXPECT_FALSE(IsBag("/no/such.mcap"));
  EXPECT_FALSE(IsBag(Write("x.log", "# text\n")));
  EXPECT_FALSE(IsBag(Write("x.log.gz", Gzipped("# text\n"))));
  EXPECT_TRUE(IsBag(Write("y.mcap", "\x89MCAP1\r\n")));
  EXPECT_NE(Refusal(folder_ / "y.mcap").find("version `1`"), std::string::npos);
  EXPECT_THROW(OpenBag(Write("z.mcap", "nothing of the kind")), InputError);
}

TEST_F(OpenBagTest, AChunkThatClaimsATerabyteIsNamed) {
  const std::string described =
      McapSchemaBytes(1, "sensor_msgs/msg/LaserScan") + McapChannelBytes(1, 1, "/scan");
  const std::string bomb = Write(
      "bomb.mcap", McapBytes(described + McapChunkBytes(1, "packed", 1000000000000, 0, "zstd")));
  EXPECT_NE(Refusal(bomb).find("claims to unpack to 1000000000000 bytes"), std::string::npos)
      << Refusal(bomb);
  const std::string malformed =
      Write("malformed.mcap", McapBytes(described + McapMessageBytes(1, 1, "no scan")));
  EXPECT_NE(Refusal(malformed).find("all 1 are malformed"), std::string::npos)
      << Refusal(malformed);
}

}  // namespace
}  // namespace masked_mapper
