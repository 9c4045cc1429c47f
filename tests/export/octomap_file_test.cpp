// SPDX-License-Identifier: BSD-3-Clause
#include "export/octomap_file.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <stdexcept>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(OctomapFile, OctomapReadsTheSameTree) {
  OccupancyGrid grid;
  grid.width = 40;
  grid.height = 3;
  for (int i = 0; i < 120; ++i) grid.cells.push_back(i % 3 == 0 ? Cell::kOccupied : Cell::kFree);
  const OctreeData tree = BuildOctree({{&grid, 0.0}}, {});
  const TestFolder folder;
  WriteOctomap(tree, folder / "tree.bt");
  octomap::OcTree read(1.0);
  ASSERT_TRUE(read.readBinary((folder / "tree.bt").string()));
  EXPECT_EQ(read.getResolution(), grid.resolution_m);
  EXPECT_EQ(read.size(), tree.nodes);
  for (int i = 0; i < 120; ++i) {
    const auto* node = read.search((i % 40 + 0.5) * grid.resolution_m,
                                   (i / 40 + 0.5) * grid.resolution_m, 0.5 * grid.resolution_m);
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(read.isNodeOccupied(node), i % 3 == 0);
  }
}

TEST(OctomapFile, EmptyTreeIsAFileToo) {
  const TestFolder folder;
  WriteOctomap(BuildOctree({}, {}), folder / "tree.bt");
  octomap::OcTree read(1.0);
  EXPECT_TRUE(read.readBinary((folder / "tree.bt").string()));
  EXPECT_EQ(read.size(), 0U);
}

TEST(OctomapFile, FullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(WriteOctomap(BuildOctree({}, {}), "/dev/full"), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
