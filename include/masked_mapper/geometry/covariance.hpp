// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace masked_mapper {

/// Whether the matrix can be a covariance of (x, y, theta): finite, symmetric and without a
/// negative eigenvalue, but for rounding, and with no variance above 1e12. To be asked of what
/// comes from a file or a hand.
bool IsCovariance(const Eigen::Matrix3d& matrix);

}  // namespace masked_mapper
