// SPDX-License-Identifier: BSD-3-Clause
// Which voxels were entered, by open addressing: a set of the library's costs more than all the
// rest that is done with a cloud.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace masked_mapper {

class VoxelSet {
 public:
  /// For `most` insertions; voxels of `voxel_m` a side.
  VoxelSet(std::size_t most, double voxel_m) : voxel_(static_cast<float>(voxel_m)) {
    while (cells_.size() < 2 * most) {
      cells_.resize(2 * cells_.size());
      --unused_bits_;
    }
    std::fill(cells_.begin(), cells_.end(), kEmpty);
  }

  /// False when the voxel is there already. Two points are of one voxel also when they are a
  /// million voxels apart.
  bool Insert(const Eigen::Vector3f& point) {
    const std::uint64_t cell = CellOf(point);
    const std::size_t mask = cells_.size() - 1;
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
    // Only the uppermost bits of the product hang on all of the cell's.
    for (std::size_t i = cell * kGolden >> unused_bits_;; i = (i + 1) & mask) {
      if (cells_[i] == cell) return false;
      if (cells_[i] != kEmpty) continue;
      cells_[i] = cell;
      return true;
    }
  }

 private:
  // The library's own is a call where the processor need not be able to.
  static std::int64_t Floor(float value) {
    const auto whole = static_cast<std::int64_t>(value);
    return whole - (static_cast<float>(whole) > value ? 1 : 0);
  }

  std::uint64_t CellOf(const Eigen::Vector3f& point) const {
    constexpr std::uint64_t kBits = 21;
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto index = Floor(point(axis) / voxel_);
      cell = cell << kBits | (static_cast<std::uint64_t>(index) & ((1U << kBits) - 1));
    }
    return cell;
  }

  static constexpr std::uint64_t kEmpty = std::numeric_limits<std::uint64_t>::max();
  float voxel_;
  unsigned unused_bits_ = 60;  ///< of 64, for the first 16 places
  std::vector<std::uint64_t> cells_ = std::vector<std::uint64_t>(16);
};

}  // namespace masked_mapper
