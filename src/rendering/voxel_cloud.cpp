// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/voxel_cloud.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr std::uint64_t kBits = 21;
constexpr double kMostVoxels = 1 << (kBits - 1);

}  // namespace

void VoxelCloud::Add(const SpacePoint& point) {
  const Eigen::Vector3d in_voxels = point.position / voxel_m_;
  if (!in_voxels.allFinite() || !(in_voxels.cwiseAbs().maxCoeff() < kMostVoxels - 1.0)) return;
  std::uint64_t key = 0;
  std::array<std::int32_t, 3> cell{};
  for (int axis = 0; axis < 3; ++axis) {
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(std::floor(in_voxels(axis)));
    const std::int64_t shifted =
        std::int64_t{cell[static_cast<std::size_t>(axis)]} + static_cast<std::int64_t>(kMostVoxels);
    key = key << kBits | static_cast<std::uint64_t>(shifted);
  }
  if (index_.size() <= point.label) index_.resize(point.label + 1U);
  const auto [known, is_new] =
      index_[point.label].emplace(key, static_cast<std::uint32_t>(sums_.size()));
  if (is_new) {
    Sum sum;
    sum.label = point.label;
    sum.cell = cell;
    sum.stamp = point.stamp;
    sums_.push_back(sum);
  }
  Sum& sum = sums_[known->second];
  for (int axis = 0; axis < 3; ++axis) {
    sum.offset(axis) +=
        static_cast<float>(point.position(axis) - voxel_m_ * cell[static_cast<std::size_t>(axis)]);
  }
  sum.intensity += point.intensity;
  ++sum.count;
}

std::vector<SpacePoint> VoxelCloud::Points(std::uint32_t least) const {
  std::vector<SpacePoint> points;
  for (const Sum& sum : sums_) {
    if (sum.count < least) continue;
    const auto count = static_cast<float>(sum.count);
    SpacePoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point.position(axis) = voxel_m_ * sum.cell[static_cast<std::size_t>(axis)] +
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
