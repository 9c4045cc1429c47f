// SPDX-License-Identifier: BSD-3-Clause
#include "voxel_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::uint64_t kBits = 21;
constexpr std::int64_t kMostVoxels = 1 << (kBits - 1);
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

std::uint64_t Spread(std::uint64_t cell, std::uint32_t label) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  const std::uint64_t product = (cell + label) * kGolden;
  // Only the uppermost bits hang on all of the cell's, and a small table takes the lowest.
  return product >> 32U ^ product >> 52U;
}

std::int64_t IndexOf(std::uint64_t cell, int axis) {
  const auto shifted = cell >> (kBits * static_cast<std::uint64_t>(2 - axis)) & kMask;
  return static_cast<std::int64_t>(shifted) - kMostVoxels;
}

}  // namespace

VoxelCloud::Sum& VoxelCloud::SumOf(std::uint64_t cell, const SpacePoint& point) {
  if (10 * sums_.size() >= 7 * places_.size()) Grow();
  const std::size_t mask = places_.size() - 1;
  std::size_t i = Spread(cell, point.label) & mask;
  for (; places_[i] != 0; i = (i + 1) & mask) {
    Sum& known = sums_[places_[i] - 1];
    if (known.cell == cell && known.label == point.label) return known;
  }
  Sum sum;
  sum.stamp = point.stamp;
  sum.cell = cell;
  sum.label = point.label;
  sums_.push_back(sum);
  places_[i] = static_cast<std::uint32_t>(sums_.size());
  return sums_.back();
}

void VoxelCloud::Grow() {
  const std::size_t size = std::max<std::size_t>(1024, 2 * places_.size());
  places_.clear();
  places_.shrink_to_fit();
  places_.resize(size, 0);
  std::uint32_t place = 0;
  for (const Sum& sum : sums_) {
    std::size_t i = Spread(sum.cell, sum.label) & (size - 1);
    while (places_[i] != 0) i = (i + 1) & (size - 1);
    places_[i] = ++place;
  }
}

void VoxelCloud::Add(const SpacePoint& point) {
  const Eigen::Vector3d in_voxels = point.position / voxel_m_;
  const auto most = static_cast<double>(kMostVoxels) - 1.0;
  if (!in_voxels.allFinite() || !(in_voxels.cwiseAbs().maxCoeff() < most)) return;
  std::uint64_t cell = 0;
  Eigen::Vector3f offset;
  for (int axis = 0; axis < 3; ++axis) {
    const double index = std::floor(in_voxels(axis));
    cell =
        cell << kBits | static_cast<std::uint64_t>(static_cast<std::int64_t>(index) + kMostVoxels);
    offset(axis) = static_cast<float>(point.position(axis) - voxel_m_ * index);
  }
  Sum& sum = SumOf(cell, point);
  sum.offset += offset;
  sum.intensity += point.intensity;
  ++sum.count;
}

std::vector<SpacePoint> VoxelCloud::Points(std::uint32_t least) const {
  const auto is_kept = [least](const Sum& sum) { return sum.count >= least; };
  std::vector<SpacePoint> points;
  points.reserve(static_cast<std::size_t>(std::count_if(sums_.begin(), sums_.end(), is_kept)));
  for (const Sum& sum : sums_) {
    if (!is_kept(sum)) continue;
    const auto count = static_cast<float>(sum.count);
    SpacePoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point.position(axis) = voxel_m_ * static_cast<double>(IndexOf(sum.cell, axis)) +
                             static_cast<double>(sum.offset(axis) / count);
    }
    point.intensity = sum.intensity / count;
    point.stamp = sum.stamp;
    point.label = sum.label;
    points.push_back(point);
  }
  return points;
}

}  // namespace masked_mapper
