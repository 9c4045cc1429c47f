// SPDX-License-Identifier: BSD-3-Clause
// The eccentricity mask (Section III-D, 3): the shape of the visible space tells corridors, which
// need no node, from all other places. isovist.hpp says how no-return beams and scanners below 360
// degrees are treated.
#pragma once

#include <optional>

#include "isovist.hpp"
#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/masks/mask_registry.hpp"

namespace masked_mapper {

/// What one scan says about its place.
struct PlaceShape {
  double eccentricity = 0.0;  ///< 0 (round) to 1 (a line), Eq. 9
  double drift = 0.0;         ///< Mahalanobis distance from the robot to the centroid under C
};

/// Empty when the isovist has no area (no beam, all in one direction).
std::optional<PlaceShape> MeasurePlaceShape(const LaserScan& scan, const IsovistOptions& options);

class EccentricityMask : public Mask {
 public:
  explicit EccentricityMask(const EccentricityMaskOptions& options) : options_(options) {}

  /// A scan without a shape changes nothing.
  void Observe(const MaskObservation& observation) override;
  bool Fires() const override { return is_open_ || is_dead_end_; }
  void Restart() override;

 private:
  EccentricityMaskOptions options_;
  bool is_open_ = false;
  bool is_dead_end_ = false;
};

}  // namespace masked_mapper
