// SPDX-License-Identifier: BSD-3-Clause
#include "doubt/place_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace masked_mapper {
namespace {

TEST(PlaceIndex, FindsAllThatReachesAPlace) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-20.0, 20.0);
  std::uniform_real_distribution<double> reaches(0.0, 5.0);
  PlaceIndex index(1.7);
  struct Thing {
    FloorId floor;
    Eigen::Vector2d at;
    double reach_m;
  };
  std::vector<Thing> things;
  for (std::size_t i = 0; i < 400; ++i) {
    things.push_back({static_cast<FloorId>(i % 3), {any(random), any(random)}, reaches(random)});
    index.Add(things.back().floor, things.back().at, things.back().reach_m, i);
  }
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector2d place(any(random), any(random));
    const auto floor = static_cast<FloorId>(trial % 3);
    const std::vector<std::size_t>& near = index.Near(floor, place);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    const std::set<std::size_t> found(near.begin(), near.end());
    EXPECT_EQ(found.size(), near.size());
    for (std::size_t i = 0; i < things.size(); ++i) {
      const double off = (things[i].at - place).cwiseAbs().maxCoeff();
      if (things[i].floor == floor && off <= things[i].reach_m) {
        EXPECT_EQ(found.count(i), 1U) << "thing " << i << ", " << off << " m off";
      } else if (things[i].floor != floor || off > things[i].reach_m + 1.7) {
        EXPECT_EQ(found.count(i), 0U) << "thing " << i << ", " << off << " m off";
      }
    }
  }
}

TEST(PlaceIndex, OfNothingHoldsNothing) {
  EXPECT_TRUE(PlaceIndex(1.0).Near(0, {0.0, 0.0}).empty());
}

}  // namespace
}  // namespace masked_mapper
