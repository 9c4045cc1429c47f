// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/packed_cloud.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

LevelledCloud RoomAbove(double floor) {
  LevelledCloud cloud;
  cloud.points = RoomCloud().Seen();
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (CloudPoint& point : cloud.points) {
    for (int axis = 0; axis < 3; ++axis) point.position(axis) += noise(random);
    point.position.z() += static_cast<float>(floor);
    point.intensity = std::abs(point.position.x()) * 10.0F;
    point.time = 0.01F;
  }
  cloud.lidar = {0.125, -0.25, 0.6};
  return cloud;
}

/// What packing comes to, the plain way: voxels from the lowest to the highest.
std::map<std::array<int, 3>, std::vector<CloudPoint>> VoxelsOf(const CloudPoints& points) {
  std::map<std::array<int, 3>, std::vector<CloudPoint>> voxels;
  for (const CloudPoint& point : points) {
    std::array<int, 3> index{};
    for (int axis = 0; axis < 3; ++axis) {
      index[static_cast<std::size_t>(2 - axis)] = static_cast<int>(
          std::floor(point.position(axis) * static_cast<float>(1.0 / kPackedVoxel_m)));
    }
    voxels[index].push_back(point);
  }
  return voxels;
}

TEST(PackedCloudTest, OfEachVoxelTheMeanIsKept) {
  LevelledCloud cloud = RoomAbove(0.6);
  cloud.ceiling_m = 2.75;
  const std::string bytes = PackCloud(cloud);
  const auto unpacked = UnpackCloud(bytes);
  ASSERT_TRUE(unpacked);
  EXPECT_TRUE(unpacked->lidar.isApprox(cloud.lidar, 1e-6));
  EXPECT_EQ(unpacked->ceiling_m, 2.75);
  const auto voxels = VoxelsOf(cloud.points);
  ASSERT_EQ(unpacked->points.size(), voxels.size());
  EXPECT_LT(bytes.size(), 4 * voxels.size());
  std::size_t i = 0;
  for (const auto& [index, points] : voxels) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    float intensity = 0.0F;
    for (const CloudPoint& point : points) {
      mean += point.position / static_cast<float>(points.size());
      intensity += point.intensity / static_cast<float>(points.size());
    }
    const CloudPoint& kept = unpacked->points[i++];
    EXPECT_LT((kept.position - mean).cwiseAbs().maxCoeff(), kPackedVoxel_m / 8.0 + 1e-4);
    EXPECT_NEAR(kept.intensity, intensity, 60.0 / 255.0);
  }
}

TEST(PackedCloudTest, WhatIsPackedAgainStaysInItsVoxels) {
  const std::string once = PackCloud(RoomAbove(0.0));
  EXPECT_EQ(UnpackCloud(PackCloud(*UnpackCloud(once)))->points.size(),
            UnpackCloud(once)->points.size());
}

TEST(PackedCloudTest, NothingAndWhatIsFarAwayIsLeftOut) {
  LevelledCloud cloud;
  ASSERT_TRUE(UnpackCloud(PackCloud(cloud)));
  EXPECT_TRUE(UnpackCloud(PackCloud(cloud))->points.empty());
  EXPECT_FALSE(UnpackCloud(PackCloud(cloud))->ceiling_m);
  CloudPoint point;
  for (const float x : {0.0F, -0.01F, 99.0F, -99.0F, 1e4F, -1e4F}) {
    point.position.x() = x;
    point.intensity = x == 0.0F ? std::nanf("") : -5.0F;
    cloud.points.push_back(point);
  }
  const auto unpacked = UnpackCloud(PackCloud(cloud));
  ASSERT_TRUE(unpacked);
  EXPECT_EQ(unpacked->points.size(), 4U);
  for (const CloudPoint& kept : unpacked->points) EXPECT_EQ(kept.intensity, 0.0F);
}

TEST(PackedCloudTest, WhatIsCutOrChangedIsNoCloudOrAnother) {
  LevelledCloud cloud = RoomAbove(0.0);
  cloud.points.resize(500);
  const std::string bytes = PackCloud(cloud);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(UnpackCloud(bytes.substr(0, size))) << size;
  }
  EXPECT_FALSE(UnpackCloud(bytes + "x"));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const unsigned flip : {0x01U, 0x80U, 0xffU}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
      const auto unpacked = UnpackCloud(changed);
      if (!unpacked) continue;
      for (const CloudPoint& point : unpacked->points) ASSERT_TRUE(point.position.allFinite());
    }
  }
}

TEST(PackedCloudTest, MoreVoxelsThanBytesAreNoCloud) {
  std::string bytes = PackCloud(RoomAbove(0.0));
  for (const std::uint32_t voxels : {0U, 1U, 4000000000U, 0xffffffffU}) {
    std::memcpy(bytes.data() + 20, &voxels, sizeof(voxels));
    EXPECT_FALSE(UnpackCloud(bytes)) << voxels;
  }
}

}  // namespace
}  // namespace masked_mapper
