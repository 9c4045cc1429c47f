// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/octree.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "masked_mapper/rendering/space_votes.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

OccupancyGrid GridOf(int column0, int row0, int width, int height, Cell cell) {
  OccupancyGrid grid;
  grid.origin_x = column0 * grid.resolution_m;
  grid.origin_y = row0 * grid.resolution_m;
  grid.width = width;
  grid.height = height;
  grid.cells.assign(static_cast<std::size_t>(width * height), cell);
  return grid;
}

// Rooms and rubbish: rectangles of random states on unknown ground.
OccupancyGrid RandomGrid(std::mt19937* random) {
  const auto draw = [random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(*random);
  };
  OccupancyGrid grid =
      GridOf(draw(-70, 20), draw(-70, 20), draw(1, 60), draw(1, 60), Cell::kUnknown);
  for (int i = 0; i < 12; ++i) {
    const int x0 = draw(0, grid.width - 1);
    const int y0 = draw(0, grid.height - 1);
    const int x1 = draw(x0, grid.width - 1);
    const int y1 = draw(y0, grid.height - 1);
    const auto cell = static_cast<Cell>(draw(0, 2));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        grid.cells[static_cast<std::size_t>(y * grid.width + x)] = cell;
      }
    }
  }
  return grid;
}

// What a voxel should be, by its key relative to the origin, said without any tree.
Cell Expected(const std::vector<FloorLayer>& floors, int x, int y, int z, int wall_voxels,
              int slab_voxels) {
  bool free = false;
  for (const FloorLayer& floor : floors) {
    const double resolution = floor.grid->resolution_m;
    const long column = x - std::lround(floor.grid->origin_x / resolution);
    const long row = y - std::lround(floor.grid->origin_y / resolution);
    if (column < 0 || row < 0 || column >= floor.grid->width || row >= floor.grid->height) continue;
    const Cell cell = floor.grid->at(static_cast<int>(column), static_cast<int>(row));
    const long bottom = std::lround(floor.elevation / resolution);
    long slab = bottom;
    while (slab % slab_voxels != 0) ++slab;
    if (cell == Cell::kOccupied && z >= bottom && z < bottom + wall_voxels) return Cell::kOccupied;
    if (cell == Cell::kFree && z >= slab && z < slab + slab_voxels) free = true;
  }
  return free ? Cell::kFree : Cell::kUnknown;
}

Cell StateOf(const octomap::OcTree& tree, int x, int y, int z) {
  const auto key = [](int k) { return static_cast<octomap::key_type>(k + 32768); };
  const octomap::OcTreeNode* node = tree.search(octomap::OcTreeKey(key(x), key(y), key(z)));
  if (node == nullptr) return Cell::kUnknown;
  return tree.isNodeOccupied(node) ? Cell::kOccupied : Cell::kFree;
}

TEST(BuildOctree, EqualsTheTreeFilledVoxelByVoxel) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    OctreeOptions options;
    options.wall_height_m = 0.05 * (1 + trial % 11);
    options.free_height_m = 0.05 * (1 << trial % 4);
    const OccupancyGrid first = RandomGrid(&random);
    const OccupancyGrid second = RandomGrid(&random);
    const double above = 0.05 * static_cast<double>(random() % 20) - 0.5;  // often overlapping
    const std::vector<FloorLayer> floors{{&first, 0.3}, {&second, above}};
    const OctreeData data = BuildOctree(floors, options);
    const auto tree = OcTreeOf(data);

    octomap::OcTree plain(0.05);
    for (int x = -75; x < 85; ++x) {
      for (int y = -75; y < 85; ++y) {
        for (int z = -16; z < 32; ++z) {
          const Cell expected = Expected(floors, x, y, z, 1 + trial % 11, 1 << trial % 4);
          if (expected == Cell::kUnknown) continue;
          const octomap::OcTreeKey key(static_cast<octomap::key_type>(x + 32768),
                                       static_cast<octomap::key_type>(y + 32768),
                                       static_cast<octomap::key_type>(z + 32768));
          plain.setNodeValue(key,
                             expected == Cell::kOccupied ? plain.getClampingThresMaxLog()
                                                         : plain.getClampingThresMinLog(),
                             true);
        }
      }
    }
    plain.updateInnerOccupancy();
    plain.prune();
    EXPECT_TRUE(*tree == plain) << "trial " << trial << ": " << tree->size() << " nodes, expected "
                                << plain.size();
    EXPECT_EQ(data.nodes, plain.size());
    std::ostringstream bytes;
    plain.writeBinaryData(bytes);
    EXPECT_TRUE(data.bytes == bytes.str()) << "trial " << trial;
  }
}

TEST(BuildOctree, LooksUpAsTheGrid) {
  OccupancyGrid grid = GridOf(-13, 40, 50, 30, Cell::kFree);
  for (int x = 0; x < 50; ++x) grid.cells[static_cast<std::size_t>(x)] = Cell::kOccupied;
  grid.cells[77] = Cell::kUnknown;
  const double elevation = 3.7;
  const auto tree = OcTreeOf(BuildOctree({{&grid, elevation}}, {}));
  // 3.7 m is voxel 74; the next multiple of 16 is 80.
  for (int row = -2; row < 32; ++row) {
    for (int column = -2; column < 52; ++column) {
      const bool inside = row >= 0 && column >= 0 && row < 30 && column < 50;
      const Cell cell = inside ? grid.at(column, row) : Cell::kUnknown;
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 80), cell);
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 95), cell);
      const Cell wall = cell == Cell::kOccupied ? cell : Cell::kUnknown;
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 74), wall);
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 105), wall);
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 73), Cell::kUnknown);
      EXPECT_EQ(StateOf(*tree, column - 13, row + 40, 106), Cell::kUnknown);
    }
  }
}

TEST(BuildOctree, AlignedSlabPrunesWhatOneLayerCannot) {
  const OccupancyGrid floor = GridOf(-320, -320, 640, 640, Cell::kFree);  // 32 x 32 m
  OctreeOptions layer;
  layer.free_height_m = 0.05;
  const std::size_t one_layer = BuildOctree({{&floor, 0.0}}, layer).nodes;
  const std::size_t slab = BuildOctree({{&floor, 0.0}}, {}).nodes;
  EXPECT_GT(one_layer, 500000U);
  EXPECT_LT(slab, 2500U);
}

TEST(BuildOctree, HeightsLeaveOutWhatIsOutside) {
  std::mt19937 random(3);
  const OccupancyGrid lower = RandomGrid(&random);
  const OccupancyGrid upper = RandomGrid(&random);
  const std::vector<FloorLayer> floors = {{&lower, 0.0}, {&upper, 1.0}};
  const auto whole = OcTreeOf(BuildOctree(floors, {}));
  const double resolution = lower.resolution_m;
  for (const HeightBand& heights : {HeightBand{0.31, 1.24}, HeightBand{-9.0, 0.5},
                                    HeightBand{1.0, 9.0}, HeightBand{0.9, 0.9}}) {
    const auto cut = OcTreeOf(BuildOctree(floors, {}, heights));
    for (int i = 0; i < 20000; ++i) {
      const int x = static_cast<int>(random() % 160) - 80;
      const int y = static_cast<int>(random() % 160) - 80;
      const int z = static_cast<int>(random() % 70) - 5;
      const double middle = (z + 0.5) * resolution;
      const bool inside = middle >= heights.low_m && middle <= heights.high_m;
      ASSERT_EQ(StateOf(*cut, x, y, z), inside ? StateOf(*whole, x, y, z) : Cell::kUnknown)
          << "voxel " << x << " " << y << " " << z;
    }
  }
}

TEST(BuildOctree, NothingGivesAnEmptyTree) {
  const OccupancyGrid empty;
  const OccupancyGrid unknown = GridOf(0, 0, 3, 4, Cell::kUnknown);
  EXPECT_EQ(BuildOctree({}, {}).nodes, 0U);
  EXPECT_EQ(BuildOctree({{&empty, 0.0}, {&unknown, 3.0}}, {}).nodes, 0U);
}

TEST(BuildOctree, BuildingBeyondTheKeysIsRefused) {
  const OccupancyGrid last = GridOf(32767, -32768, 1, 1, Cell::kFree);
  EXPECT_GT(BuildOctree({{&last, 0.0}}, {}).nodes, 0U);
  const OccupancyGrid beyond = GridOf(32767, 0, 2, 1, Cell::kFree);
  EXPECT_THROW(BuildOctree({{&beyond, 0.0}}, {}), InputError);
  EXPECT_THROW(BuildOctree({{&last, 1700.0}}, {}), InputError);
  EXPECT_THROW(BuildOctree({{&last, std::nan("")}}, {}), InputError);
  try {
    BuildOctree({{&beyond, 0.0}}, {});
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1638 m"), std::string::npos) << error.what();
  }
}

// What a search in the tree finds is what the states say, voxel by voxel.
TEST(Octree, OfStatesInSpaceIsWhatTheyAre) {
  std::mt19937 random(3);
  std::vector<SpaceBlock> blocks;
  for (const VoxelIndex& at : {VoxelIndex{-1, 0, 0}, VoxelIndex{0, 0, 0}, VoxelIndex{3, -2, 1}}) {
    blocks.emplace_back();
    blocks.back().at = at;
    // Cubes of one state, which the tree merges, and rubbish.
    for (std::size_t i = 0; i < kSpaceBlockVoxels; ++i) {
      blocks.back().cells[i] = i < 2048 ? Cell::kFree : static_cast<Cell>(random() % 3);
    }
  }
  blocks[1].cells.fill(Cell::kOccupied);
  const SpaceStates states(0.05, blocks);
  const HeightBand heights{-0.1, 1.0};
  const auto tree = OcTreeOf(BuildSpaceOctree({&states}, heights));
  for (int z = -2; z < 34; ++z) {
    for (int y = -34; y < 18; ++y) {
      for (int x = -18; x < 66; ++x) {
        const double height = (z + 0.5) * 0.05;
        const Cell expected = height > 1.0 ? Cell::kUnknown : states.At({x, y, z});
        const octomap::OcTreeNode* node = tree->search((x + 0.5) * 0.05, (y + 0.5) * 0.05, height);
        const Cell found = node == nullptr               ? Cell::kUnknown
                           : tree->isNodeOccupied(*node) ? Cell::kOccupied
                                                         : Cell::kFree;
        ASSERT_EQ(found, expected) << x << " " << y << " " << z;
      }
    }
  }
  EXPECT_LT(tree->size(), 3U * kSpaceBlockVoxels);
}

TEST(Octree, OfStatesBeyondItsReachIsRefused) {
  std::vector<SpaceBlock> blocks(1);
  blocks[0].at = {2048, 0, 0};
  blocks[0].cells.fill(Cell::kFree);
  const SpaceStates states(0.05, blocks);
  EXPECT_THROW(BuildSpaceOctree({&states}), InputError);
}

}  // namespace
}  // namespace masked_mapper
