// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_rays.hpp"

#include <cmath>
#include <cstdlib>

namespace masked_mapper {
namespace {

constexpr int kFraction = 32;  // bits: places are whole numbers, so that steps add up as they are
constexpr std::int64_t kWhole = std::int64_t{1} << kFraction;
constexpr int kTogether = 8;  // voxels passed before, in a row, from which two ways are one

std::int64_t Fixed(double place) {
  return static_cast<std::int64_t>(place * static_cast<double>(kWhole));
}
std::int32_t VoxelOf(std::int64_t place) { return static_cast<std::int32_t>(place >> kFraction); }

/// Whether it was set before.
bool SetBit(CloudRays::Bits& bits, const VoxelIndex& voxel) {
  const std::size_t place = PlaceInBlock(voxel);
  const std::uint64_t bit = std::uint64_t{1} << (place % 64);
  std::uint64_t& word = bits[place / 64];
  const bool was_set = (word & bit) != 0;
  word |= bit;
  return was_set;
}

/// Where a ray, along an axis across its main one, comes from and goes to within a layer of voxels.
struct Across {
  std::int64_t from;
  std::int64_t to;

  bool IsOneVoxel() const { return from >> kFraction == to >> kFraction; }
  /// The share of the way from one to the other at which the voxel changes.
  double Change() const {
    const std::int64_t wall = (from < to ? to : from) & ~(kWhole - 1);
    return static_cast<double>(wall - from) / static_cast<double>(to - from);
  }
};

}  // namespace

void CloudRays::Begin(const Eigen::Vector3d& lidar) {
  lidar_ = lidar;
  blocks_.clear();
  index_.clear();
  last_ = 0;
}

std::size_t CloudRays::PlaceOf(const VoxelIndex& at) {
  const auto [found, is_new] =
      index_.try_emplace(KeyOfPlace(at), static_cast<std::int32_t>(blocks_.size()));
  if (is_new) {
    blocks_.emplace_back();
    blocks_.back().at = at;
    blocks_.back().beside.fill(-1);
  }
  return static_cast<std::size_t>(found->second);
}

std::size_t CloudRays::PlaceBeside(std::size_t block, const VoxelIndex& at) {
  const VoxelIndex& here = blocks_[block].at;
  const std::int32_t dx = at[0] - here[0];
  const std::int32_t dy = at[1] - here[1];
  const std::int32_t dz = at[2] - here[2];
  if (std::abs(dx) + std::abs(dy) + std::abs(dz) != 1) return PlaceOf(at);
  const int side = dx != 0 ? (dx + 1) / 2 : dy != 0 ? 2 + (dy + 1) / 2 : 4 + (dz + 1) / 2;
  const std::int32_t known = blocks_[block].beside[static_cast<std::size_t>(side)];
  if (known >= 0) return static_cast<std::size_t>(known);
  const std::size_t place = PlaceOf(at);
  blocks_[block].beside[static_cast<std::size_t>(side)] = static_cast<std::int32_t>(place);
  return place;
}

void CloudRays::GoTo(const VoxelIndex& at) {
  if (last_ < blocks_.size() && IsSame(at, blocks_[last_].at)) return;
  last_ = last_ < blocks_.size() ? PlaceBeside(last_, at) : PlaceOf(at);
}

bool CloudRays::Hit(const VoxelIndex& voxel) {
  GoTo(BlockOf(voxel));
  return !SetBit(blocks_[last_].hit, voxel);
}

/// Whether it was passed before.
inline bool CloudRays::Mark(const VoxelIndex& voxel) {
  GoTo(BlockOf(voxel));
  return SetBit(blocks_[last_].passed, voxel);
}

void CloudRays::Pass(const Eigen::Vector3d& end) {
  int main = 0;
  const double length = (lidar_ - end).cwiseAbs().maxCoeff(&main);
  if (!(length > 0.0)) return;
  if (main == 0) {
    PassAlong<0>(end, length);
  } else if (main == 1) {
    PassAlong<1>(end, length);
  } else {
    PassAlong<2>(end, length);
  }
}

// Layer by layer along the axis on which it goes farthest, `length` voxels: within a layer it
// changes its voxel at most once along each of the two others.
template <int kMain>
void CloudRays::PassAlong(const Eigen::Vector3d& end, double length) {
  constexpr int kU = (kMain + 1) % 3;
  constexpr int kV = (kMain + 2) % 3;
  VoxelIndex voxel{VoxelOf(Fixed(end.x())), VoxelOf(Fixed(end.y())), VoxelOf(Fixed(end.z()))};
  GoTo(BlockOf(voxel));
  const bool is_forward = lidar_(kMain) > end(kMain);
  const double slope_u = (lidar_(kU) - end(kU)) / length;
  const double slope_v = (lidar_(kV) - end(kV)) / length;
  const double to_wall = is_forward ? voxel[kMain] + 1 - end(kMain) : end(kMain) - voxel[kMain];
  Across across_u{Fixed(end(kU)), Fixed(end(kU) + slope_u * to_wall)};
  Across across_v{Fixed(end(kV)), Fixed(end(kV) + slope_v * to_wall)};
  const std::int64_t step_u = Fixed(slope_u);
  const std::int64_t step_v = Fixed(slope_v);
  int together = 0;
  for (std::int32_t left = std::abs(VoxelOf(Fixed(lidar_(kMain))) - voxel[kMain]);; --left) {
    if (left == 0) {
      across_u.to = Fixed(lidar_(kU));
      across_v.to = Fixed(lidar_(kV));
    }
    together = Mark(voxel) ? together + 1 : 0;
    if (together == kTogether) return;
    const bool turns_u = !across_u.IsOneVoxel();
    const bool turns_v = !across_v.IsOneVoxel();
    if (turns_u && turns_v) {
      if (across_u.Change() < across_v.Change()) {
        voxel[kU] = VoxelOf(across_u.to);
      } else {
        voxel[kV] = VoxelOf(across_v.to);
      }
      Mark(voxel);
    }
    if (turns_u || turns_v) {
      voxel[kU] = VoxelOf(across_u.to);
      voxel[kV] = VoxelOf(across_v.to);
      Mark(voxel);
    }
    if (left == 0) return;
    voxel[kMain] += is_forward ? 1 : -1;
    across_u = {across_u.to, across_u.to + step_u};
    across_v = {across_v.to, across_v.to + step_v};
  }
}

}  // namespace masked_mapper
