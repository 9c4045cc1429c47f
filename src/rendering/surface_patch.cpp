// SPDX-License-Identifier: BSD-3-Clause
#include "surface_patch.hpp"

#include <Eigen/Eigenvalues>

namespace masked_mapper {

std::optional<Eigen::Vector3f> SurfacePatch::Normal(float thickness_m) {
  constexpr std::uint32_t kFew = 6;
  // A quarter more of hits changes little.
  if (count_ >= kFew && 4 * count_ >= 5 * counted_) {
    counted_ = count_;
    const auto n = static_cast<float>(count_);
    const Eigen::Vector3f mean = sum_ / n;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    Eigen::Matrix3f moments;
    moments << squares_.x(), products_.z(), products_.y(),  //
        products_.z(), squares_.y(), products_.x(),         //
        products_.y(), products_.x(), squares_.z();
    solver.computeDirect(Eigen::Matrix3f(moments / n - mean * mean.transpose()));
    const Eigen::Vector3f& spread = solver.eigenvalues();  // rising
    const float thin = thickness_m * thickness_m;
    const bool is_plane = spread(0) < thin && spread(1) > thin && spread(1) > 4.0F * spread(0);
    normal_ = is_plane ? Eigen::Vector3f(solver.eigenvectors().col(0)) : Eigen::Vector3f::Zero();
  }
  if (normal_.isZero()) return std::nullopt;
  return normal_;
}

}  // namespace masked_mapper
