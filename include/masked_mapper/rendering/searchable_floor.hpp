// SPDX-License-Identifier: BSD-3-Clause
// A floor as its scans drew it, made ready for the question where on it something was seen: two
// look-up tables, coarse to search all of it and fine to tell rooms that only nearly look alike,
// and where the scans saw anything at all, so that what they never saw speaks neither for nor
// against a place.
#pragma once

#include <vector>

#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/scan_matching/floor_search.hpp"

namespace masked_mapper {

struct SearchableFloorOptions {
  FloorSearchOptions coarse;
  FloorSearchOptions fine;
  GridOptions seen;         ///< how free space is told
  double max_range_m = 30;  ///< m; points of a scan farther from its robot are left out
  double spacing_m = 0.1;   ///< between points of the floor
};

/// Fine enough to tell rooms apart, and of what is near: a floor bends.
FloorSearchOptions FineSearchOptions();

class SearchableFloor {
 public:
  /// Of the scans on `floor`. Of a floor beyond what a FloorSearch holds, nothing is ever found.
  SearchableFloor(const std::vector<PosedScan>& scans, std::int32_t floor,
                  const SearchableFloorOptions& options);

  std::int32_t floor() const { return floor_; }
  bool HasFloor() const { return coarse_.HasFloor(); }
  const FloorSearch& coarse() const { return coarse_; }
  const FloorSearch& fine() const { return fine_; }
  const OccupancyGrid& seen() const { return seen_; }

  /// Whether any scan saw what is at a point: free space or something.
  bool IsSeen(const Eigen::Vector2d& point_in_world) const;

 private:
  SearchableFloor(const ScanPoints& points_in_world, const std::vector<PosedScan>& scans,
                  std::int32_t floor, const SearchableFloorOptions& options);

  std::int32_t floor_;
  FloorSearch coarse_;
  FloorSearch fine_;
  OccupancyGrid seen_;
};

}  // namespace masked_mapper
