// SPDX-License-Identifier: BSD-3-Clause
// What the prior of a search says of its grid poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "correlative_search.hpp"

namespace masked_mapper {

// A function of its own, never inlined: both searches must round alike.
__attribute__((noinline)) inline double Chi2(const SearchProblem& problem, const GridPose& pose) {
  const Eigen::Matrix3d& u = problem.prior_root;
  const double x = pose.x * problem.grid.resolution_m;
  const double y = pose.y * problem.grid.resolution_m;
  const double a = pose.angle * problem.grid.angle_step;
  const double r0 = u(0, 0) * x + u(0, 1) * y + u(0, 2) * a;
  const double r1 = u(1, 1) * y + u(1, 2) * a;
  const double r2 = u(2, 2) * a;
  return r0 * r0 + r1 * r1 + r2 * r2;
}

// The smallest chi^2 over the box [x0, x1] x [y0, y1] at one angle, in steps; less what rounding
// could make of it, so that it never exceeds Chi2 of a pose in the box.
inline double SmallestChi2(const SearchProblem& problem, std::int32_t angle, std::int32_t x0,
                           std::int32_t x1, std::int32_t y0, std::int32_t y1) {
  const Eigen::Matrix3d& u = problem.prior_root;
  const double resolution = problem.grid.resolution_m;
  const double a = angle * problem.grid.angle_step;
  const double low_x = x0 * resolution;
  const double high_x = x1 * resolution;
  const double low_y = y0 * resolution;
  const double high_y = y1 * resolution;
  const auto residual0 = [&](double x, double y) {
    return u(0, 0) * x + u(0, 1) * y + u(0, 2) * a;
  };
  const auto residual1 = [&](double y) { return u(1, 1) * y + u(1, 2) * a; };

  // Where |residual1| is smallest; there residual0 vanishes for some x of the box, or it does not
  // and the minimum lies on the nearer of the box's two edges in x.
  double y = u(1, 1) > 0.0 ? std::clamp(-u(1, 2) * a / u(1, 1), low_y, high_y) : low_y;
  double r0 = 0.0;
  const double at_low = residual0(low_x, y);
  const double at_high = residual0(high_x, y);  // not less than at_low, since U00 >= 0
  if (at_low > 0.0 || at_high < 0.0) {
    const double x = at_low > 0.0 ? low_x : high_x;
    const double norm2 = u(0, 1) * u(0, 1) + u(1, 1) * u(1, 1);
    if (norm2 > 0.0) {
      const double best = -(u(0, 1) * (u(0, 0) * x + u(0, 2) * a) + u(1, 1) * u(1, 2) * a) / norm2;
      y = std::clamp(best, low_y, high_y);
    }
    r0 = residual0(x, y);
  }
  const double r1 = residual1(y);
  const double r2 = u(2, 2) * a;
  const double chi2 = r0 * r0 + r1 * r1 + r2 * r2;
  // Residuals are sums of three products: relative to the largest terms their rounding is below
  // 1e-15, that of the position of the minimum enters squared.
  const double size_x = std::max(std::abs(low_x), std::abs(high_x));
  const double size_y = std::max(std::abs(low_y), std::abs(high_y));
  const double terms0 =
      std::abs(u(0, 0)) * size_x + std::abs(u(0, 1)) * size_y + std::abs(u(0, 2) * a);
  const double terms1 = std::abs(u(1, 1)) * size_y + std::abs(u(1, 2) * a);
  const double slack = 1e-13 * (terms0 * terms0 + terms1 * terms1 + r2 * r2);
  return std::max(0.0, chi2 - slack);
}

}  // namespace masked_mapper
