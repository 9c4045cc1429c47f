// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/geometry/polygon.hpp"

#include <cmath>

namespace masked_mapper {

std::optional<PolygonMoments> ComputePolygonMoments(const std::vector<Eigen::Vector2d>& corners) {
  if (corners.size() < 3) return std::nullopt;
  // Sums of signed moments of the triangles (reference, p, q): parts outside the polygon cancel.
  // The first corner is the reference so that a polygon far from the origin loses no digits.
  const Eigen::Vector2d& reference = corners.front();
  double area = 0.0;
  double scale = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d p = corners[i] - reference;
    const Eigen::Vector2d q = corners[i + 1] - reference;
    const double triangle = 0.5 * (p.x() * q.y() - p.y() * q.x());
    const Eigen::Vector2d sum = p + q;
    area += triangle;
    scale += std::abs(triangle);
    first += triangle / 3.0 * sum;
    second += triangle / 12.0 * (p * p.transpose() + q * q.transpose() + sum * sum.transpose());
  }
  if (!(std::abs(area) > 1e-12 * scale) || !std::isfinite(area)) return std::nullopt;
  PolygonMoments moments;
  const Eigen::Vector2d mean = first / area;
  moments.area = std::abs(area);
  moments.centroid = reference + mean;
  moments.covariance = second / area - mean * mean.transpose();
  return moments;
}

}  // namespace masked_mapper
