// SPDX-License-Identifier: BSD-3-Clause
// A look-up table read as a smooth surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lookup_table.hpp"

namespace masked_mapper {

// The table at a position, with its first and second derivatives per cell.
struct TableSurface {
  double value = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
};

struct SplineWeights {
  std::array<double, 4> value;
  std::array<double, 4> first;
  std::array<double, 4> second;
};

inline SplineWeights CubicWeights(double t) {
  const double u = 1.0 - t;
  return {{u * u * u / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
           (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0, t * t * t / 6.0},
          {-0.5 * u * u, 1.5 * t * t - 2.0 * t, -1.5 * u * u + 2.0 * u, 0.5 * t * t},
          {u, 3.0 * t - 2.0, 3.0 * u - 2.0, t}};
}

// `x`, `y` in cells; the value of a cell stands at its centre.
inline bool ReadSurface(const LookupTable::Level& cells, double x, double y,
                        TableSurface* surface) {
  x -= cells.x0 + 0.5;
  y -= cells.y0 + 0.5;
  if (!(x > -4.0 && y > -4.0 && x < cells.width + 4.0 && y < cells.height + 4.0)) return false;
  const double column = std::floor(x);
  const double row = std::floor(y);
  const SplineWeights wx = CubicWeights(x - column);
  const SplineWeights wy = CubicWeights(y - row);
  const std::uint8_t* from = cells.data + (static_cast<std::ptrdiff_t>(row) - 1) * cells.stride +
                             (static_cast<std::ptrdiff_t>(column) - 1);
  *surface = TableSurface();
  for (std::size_t j = 0; j < 4; ++j, from += cells.stride) {
    double value = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double cell = from[i];
      value += wx.value[i] * cell;
      first += wx.first[i] * cell;
      second += wx.second[i] * cell;
    }
    surface->value += wy.value[j] * value;
    surface->gradient.x() += wy.value[j] * first;
    surface->gradient.y() += wy.first[j] * value;
    surface->xx += wy.value[j] * second;
    surface->xy += wy.first[j] * first;
    surface->yy += wy.second[j] * value;
  }
  return true;
}

// Removes the upward curvature of a point's surface, so that a point beside a wall does not make
// the Newton step a step away from the maximum.
inline void KeepDownward(TableSurface* surface) {
  const double mean = 0.5 * (surface->xx + surface->yy);
  const double difference = 0.5 * (surface->xx - surface->yy);
  const double root = std::sqrt(difference * difference + surface->xy * surface->xy);
  const double high = mean + root;
  if (high <= 0.0) return;
  const double low = std::min(mean - root, 0.0);
  // low * v v^T with v the eigenvector of the lower eigenvalue.
  const double c = root > 0.0 ? difference / root : 1.0;
  const double s = root > 0.0 ? surface->xy / root : 0.0;
  surface->xx = 0.5 * low * (1.0 - c);
  surface->yy = 0.5 * low * (1.0 + c);
  surface->xy = -0.5 * low * s;
}

}  // namespace masked_mapper
