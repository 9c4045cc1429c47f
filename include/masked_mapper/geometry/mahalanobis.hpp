// SPDX-License-Identifier: BSD-3-Clause
// Mahalanobis distances of displacements and of whole transforms.
#pragma once

#include <Eigen/Core>

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

/// sqrt(z^T (Sigma + range_m^2 I)^-1 z), Eq. 7: how far two nodes may be apart and still see the
/// same place. `displacement` and `covariance` are in one frame; metres. `range_m` is R of the
/// paper. A covariance that is not positive semi-definite is the caller's bug.
double MahalanobisDistance(const Eigen::Vector2d& displacement, const Eigen::Matrix2d& covariance,
                           double range_m);

/// Distance of a loop's total transform from the identity under its own covariance (Section III-E).
/// Infinite when the covariance is singular and the transform is not the identity.
double MahalanobisFromIdentity(const UncertainPose2& loop);

}  // namespace masked_mapper
