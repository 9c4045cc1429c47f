// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/space_votes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace masked_mapper {
namespace {

constexpr double kSide = 0.05;

VoxelIndex VoxelAt(double x, double y, double z) {
  return {static_cast<std::int32_t>(std::floor(x / kSide)),
          static_cast<std::int32_t>(std::floor(y / kSide)),
          static_cast<std::int32_t>(std::floor(z / kSide))};
}

TEST(SpaceVotesTest, ARayFreesWhatItPassesUpToTheSurface) {
  SpaceVotes votes({});
  for (int cloud = 0; cloud < 3; ++cloud) {
    votes.Add({0.01, 0.01, 0.52}, {{2.002F, 0.01F, 0.52F}, {2.002F, 0.01F, 0.53F}}, 0.0, {});
  }
  EXPECT_GT(votes.bytes(), 0U);
  const SpaceStates states = votes.Count();
  EXPECT_EQ(states.At(VoxelAt(2.02, 0.01, 0.52)), Cell::kOccupied);
  for (double x = 0.03; x < 1.95; x += kSide) {
    EXPECT_EQ(states.At(VoxelAt(x, 0.01, 0.52)), Cell::kFree) << x;
  }
  EXPECT_EQ(states.At(VoxelAt(1.97, 0.01, 0.52)), Cell::kUnknown);  // next to the surface
  EXPECT_EQ(states.At(VoxelAt(2.07, 0.01, 0.52)), Cell::kUnknown);
  EXPECT_EQ(states.At(VoxelAt(1.0, 0.2, 0.52)), Cell::kUnknown);
  EXPECT_TRUE(votes.Count().blocks().empty());  // counted once
}

TEST(SpaceVotesTest, OneHitIsNoWall) {
  SpaceVotes votes({});
  votes.Add({0.0, 0.0, 0.5}, {{2.02F, 0.01F, 0.52F}}, 0.0, {});
  EXPECT_EQ(votes.Count().At(VoxelAt(2.02, 0.01, 0.52)), Cell::kUnknown);
}

TEST(SpaceVotesTest, WhoWalkedByIsOutvoted) {
  SpaceVotes votes({});
  for (int cloud = 0; cloud < 60; ++cloud) {
    const bool somebody = cloud < 4;
    votes.Add({0.0, 0.0, 0.52}, {{somebody ? 1.02F : 3.02F, 0.01F, 0.52F}}, 0.0, {});
  }
  const SpaceStates states = votes.Count();
  EXPECT_EQ(states.At(VoxelAt(1.02, 0.007, 0.52)), Cell::kFree);
  EXPECT_EQ(states.At(VoxelAt(3.02, 0.01, 0.52)), Cell::kOccupied);
}

TEST(SpaceVotesTest, CountsThatAreFullKeepTheirProportion) {
  SpaceVotes votes({});
  // Passed 9 times of 10: nothing is there, however long one looks.
  for (int cloud = 0; cloud < 2000; ++cloud) {
    votes.Add({0.01, 0.01, 0.52}, {{cloud % 10 == 0 ? 1.02F : 3.02F, 0.01F, 0.52F}}, 0.0, {});
  }
  const SpaceStates states = votes.Count();
  EXPECT_EQ(states.At(VoxelAt(1.02, 0.01, 0.52)), Cell::kFree);
  EXPECT_EQ(states.At(VoxelAt(3.02, 0.01, 0.52)), Cell::kOccupied);
}

/// Rays that come in flat do not carve the floor and the wall along which they fly.
TEST(SpaceVotesTest, SurfacesSeenAtASlantStay) {
  SpaceVotes votes({});
  for (double x = 0.0; x < 6.0; x += 0.3) {
    const Eigen::Vector3d lidar(x, 0.0, 0.6);
    std::vector<Eigen::Vector3f> ends;
    for (int ring = 0; ring < 16; ++ring) {
      const double slope = std::tan((-15.0 + 2.0 * ring) * 0.0174533);
      for (int column = 0; column < 900; ++column) {
        const double turn = 0.0069813 * column;
        const Eigen::Vector3d ray(std::cos(turn), std::sin(turn), slope);
        double range = 20.0;
        if (slope < 0.0) range = std::min(range, 0.6 / -slope);
        if (ray.y() > 0.0) range = std::min(range, 1.02 / ray.y());
        if (range < 20.0) ends.push_back((lidar + range * ray).cast<float>());
      }
    }
    votes.Add(lidar, std::move(ends), 0.0, {});
  }
  const SpaceStates states = votes.Count();
  std::size_t floor = 0;
  std::size_t wall = 0;
  std::size_t floor_lost = 0;
  std::size_t wall_lost = 0;
  for (double x = 2.02; x < 6.0; x += kSide) {
    for (double y = -1.98; y < 0.9; y += kSide) {
      const Cell below = std::max(states.At(VoxelAt(x, y, -0.01)), states.At(VoxelAt(x, y, 0.01)));
      floor += below == Cell::kOccupied ? 1 : 0;
      floor_lost += below == Cell::kFree ? 1 : 0;
    }
    for (double z = 0.12; z < 1.0; z += kSide) {
      wall += states.At(VoxelAt(x, 1.02, z)) == Cell::kOccupied ? 1 : 0;
      wall_lost += states.At(VoxelAt(x, 1.02, z)) == Cell::kFree ? 1 : 0;
    }
  }
  EXPECT_GT(floor, 1000U);
  EXPECT_GT(wall, 1000U);
  EXPECT_LT(floor_lost, floor / 200);
  EXPECT_LT(wall_lost, wall / 200);
}

TEST(SpaceVotesTest, AnyNumberOfThreadsCountsTheSame) {
  std::vector<SpaceStates> counted;
  for (const int threads : {1, 3}) {
    SpaceVoteOptions options;
    options.threads = threads;
    SpaceVotes votes(options);
    for (int cloud = 0; cloud < 60; ++cloud) {
      std::vector<Eigen::Vector3f> ends;
      for (int ray = 0; ray < 500; ++ray) {
        const float turn = 0.0126F * static_cast<float>(ray);
        ends.emplace_back(0.1F * static_cast<float>(cloud) + 4.0F * std::cos(turn),
                          4.0F * std::sin(turn), 0.02F * static_cast<float>(ray % 100));
      }
      votes.Add({0.1 * cloud, 0.0, 0.6}, std::move(ends), 0.0, {});
    }
    counted.push_back(votes.Count());
  }
  ASSERT_EQ(counted[0].blocks().size(), counted[1].blocks().size());
  EXPECT_GT(counted[0].blocks().size(), 100U);
  for (std::size_t i = 0; i < counted[0].blocks().size(); ++i) {
    EXPECT_EQ(counted[0].blocks()[i].at, counted[1].blocks()[i].at);
    EXPECT_EQ(counted[0].blocks()[i].cells, counted[1].blocks()[i].cells);
  }
}

TEST(SpaceVotesTest, WhatIsNowhereIsLeftOut) {
  SpaceVotes votes({});
  const float nan = std::nanf("");
  votes.Add({0.0, 0.0, 0.5}, {{nan, 0.0F, 0.0F}, {1e20F, 0.0F, 0.0F}}, 0.0, {});
  votes.Add({0.0, 0.0, 0.5}, {{0.0F, 0.0F, 0.5F}}, 0.0, {});  // in the lidar itself
  EXPECT_LE(votes.Count().blocks().size(), 1U);
}

}  // namespace
}  // namespace masked_mapper
