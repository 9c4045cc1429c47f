// SPDX-License-Identifier: BSD-3-Clause
// The hits of a small neighbourhood, and which way the surface faces that they lie on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace masked_mapper {

class SurfacePatch {
 public:
  /// In a frame of the neighbourhood's own, m, so that numbers stay small.
  void Add(const Eigen::Vector3f& hit) {
    ++count_;
    sum_ += hit;
    squares_ += hit.cwiseProduct(hit);
    products_ += Eigen::Vector3f(hit.y() * hit.z(), hit.z() * hit.x(), hit.x() * hit.y());
  }

  /// Empty where hits are too few, lie in a line, or on no plane; `thickness_m` is what noise makes
  /// of one.
  std::optional<Eigen::Vector3f> Normal(float thickness_m);

 private:
  std::uint32_t count_ = 0;
  std::uint32_t counted_ = 0;  ///< when the normal was found
  Eigen::Vector3f sum_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f squares_ = Eigen::Vector3f::Zero();   ///< of x, y, z
  Eigen::Vector3f products_ = Eigen::Vector3f::Zero();  ///< of y and z, z and x, x and y
  Eigen::Vector3f normal_ = Eigen::Vector3f::Zero();    ///< zero: none
};

}  // namespace masked_mapper
