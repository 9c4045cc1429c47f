// SPDX-License-Identifier: BSD-3-Clause
// The eccentricity mask (Section III-D, 3): the shape of the visible space tells corridors, which
// need no node, from all other places. isovist.hpp says how no-return beams and scanners below 360
// degrees are treated.
#pragma once

#include <optional>

#include "masked_mapper/masks/isovist.hpp"
#include "masked_mapper/masks/mask.hpp"

namespace masked_mapper {

struct EccentricityMaskOptions {
  IsovistOptions isovist;
  /// Hysteresis (ours): a place is a corridor from `corridor_above` on, and until below
  /// `open_below`; 0-1.
  double open_below = 0.80;
  double corridor_above = 0.85;
  double max_drift = 1.2;  ///< Mahalanobis distance to the centroid beyond which a dead end is seen
  /// Drift is judged only when the scan spans this angle. A scanner that does not see behind stands
  /// at the edge of what it sees, so that its drift is about sqrt(3) in every corridor; to it a
  /// dead end shows as a loss of eccentricity (ours).
  double drift_min_span_deg = 330.0;
};

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
