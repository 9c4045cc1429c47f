// SPDX-License-Identifier: BSD-3-Clause
#include "export/point_cloud_file.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cstring>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

ColouredCloud SampleCloud() {
  pcl::PointCloud<pcl::PointXYZL> cloud;
  cloud.push_back({1.5F, -2.25F, 0.0F, 0});
  cloud.push_back({3.0F, 4.0F, -3.5F, 1});
  cloud.push_back({-1.0F, 0.125F, 7.0F, 2});
  return Coloured(cloud, {{1, 2, 3}, {40, 50, 60}, {255, 128, 0}});
}

void ExpectSame(const ColouredCloud& read, const ColouredCloud& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(read[i].x, written[i].x);
    EXPECT_EQ(read[i].y, written[i].y);
    EXPECT_EQ(read[i].z, written[i].z);
    EXPECT_EQ(read[i].r, written[i].r);
    EXPECT_EQ(read[i].g, written[i].g);
    EXPECT_EQ(read[i].b, written[i].b);
    EXPECT_EQ(read[i].label, written[i].label);
  }
}

TEST(PointCloudFile, PclReadsThePcd) {
  const TestFolder folder;
  WritePcd(SampleCloud(), folder / "a.pcd");
  ColouredCloud read;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), read), 0);
  ExpectSame(read, SampleCloud());
}

TEST(PointCloudFile, PcdHasTheBytesThatPclWrites) {
  const TestFolder folder;
  WritePcd(SampleCloud(), folder / "ours.pcd");
  ASSERT_EQ(pcl::io::savePCDFileBinary((folder / "theirs.pcd").string(), SampleCloud()), 0);
  EXPECT_EQ(ReadBytes(folder / "ours.pcd"), ReadBytes(folder / "theirs.pcd"));
}

TEST(PointCloudFile, PclReadsThePly) {
  const TestFolder folder;
  WritePly(SampleCloud(), folder / "a.ply");
  ColouredCloud read;
  ASSERT_EQ(pcl::io::loadPLYFile((folder / "a.ply").string(), read), 0);
  ExpectSame(read, SampleCloud());
}

TEST(PointCloudFile, PlyHoldsRowsOfNineteenBytes) {
  const TestFolder folder;
  WritePly(SampleCloud(), folder / "a.ply");
  const std::string bytes = ReadBytes(folder / "a.ply");
  const std::size_t start = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - start, 3U * 19U);
  float y = 0.0F;
  std::memcpy(&y, bytes.data() + start + 4, sizeof(y));
  EXPECT_EQ(y, -2.25F);
  EXPECT_EQ(static_cast<unsigned char>(bytes[start + 2 * 19 + 12]), 255U);
  EXPECT_EQ(bytes[start + 2 * 19 + 15], 2);
}

TEST(PointCloudFile, EmptyCloudsAreFilesToo) {
  const TestFolder folder;
  WritePcd({}, folder / "a.pcd");
  WritePly({}, folder / "a.ply");
  EXPECT_NE(ReadBytes(folder / "a.pcd").find("POINTS 0\n"), std::string::npos);
  EXPECT_NE(ReadBytes(folder / "a.ply").find("element vertex 0\n"), std::string::npos);
}

TEST(PointCloudFile, FloorsGetLighterUpwards) {
  std::vector<Floor> floors;
  for (const double elevation : {3.0, 0.0, 9.0, 6.0, -3.0, 6.0}) floors.push_back({"", elevation});
  const std::vector<Colour> colours = FloorColours(floors);
  const auto lightness = [&colours](std::size_t floor) {
    return 0.2126 * colours[floor].red + 0.7152 * colours[floor].green +
           0.0722 * colours[floor].blue;
  };
  const std::vector<std::size_t> upwards{4, 1, 0, 3, 5, 2};
  for (std::size_t i = 1; i < upwards.size(); ++i) {
    EXPECT_GT(lightness(upwards[i]), lightness(upwards[i - 1]) + 10.0);
  }
  EXPECT_EQ(FloorColours({{"0"}}).size(), 1U);
  EXPECT_TRUE(FloorColours({}).empty());
}

}  // namespace
}  // namespace masked_mapper
