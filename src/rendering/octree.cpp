// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/octree.hpp"

// OctoMap prints from its headers in debug builds unless told not to.
#ifndef OCTOMAP_NODEBUGOUT
#define OCTOMAP_NODEBUGOUT
#endif
#include <octomap/octomap.h>

#include <cassert>

#include "floor_volume.hpp"
#include "space_volume.hpp"

namespace masked_mapper {
namespace {

// OctoMap offers no way to make the root alone.
class RootedTree : public octomap::OcTree {
 public:
  using octomap::OcTree::OcTree;

  octomap::OcTreeNode* MakeRoot() {
    assert(root == nullptr);
    root = new octomap::OcTreeNode();
    ++tree_size;
    size_changed = true;
    return root;
  }
};

// Fills the tree from the top, so that what is alike is one node from the start.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<std::unique_ptr<Volume>>& floors, RootedTree* tree)
      : floors_(floors), tree_(tree) {}

  void Build() {
    const Block all{{}, kTreeDepth};
    const States states = At(all);
    if (states != kUnknownBit) Fill(tree_->MakeRoot(), all, states);
  }

 private:
  // Floors that know nothing of the block have no say in it.
  States At(const Block& block) const {
    States states = 0;
    for (const std::unique_ptr<Volume>& floor : floors_) {
      const States of_floor = floor->At(block);
      if (of_floor != kUnknownBit) states |= of_floor;
    }
    if (states == 0) return kUnknownBit;
    if (block.level > 0) return states;
    return states & kOccupiedBit ? kOccupiedBit : kFreeBit;
  }

  void Fill(octomap::OcTreeNode* node, const Block& block, States states) {
    if (states == kOccupiedBit) {
      node->setLogOdds(tree_->getClampingThresMaxLog());
    } else if (states == kFreeBit) {
      node->setLogOdds(tree_->getClampingThresMinLog());
    } else {
      FillChildren(node, block);
    }
  }

  void FillChildren(octomap::OcTreeNode* node, const Block& block) {
    const int half = 1 << (block.level - 1);
    for (unsigned int child = 0; child < 8; ++child) {
      Block part{block.key, block.level - 1};
      for (unsigned int axis = 0; axis < 3; ++axis) {
        if (child >> axis & 1U) part.key[axis] += half;
      }
      const States states = At(part);
      if (states != kUnknownBit) Fill(tree_->createNodeChild(node, child), part, states);
    }
    // Where floors overlap, a block may look mixed and yet come out uniform.
    if (!tree_->pruneNode(node)) node->updateOccupancyChildren();
  }

  const std::vector<std::unique_ptr<Volume>>& floors_;
  RootedTree* tree_;
};

}  // namespace

std::shared_ptr<octomap::OcTree> BuildOctree(const std::vector<FloorLayer>& floors,
                                             const OctreeOptions& options,
                                             const HeightBand& heights) {
  assert(options.wall_height_m > 0.0 && options.free_height_m > 0.0);
  double resolution = GridOptions().resolution_m;
  std::vector<std::unique_ptr<Volume>> volumes;
  for (const FloorLayer& floor : floors) {
    if (floor.grid->cells.empty()) continue;
    assert(volumes.empty() || floor.grid->resolution_m == resolution);
    resolution = floor.grid->resolution_m;
    volumes.push_back(VolumeOf(floor, options, heights));
  }
  auto tree = std::make_shared<RootedTree>(resolution);
  TreeBuilder(volumes, tree.get()).Build();
  return tree;
}

std::shared_ptr<octomap::OcTree> BuildSpaceOctree(const std::vector<const SpaceStates*>& floors,
                                                  const HeightBand& heights) {
  double resolution = GridOptions().resolution_m;
  std::vector<std::unique_ptr<Volume>> volumes;
  for (const SpaceStates* floor : floors) {
    if (floor->blocks().empty()) continue;
    assert(volumes.empty() || floor->resolution_m() == resolution);
    resolution = floor->resolution_m();
    volumes.push_back(VolumeOf(*floor, heights));
  }
  auto tree = std::make_shared<RootedTree>(resolution);
  TreeBuilder(volumes, tree.get()).Build();
  return tree;
}

}  // namespace masked_mapper
