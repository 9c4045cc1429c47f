// SPDX-License-Identifier: BSD-3-Clause
// Points in space, thinned as they come: of all that fall into a voxel the mean is kept. Memory
// grows with the surfaces that are seen, not with the time for which they are.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace masked_mapper {

struct SpacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, in world
  float intensity = 0.0F;
  double stamp = 0.0;  ///< s
  std::uint32_t label = 0;
};

class VoxelCloud {
 public:
  /// `voxel_m` > 0.
  explicit VoxelCloud(double voxel_m) : voxel_m_(voxel_m) {}

  /// Points of different labels do not mix. One that is no number, or a million voxels away, is
  /// left out.
  void Add(const SpacePoint& point);

  std::size_t size() const { return sums_.size(); }
  /// Means of the voxels that hold at least `least` points, in the order in which they were first
  /// met; the stamp is that of the first point.
  std::vector<SpacePoint> Points(std::uint32_t least) const;

 private:
  struct Sum {
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< m, from the voxel's corner
    float intensity = 0.0F;
    std::uint32_t count = 0;
    std::uint32_t label = 0;
    std::array<std::int32_t, 3> cell{};
    double stamp = 0.0;
  };

  double voxel_m_;
  std::vector<std::unordered_map<std::uint64_t, std::uint32_t>> index_;  ///< by label
  std::vector<Sum> sums_;
};

}  // namespace masked_mapper
