// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/searchable_floor.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

ScanPoints::Ptr PointsOf(const std::vector<PosedScan>& scans, std::int32_t floor,
                         const SearchableFloorOptions& options) {
  constexpr double kFarthest = 2e4;  // m, from the origin
  ScanPoints points;
  for (const PosedScan& posed : scans) {
    if (posed.floor != floor) continue;
    AppendTransformed(*PointsInRobot(*posed.scan), posed.T_world_robot, options.max_range_m,
                      points);
  }
  return AsScanPoints(ThinPoints(points, options.spacing_m, kFarthest));
}

}  // namespace

FloorSearchOptions FineSearchOptions() {
  FloorSearchOptions fine;
  fine.resolution_m = 0.1;
  fine.sigma_m = 0.15;
  fine.angle_step_deg = 0.5;
  fine.point_spacing_m = 0.3;
  fine.max_range_m = 12.0;
  fine.min_score = 0.0;
  return fine;
}

SearchableFloor::SearchableFloor(const std::vector<PosedScan>& scans, std::int32_t floor,
                                 const SearchableFloorOptions& options)
    : SearchableFloor(*PointsOf(scans, floor, options), scans, floor, options) {}

SearchableFloor::SearchableFloor(const ScanPoints& points_in_world,
                                 const std::vector<PosedScan>& scans, std::int32_t floor,
                                 const SearchableFloorOptions& options)
    : floor_(floor),
      coarse_(points_in_world, options.coarse),
      fine_(points_in_world, options.fine) {
  GridOptions seen = options.seen;
  seen.glass = false;  // what most beams of a scan pass speaks for no place
  if (HasFloor()) seen_ = RenderGrid(scans, floor, seen);
}

bool SearchableFloor::IsSeen(const Eigen::Vector2d& point_in_world) const {
  const double column = std::floor((point_in_world.x() - seen_.origin_x) / seen_.resolution_m);
  const double row = std::floor((point_in_world.y() - seen_.origin_y) / seen_.resolution_m);
  if (!(column >= 0.0 && row >= 0.0 && column < seen_.width && row < seen_.height)) return false;
  return seen_.at(static_cast<int>(column), static_cast<int>(row)) != Cell::kUnknown;
}

}  // namespace masked_mapper
