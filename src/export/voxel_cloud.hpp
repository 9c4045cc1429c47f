// SPDX-License-Identifier: BSD-3-Clause
// Points in space, thinned as they come: of all that fall into a voxel the mean is kept. Memory
// grows with the surfaces that are seen, not with the time for which they are.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
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
  // Of a large building there are tens of millions, so that their bytes count.
  struct Sum {
    double stamp = 0.0;
    std::uint64_t cell = 0;                            ///< its three indices in one
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< m, from the voxel's corner
    float intensity = 0.0F;
    std::uint32_t count = 0;
    std::uint32_t label = 0;
  };

  Sum& SumOf(std::uint64_t cell, const SpacePoint& point);
  void Grow();

  double voxel_m_;
  std::vector<std::uint32_t> places_;  ///< in `sums_`, one above, by the hash of cell and label
  std::deque<Sum> sums_;
};

}  // namespace masked_mapper
