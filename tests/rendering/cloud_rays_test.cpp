// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/cloud_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace masked_mapper {
namespace {

VoxelIndex VoxelOf(const Eigen::Vector3d& place) {
  return {static_cast<std::int32_t>(std::floor(place.x())),
          static_cast<std::int32_t>(std::floor(place.y())),
          static_cast<std::int32_t>(std::floor(place.z()))};
}

std::set<VoxelIndex> VoxelsOf(const CloudRays& rays, CloudRays::Bits CloudRays::Block::*bits) {
  std::set<VoxelIndex> voxels;
  for (const CloudRays::Block& block : rays.blocks()) {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(kSpaceBlockVoxels); ++i) {
      const auto word = static_cast<std::size_t>(i) / 64;
      if (((block.*bits)[word] >> (i % 64) & 1U) == 0) continue;
      voxels.insert({kSpaceBlockSide * block.at[0] + i % kSpaceBlockSide,
                     kSpaceBlockSide * block.at[1] + i / kSpaceBlockSide % kSpaceBlockSide,
                     kSpaceBlockSide * block.at[2] + i / kSpaceBlockSide / kSpaceBlockSide});
    }
  }
  return voxels;
}

/// How much of the way from `from` to `to` lies in a voxel, shares of it; not positive: none.
double ShareWithin(const VoxelIndex& voxel, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& to) {
  double begin = 0.0;
  double end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = voxel[static_cast<std::size_t>(axis)] - from(axis);
    const double along = to(axis) - from(axis);
    const double one = low / along;
    const double other = (low + 1.0) / along;
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  return end - begin;
}

Eigen::Vector3d RandomPlace(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> place(-reach, reach);
  const double x = place(random);
  const double y = place(random);
  return {x, y, place(random)};
}

TEST(CloudRaysTest, ARayPassesTheVoxelsThatItLiesIn) {
  std::mt19937 random(5);
  CloudRays rays;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d lidar = RandomPlace(random, 30.0);
    const Eigen::Vector3d end = lidar + RandomPlace(random, trial % 3 == 0 ? 1.0 : 60.0);
    rays.Begin(lidar);
    rays.Pass(end);
    const std::set<VoxelIndex> passed = VoxelsOf(rays, &CloudRays::Block::passed);
    for (const VoxelIndex& voxel : passed) {
      EXPECT_GT(ShareWithin(voxel, lidar, end), -1e-6)
          << voxel[0] << ' ' << voxel[1] << ' ' << voxel[2];
    }
    for (double share = 0.0; share <= 1.0; share += 1e-4) {
      const VoxelIndex voxel = VoxelOf(lidar + share * (end - lidar));
      if (ShareWithin(voxel, lidar, end) < 1e-6) continue;  // it is touched at a corner
      EXPECT_EQ(passed.count(voxel), 1U) << voxel[0] << ' ' << voxel[1] << ' ' << voxel[2];
    }
  }
}

TEST(CloudRaysTest, RaysAlongTheAxesAndOfNoLength) {
  CloudRays rays;
  rays.Begin({0.5, 0.5, 0.5});
  rays.Pass({0.5, 0.5, 0.5});
  EXPECT_TRUE(VoxelsOf(rays, &CloudRays::Block::passed).empty());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      rays.Begin({0.5, 0.5, 0.5});
      Eigen::Vector3d end(0.5, 0.5, 0.5);
      end(axis) += sign * 40.0;
      rays.Pass(end);
      EXPECT_EQ(VoxelsOf(rays, &CloudRays::Block::passed).size(), 41U) << axis;
    }
  }
}

// Of a whole turn of rays, those that end early leave out next to nothing.
TEST(CloudRaysTest, RaysThatEndWhereTheyBecomeOneLeaveHardlyAnythingOut) {
  const Eigen::Vector3d lidar(3.3, -2.1, 10.4);
  CloudRays together;
  together.Begin(lidar);
  std::set<VoxelIndex> each;
  CloudRays alone;
  for (int ring = 0; ring < 16; ++ring) {
    for (int column = 0; column < 900; ++column) {
      const double turn = 2.0 * M_PI * column / 900.0;
      const double slope = std::tan((2.0 * ring - 15.0) * M_PI / 180.0);
      const Eigen::Vector3d end =
          lidar + 120.0 * Eigen::Vector3d(std::cos(turn), std::sin(turn), slope);
      together.Pass(end);
      alone.Begin(lidar);
      alone.Pass(end);
      const std::set<VoxelIndex> passed = VoxelsOf(alone, &CloudRays::Block::passed);
      each.insert(passed.begin(), passed.end());
    }
  }
  const std::set<VoxelIndex> passed = VoxelsOf(together, &CloudRays::Block::passed);
  for (const VoxelIndex& voxel : passed) EXPECT_EQ(each.count(voxel), 1U);
  EXPECT_GT(static_cast<double>(passed.size()), 0.95 * static_cast<double>(each.size()));
}

TEST(CloudRaysTest, TellsTheFirstHitOfAVoxel) {
  CloudRays rays;
  rays.Begin({0.0, 0.0, 0.0});
  EXPECT_TRUE(rays.Hit({-1, 200, 3}));
  EXPECT_FALSE(rays.Hit({-1, 200, 3}));
  EXPECT_TRUE(rays.Hit({-2, 200, 3}));
  EXPECT_EQ(VoxelsOf(rays, &CloudRays::Block::hit),
            (std::set<VoxelIndex>{{-2, 200, 3}, {-1, 200, 3}}));
  rays.Begin({0.0, 0.0, 0.0});
  EXPECT_TRUE(rays.Hit({-1, 200, 3}));
}

}  // namespace
}  // namespace masked_mapper
