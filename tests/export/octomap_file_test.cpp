// SPDX-License-Identifier: BSD-3-Clause
#include "export/octomap_file.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <stdexcept>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

octomap::point3d PointOf(int i) { return {0.1F * static_cast<float>(i), 1.0F, 2.0F}; }

TEST(OctomapFile, OctomapReadsTheSameTree) {
  octomap::OcTree tree(0.05);
  for (int i = 0; i < 40; ++i) tree.updateNode(PointOf(i), i % 3 == 0);
  const TestFolder folder;
  WriteOctomap(tree, folder / "tree.bt");
  octomap::OcTree read(1.0);
  ASSERT_TRUE(read.readBinary((folder / "tree.bt").string()));
  EXPECT_EQ(read.getResolution(), 0.05);
  EXPECT_EQ(read.size(), tree.size());
  for (int i = 0; i < 40; ++i) {
    const auto* node = read.search(PointOf(i));
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(read.isNodeOccupied(node), i % 3 == 0);
  }
}

TEST(OctomapFile, EmptyTreeIsAFileToo) {
  const TestFolder folder;
  WriteOctomap(octomap::OcTree(0.1), folder / "tree.bt");
  octomap::OcTree read(1.0);
  EXPECT_TRUE(read.readBinary((folder / "tree.bt").string()));
  EXPECT_EQ(read.size(), 0U);
}

TEST(OctomapFile, FullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(WriteOctomap(octomap::OcTree(0.1), "/dev/full"), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
