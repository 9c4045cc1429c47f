// SPDX-License-Identifier: BSD-3-Clause
#include "export/voxel_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

namespace masked_mapper {
namespace {

SpacePoint At(double x, double y, double z, std::uint32_t label = 0) {
  SpacePoint point;
  point.position = {x, y, z};
  point.label = label;
  return point;
}

TEST(VoxelCloudTest, IsTheMeanOfEachVoxel) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-2.0, 2.0);
  VoxelCloud cloud(0.5);
  std::map<std::tuple<int, int, int>, std::pair<Eigen::Vector3d, int>> expected;
  for (int i = 0; i < 3000; ++i) {
    const SpacePoint point = At(anywhere(random), anywhere(random), anywhere(random));
    cloud.Add(point);
    const Eigen::Vector3d cell = (point.position / 0.5).array().floor();
    auto& [sum, count] =
        expected
            .emplace(std::make_tuple(static_cast<int>(cell.x()), static_cast<int>(cell.y()),
                                     static_cast<int>(cell.z())),
                     std::make_pair(Eigen::Vector3d(0.0, 0.0, 0.0), 0))
            .first->second;
    sum += point.position;
    ++count;
  }
  const std::vector<SpacePoint> points = cloud.Points(1);
  ASSERT_EQ(points.size(), expected.size());
  for (const SpacePoint& point : points) {
    const Eigen::Vector3d cell = (point.position / 0.5).array().floor();
    const auto& [sum, count] = expected.at(
        {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
    EXPECT_LT((point.position - sum / count).norm(), 1e-5);
  }
}

TEST(VoxelCloudTest, FloorsDoNotMixAndStraysAreLeftOut) {
  VoxelCloud cloud(0.1);
  for (int i = 0; i < 3; ++i) cloud.Add(At(1.01, 1.01, 1.01, 0));
  for (int i = 0; i < 2; ++i) cloud.Add(At(1.01, 1.01, 1.01, 20));
  cloud.Add(At(5.0, 5.0, 5.0));
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud.Points(2).size(), 2U);
  EXPECT_EQ(cloud.Points(2).back().label, 20U);
}

TEST(VoxelCloudTest, WhatIsNoPlaceIsLeftOut) {
  VoxelCloud cloud(0.05);
  cloud.Add(At(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0));
  cloud.Add(At(1e12, 0.0, 0.0));
  EXPECT_EQ(cloud.size(), 0U);
}

}  // namespace
}  // namespace masked_mapper
