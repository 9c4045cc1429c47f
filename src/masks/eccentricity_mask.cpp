// SPDX-License-Identifier: BSD-3-Clause
#include "eccentricity_mask.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/polygon.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

std::optional<PlaceShape> MeasurePlaceShape(const LaserScan& scan, const IsovistOptions& options) {
  const std::optional<PolygonMoments> moments = ComputePolygonMoments(Isovist(scan, options));
  if (!moments) return std::nullopt;
  const Eigen::Matrix2d& c = moments->covariance;
  const double mean = 0.5 * c.trace();
  const double deviation = std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
  const double larger = mean + deviation;
  const double smaller = mean - deviation;
  // A self-crossing outline (noise on almost coincident beams) can have no proper covariance.
  if (!(smaller > 0.0)) return std::nullopt;
  PlaceShape shape;
  shape.eccentricity = std::sqrt(1.0 - smaller / larger);
  shape.drift = MahalanobisDistance(moments->centroid, c, 0.0);
  return shape;
}

void EccentricityMask::Observe(const MaskObservation& observation) {
  const LaserScan& scan = observation.scan;
  const std::optional<PlaceShape> shape = MeasurePlaceShape(scan, options_.isovist);
  if (!shape) return;
  is_open_ = shape->eccentricity < (is_open_ ? options_.corridor_above : options_.open_below);
  const double span = std::abs(scan.angle_step) * static_cast<double>(scan.size());
  is_dead_end_ = span >= DegToRad(options_.drift_min_span_deg) && shape->drift > options_.max_drift;
}

void EccentricityMask::Restart() {
  is_open_ = false;
  is_dead_end_ = false;
}

}  // namespace masked_mapper
