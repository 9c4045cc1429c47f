// SPDX-License-Identifier: BSD-3-Clause
// Where in a whole floor a place is, with nothing known before: all positions, all headings. The
// same branch and bound as for pairs of scans (correlative_search.hpp), over one look-up table of
// the whole floor. Ours; the paper's robot starts once.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

class LookupTable;

struct FloorSearchOptions {
  double resolution_m = 0.4;     ///< side of a cell, m
  double sigma_m = 0.4;          ///< blur, m
  double angle_step_deg = 2.0;   ///< deg between search angles
  double point_spacing_m = 0.8;  ///< places are thinned to one point per cell of this size
  double max_range_m = 20.0;     ///< m; points of a place farther from its origin are left out
  double min_score = 0.6;        ///< 0-1, below which a place is not found
};

/// A pose of a place on a floor.
struct PlaceFit {
  Pose2 T_world_place;
  double score = 0.0;  ///< 0-1
};

class FloorSearch {
 public:
  /// Of a floor too large for its cells (beyond 2 km^2, 2e8 cells or 10 km from the origin), or
  /// without a point, nothing is ever found.
  FloorSearch(const ScanPoints& points_in_world, const FloorSearchOptions& options);
  ~FloorSearch();
  FloorSearch(FloorSearch&&) noexcept;
  FloorSearch& operator=(FloorSearch&&) noexcept;

  bool HasFloor() const { return table_ != nullptr; }

  /// A place as the searches take it.
  std::vector<Eigen::Vector2d> Thinned(const ScanPoints& points_in_place) const;

  /// The best pose of all; empty when none reaches min_score.
  std::optional<PlaceFit> Find(const std::vector<Eigen::Vector2d>& points_in_place) const;

  /// All poses of at least `min_score`, the best first, none within `apart_m` and `apart_deg` of a
  /// better one.
  std::vector<PlaceFit> FindAll(const std::vector<Eigen::Vector2d>& points_in_place,
                                double min_score, double apart_m, double apart_deg) const;

  /// The best pose within `within_m` and `within_deg` of a guess, whatever its score.
  PlaceFit FindNear(const std::vector<Eigen::Vector2d>& points_in_place,
                    const Pose2& T_world_place_guess, double within_m, double within_deg) const;

  /// From a pose to the nearest maximum of the score, below the size of a cell. Along a ridge, as
  /// in a corridor, it stays where it is.
  PlaceFit Climb(const std::vector<Eigen::Vector2d>& points_in_place,
                 const Pose2& T_world_place) const;

  /// How well a point fits the floor, 0-1.
  double ValueAt(const Eigen::Vector2d& point_in_world) const;

 private:
  FloorSearchOptions options_;
  std::unique_ptr<LookupTable> table_;  ///< null: nothing to find
};

}  // namespace masked_mapper
