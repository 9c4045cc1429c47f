// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/octree.hpp"

// OctoMap prints from its headers in debug builds unless told not to.
#ifndef OCTOMAP_NODEBUGOUT
#define OCTOMAP_NODEBUGOUT
#endif
#include <octomap/octomap.h>

#include <array>
#include <cassert>
#include <sstream>

#include "floor_volume.hpp"
#include "masked_mapper/rendering/space_votes.hpp"
#include "space_volume.hpp"

namespace masked_mapper {
namespace {

// Two bits of a node in its parent's bytes.
enum class Node : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kInner = 3 };

// Goes through the tree from the top, so that what is alike is one node from the start, and appends
// the bytes of a node before those of its children, as the format wants them: the tree itself is
// never there, which would take a hundred times as much as its file.
class TreeWriter {
 public:
  TreeWriter(const std::vector<std::unique_ptr<Volume>>& floors, OctreeData* tree) : tree_(tree) {
    for (const std::unique_ptr<Volume>& floor : floors) known_[kTreeDepth].push_back(floor.get());
  }

  void Write() {
    const Block all{{}, kTreeDepth};
    if (At(all, known_[kTreeDepth]) == kUnknownBit) return;
    tree_->nodes = 1;
    WriteChildren(all);
  }

 private:
  using Volumes = std::vector<const Volume*>;

  // Floors that know nothing of the block have no say in it, nor in its parts.
  States At(const Block& block, const Volumes& floors) {
    Volumes& known = known_[static_cast<std::size_t>(block.level)];
    if (&known != &floors) known.clear();
    States states = 0;
    for (const Volume* floor : floors) {
      const States of_floor = floor->At(block);
      if (of_floor == kUnknownBit) continue;
      states |= of_floor;
      if (&known != &floors) known.push_back(floor);
    }
    if (states == 0) return kUnknownBit;
    if (block.level > 0) return states;
    return states & kOccupiedBit ? kOccupiedBit : kFreeBit;
  }

  Node Write(const Block& block, States states) {
    if (states == kUnknownBit) return Node::kUnknown;
    ++tree_->nodes;
    if (states == kOccupiedBit) return Node::kOccupied;
    if (states == kFreeBit) return Node::kFree;
    return WriteChildren(block);
  }

  Node WriteChildren(const Block& block) {
    const std::size_t begin = tree_->bytes.size();
    tree_->bytes.append(2, '\0');
    const Volumes& known = known_[static_cast<std::size_t>(block.level)];
    const int half = 1 << (block.level - 1);
    unsigned bits = 0;
    for (unsigned child = 0; child < 8; ++child) {
      Block part{block.key, block.level - 1};
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (child >> axis & 1U) part.key[axis] += half;
      }
      bits |= static_cast<unsigned>(Write(part, At(part, known))) << (2 * child);
    }
    // Where floors overlap, a block may look mixed and yet come out uniform: then it has no bytes
    // of its own, nor had its children any.
    for (const Node uniform : {Node::kFree, Node::kOccupied}) {
      if (bits != 0x5555U * static_cast<unsigned>(uniform)) continue;
      tree_->bytes.resize(begin);
      tree_->nodes -= 8;
      return uniform;
    }
    tree_->bytes[begin] = static_cast<char>(bits & 0xFFU);
    tree_->bytes[begin + 1] = static_cast<char>(bits >> 8U);
    return Node::kInner;
  }

  std::array<Volumes, kTreeDepth + 1> known_;  ///< of the block at hand of each level
  OctreeData* tree_;
};

OctreeData TreeOf(const std::vector<std::unique_ptr<Volume>>& floors, double resolution_m) {
  OctreeData tree;
  tree.resolution_m = resolution_m;
  TreeWriter(floors, &tree).Write();
  return tree;
}

}  // namespace

OctreeData BuildOctree(const std::vector<FloorLayer>& floors, const OctreeOptions& options,
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
  return TreeOf(volumes, resolution);
}

OctreeData BuildSpaceOctree(const std::vector<const SpaceStates*>& floors,
                            const HeightBand& heights) {
  double resolution = GridOptions().resolution_m;
  std::vector<std::unique_ptr<Volume>> volumes;
  for (const SpaceStates* floor : floors) {
    if (floor->blocks().empty()) continue;
    assert(volumes.empty() || floor->resolution_m() == resolution);
    resolution = floor->resolution_m();
    volumes.push_back(VolumeOf(*floor, heights));
  }
  return TreeOf(volumes, resolution);
}

std::shared_ptr<octomap::OcTree> OcTreeOf(const OctreeData& data) {
  auto tree = std::make_shared<octomap::OcTree>(data.resolution_m);
  std::istringstream bytes(data.bytes);
  if (data.nodes > 0) tree->readBinaryData(bytes);
  assert(tree->size() == data.nodes);
  return tree;
}

}  // namespace masked_mapper
