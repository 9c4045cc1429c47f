// SPDX-License-Identifier: BSD-3-Clause
#include "known_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace masked_mapper {
namespace {

constexpr double kScanEvery = 0.3;  // m of travel between the scans that make a floor
constexpr double kScanEveryDeg = 20.0;

std::vector<std::vector<PosedScan>> ScansOfFloors(const BuildingMap& map) {
  std::vector<std::vector<PosedScan>> scans(map.graph.floors().size());
  std::optional<TrajectoryPose> before;
  for (const KeptScan& kept : map.kept_scans) {
    const TrajectoryPose& pose = map.trajectory[kept.trajectory_index];
    if (pose.in_transit) continue;
    const bool is_near =
        before && before->floor == pose.floor &&
        Distance(before->T_world_robot, pose.T_world_robot) < kScanEvery &&
        std::abs(WrapAngle(before->T_world_robot.theta - pose.T_world_robot.theta)) <
            DegToRad(kScanEveryDeg);
    if (is_near) continue;
    before = pose;
    scans[static_cast<std::size_t>(pose.floor)].push_back(
        {pose.T_world_robot, pose.floor, &kept.scan});
  }
  return scans;
}

}  // namespace

UncertainPose2 Widened(UncertainPose2 T_a_b, double sigma_m, double sigma_deg) {
  const double sigma_rad = DegToRad(sigma_deg);
  T_a_b.covariance.diagonal() +=
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return T_a_b;
}

double SigmaM(const UncertainPose2& T_a_b) {
  return std::sqrt(T_a_b.covariance(0, 0) + T_a_b.covariance(1, 1));
}

KnownMap::KnownMap(const BuildingMap& map, const SearchableFloorOptions& options)
    : map_(map), scans_(ScansOfFloors(map)) {
  double seen_m2 = 0.0;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const auto id = static_cast<FloorId>(i);
    auto floor = std::make_unique<SearchableFloor>(scans_[i], id, options);
    if (floor->HasFloor()) {
      seen_m2 += KnownArea(floor->seen());
      ids_.push_back(id);
    } else {
      floor.reset();
    }
    floors_.push_back(std::move(floor));
  }
  log_places_ = std::log(std::max(1.0, seen_m2 / (kPlaceM * kPlaceM)) * 360.0 / kPlaceDeg);
}

std::vector<NodeId> KnownMap::NodesNear(FloorId floor, const Eigen::Vector2d& point_in_world,
                                        double within_m) const {
  std::vector<std::pair<double, NodeId>> near;
  const std::vector<Node>& nodes = map_.graph.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].floor != floor) continue;
    const double away = (nodes[i].T_world_robot.Translation() - point_in_world).norm();
    if (away <= within_m) near.emplace_back(away, static_cast<NodeId>(i));
  }
  std::sort(near.begin(), near.end());
  std::vector<NodeId> ids;
  for (const auto& [away, id] : near) ids.push_back(id);
  return ids;
}

std::vector<FloorId> KnownMap::FloorsReached(FloorId from, std::optional<double> climb_m,
                                             double sigma_m) const {
  constexpr double kSigmas = 3.0;
  constexpr double kSlack = 0.8;  // m; weather
  std::vector<FloorId> reached;
  const Floor& left = Facts(from);
  for (const FloorId floor : floors()) {
    const Floor& other = Facts(floor);
    const double sigma = std::hypot(sigma_m, left.elevation_sigma, other.elevation_sigma);
    const double step = other.elevation - left.elevation;
    if (climb_m && std::abs(step - *climb_m) > kSigmas * sigma + kSlack) continue;
    reached.push_back(floor);
  }
  return reached;
}

}  // namespace masked_mapper
