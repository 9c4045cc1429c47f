// SPDX-License-Identifier: BSD-3-Clause
// What waits to be looked at in a search: blocks of grid poses.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "correlative_search.hpp"

namespace masked_mapper {

// Offsets [x 2^level, (x + 1) 2^level) x the same for y, at one angle of one problem.
struct GridBlock {
  double bound;
  std::int32_t problem;
  std::int32_t level;
  GridPose pose;
};

// The blocks of all problems, best bound first: to within a bucket of bounds, since no answer
// depends on the order within one and a bucket is cheaper to find than a place in a heap.
class BlockQueue {
 public:
  BlockQueue() : newest_(kBuckets, kNone) {}

  void Push(const GridBlock& block) {
    const std::size_t bucket = BucketOf(block.bound);
    entries_.push_back({block, newest_[bucket]});
    newest_[bucket] = static_cast<std::uint32_t>(entries_.size() - 1);
    best_ = std::max(best_, bucket);
  }

  /// Of a queue that is not empty.
  GridBlock Pop() {
    while (newest_[best_] == kNone) --best_;
    const Entry& entry = entries_[newest_[best_]];
    newest_[best_] = entry.older;
    return entry.block;
  }

  // Whether all blocks that come after one with `bound` are below `objective`.
  static bool IsBelow(double bound, double objective) {
    return bound < objective && BucketOf(bound) < BucketOf(objective);
  }

 private:
  struct Entry {
    GridBlock block;
    std::uint32_t older;
  };

  static constexpr std::size_t kBuckets = 4096;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  static std::size_t BucketOf(double bound) {
    return static_cast<std::size_t>(std::clamp(bound, 0.0, 1.0) * (kBuckets - 1));
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> newest_;  // of each bucket
  std::size_t best_ = 0;
};

}  // namespace masked_mapper
