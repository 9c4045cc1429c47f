// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

/// T_a_b of least squared distances between pairs of points in a and in b; the identity for none,
/// and a shift alone where they do not spread.
Pose2 AlignRigidly(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& a_and_b);

}  // namespace masked_mapper
