// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/surface_patch.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <random>

namespace masked_mapper {
namespace {

TEST(SurfacePatchTest, FacesAsTheHitsDo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> along(0.0F, 0.2F);
  std::normal_distribution<float> across(0.0F, 0.01F);
  const Eigen::Vector3f normal = Eigen::Vector3f(1.0F, 2.0F, 0.5F).normalized();
  const Eigen::Vector3f a = normal.unitOrthogonal();
  const Eigen::Vector3f b = normal.cross(a);
  SurfacePatch patch;
  for (int i = 0; i < 200; ++i) {
    patch.Add(0.4F * Eigen::Vector3f::Ones() + along(random) * a + along(random) * b +
              across(random) * normal);
  }
  const auto found = patch.Normal(0.03F);
  ASSERT_TRUE(found);
  EXPECT_GT(std::abs(found->dot(normal)), 0.99F);
  EXPECT_FALSE(patch.Normal(0.03F) && !found);  // asked again, it says the same
}

TEST(SurfacePatchTest, FewHitsALineAndAnEdgeFaceNoWay) {
  SurfacePatch few;
  for (int i = 0; i < 5; ++i)
    few.Add({0.1F * static_cast<float>(i % 2), 0.05F * static_cast<float>(i), 0.0F});
  EXPECT_FALSE(few.Normal(0.03F));
  SurfacePatch line;
  SurfacePatch edge;
  for (int i = 0; i < 100; ++i) {
    const float s = 0.002F * static_cast<float>(i);
    line.Add({s, 0.0F, 0.0F});
    const float t = 0.01F * static_cast<float>(i % 20);
    edge.Add(i % 2 == 0 ? Eigen::Vector3f(s, t, 0.0F) : Eigen::Vector3f(s, 0.0F, t));
  }
  EXPECT_FALSE(line.Normal(0.03F));
  EXPECT_FALSE(edge.Normal(0.03F));
}

}  // namespace
}  // namespace masked_mapper
