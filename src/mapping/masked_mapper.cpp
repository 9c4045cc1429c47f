// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 1, to be read beside the paper: Observe is its loop, CloseLoops its body.
#include "masked_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/masks/mask_registry.hpp"

namespace masked_mapper {
namespace {

// Wheels alone lay out surroundings against which a match could be refined only where they are
// known to be that good.
bool AreSureOfSurroundings(const DeadReckoningOptions& wheels, double half_length_m) {
  constexpr double kMost = 0.05;  // m
  constexpr double kMostDeg = 1.0;
  const double root = std::sqrt(half_length_m);
  return wheels.sigma_position_per_sqrt_m * root <= kMost &&
         wheels.sigma_heading_deg_per_sqrt_m * root <= kMostDeg &&
         wheels.sigma_heading_deg_per_sqrt_rad * std::sqrt(kPi) <= kMostDeg;
}

MappingOptions Settled(MappingOptions options) {
  LoopClosureOptions& closures = options.closures;
  closures.laid_out_by_scans = options.motion.source != MotionSource::kOdometry;
  closures.refine = closures.laid_out_by_scans ||
                    AreSureOfSurroundings(options.motion.odometry, closures.submaps.half_length_m);
  return options;
}

}  // namespace

MaskedMapper::MaskedMapper(const std::string& mask, const MappingOptions& options,
                           const FloorTimeline& floors)
    : options_(Settled(options)),
      floors_(floors),
      motion_(options_.motion, options_.nodes.cab_m, floors),
      mask_(MakeMask(mask, options.masks)),
      closer_(options_.closures, result_) {
  const std::vector<std::string> names = FloorNames(floors.levels);
  for (std::size_t i = 0; i < floors.levels.size(); ++i) {
    const FloorLevel& level = floors.levels[i];
    result_.graph.AddFloor({names[i], level.elevation, level.elevation_sigma,
                            level.elevation_measured, !level.label.empty()});
  }
}

void MaskedMapper::Observe(const Observation& observation) {
  if (const std::optional<MovedScan> moved = motion_.Observe(observation)) Observe(*moved);
}

// Where wheels did not straighten a scan, the step that it made does, which is better known now
// than when it was matched. `pose`: its place in the trajectory.
LaserScan MaskedMapper::StraightenedAt(const LaserScan& scan, std::size_t pose,
                                       const Pose2& T_odom_robot) const {
  if (scan.beam_time == 0.0 || pose == 0) return StraightenedBySteps(scan, Pose2{}, 0.0);
  const TrajectoryPose& before = result_.trajectory[pose - 1];
  return StraightenedBySteps(scan, Between(before.T_odom_robot, T_odom_robot),
                             scan.stamp - before.stamp);
}

void MaskedMapper::Observe(const MovedScan& moved) {
  const FloorInterval& interval = moved.interval;
  T_odom_robot_ = moved.T_odom_robot;
  T_node_robot_ = T_node_robot_ * moved.T_last_robot;
  const LaserScan scan = StraightenedAt(moved.scan, result_.trajectory.size(), T_odom_robot_);
  const auto floor = static_cast<FloorId>(interval.level);
  const bool is_first = result_.graph.nodes().empty();
  if (is_first) {
    in_transit_ = interval.in_transit;
  } else {
    ChangeFloor(interval, scan.stamp);
  }
  if (!in_transit_) {
    const StageTimer timer(result_.seconds.mask);
    mask_->Observe({scan, T_odom_robot_});
  }
  const auto distance_from = [&](NodeId node) {
    return Distance(result_.graph.node(node).T_odom_robot, T_odom_robot_);
  };
  std::optional<NodeId> new_scan_node;
  if (is_first) {
    // Node 0 is a scan-matching node at the start (III-B); a drive that starts in transit has none.
    AddNode(scan.stamp, floor, EdgeKind::kOdometry, in_transit_ ? -1 : Keep(scan));
  } else if (!in_transit_) {
    const auto last_node = static_cast<NodeId>(result_.graph.nodes().size() - 1);
    const bool far_from_scan_node =
        !last_scan_node_ || distance_from(*last_scan_node_) > options_.nodes.min_edge_length_m;
    if (far_from_scan_node && mask_->Fires()) {
      new_scan_node = AddNode(scan.stamp, floor, EdgeKind::kOdometry, Keep(scan));
    } else if (distance_from(last_node) > options_.nodes.max_edge_length_m) {
      AddNode(scan.stamp, floor, EdgeKind::kOdometry);
    }
  }
  RecordPose(scan, interval);
  if (new_scan_node) CloseLoops(*new_scan_node);
}

// Exit on the old floor, entry on the new one, both odometry-only (III-B): what lies between them
// is one edge, and the mask starts afresh. DriveMotion does the same to the motion.
void MaskedMapper::ChangeFloor(const FloorInterval& interval, double stamp) {
  const FloorId old_floor = result_.graph.nodes().back().floor;
  const auto floor = static_cast<FloorId>(interval.level);
  const bool other_floor = floor != old_floor;
  if (!in_transit_ && (interval.in_transit || other_floor)) {
    AddNode(stamp, old_floor, EdgeKind::kOdometry);
    in_transit_ = true;
  }
  if (in_transit_ && !interval.in_transit) {
    AddNode(stamp, floor, other_floor ? EdgeKind::kFloorChange : EdgeKind::kOdometry);
    in_transit_ = false;
    last_scan_node_.reset();
    mask_->Restart();
  }
}

NodeId MaskedMapper::AddNode(double stamp, FloorId floor, EdgeKind kind, KeptScanId scan) {
  PoseGraph& graph = result_.graph;
  Node node;
  node.stamp = stamp;
  node.floor = floor;
  node.T_odom_robot = T_odom_robot_;
  node.scan = scan;
  const bool has_scan = node.HasScan();
  const bool is_first = graph.nodes().empty();
  if (!is_first) {
    node.T_world_robot = graph.nodes().back().T_world_robot * T_node_robot_.mean;
  }
  const NodeId id = graph.AddNode(node);
  if (!is_first) {
    graph.AddEdge({id - 1, id, T_node_robot_, kind});
  }
  T_node_robot_ = UncertainPose2{};
  if (has_scan) {
    last_scan_node_ = id;
    mask_->OnNode();
  }
  return id;
}

void MaskedMapper::CloseLoops(NodeId new_node) {
  std::vector<Candidate> candidates;
  {
    const StageTimer timer(result_.seconds.projection);
    candidates = candidates_.Of(result_.graph, new_node, options_.closures.candidates);
  }
  closer_.Close(new_node, candidates);
}

// Of the pose that is recorded next.
KeptScanId MaskedMapper::Keep(const LaserScan& scan) {
  result_.kept_scans.push_back({result_.trajectory.size(), scan});
  return static_cast<KeptScanId>(result_.kept_scans.size() - 1);
}

void MaskedMapper::RecordPose(const LaserScan& scan, const FloorInterval& interval) {
  if (!result_.trajectory.empty()) {
    travelled_since_kept_m_ += Distance(result_.trajectory.back().T_odom_robot, T_odom_robot_);
  }
  // Beside the scans of nodes, those that render the map, thinned by travel and turn.
  if (!IsNextKept() && IsDueToBeKept(interval)) Keep(scan);
  if (IsNextKept()) travelled_since_kept_m_ = 0.0;
  TrajectoryPose pose;
  pose.stamp = scan.stamp;
  pose.log_stamp = scan.log_stamp;
  pose.node_before = static_cast<NodeId>(result_.graph.nodes().size() - 1);
  pose.floor = static_cast<FloorId>(interval.level);
  pose.in_transit = interval.in_transit;
  pose.T_odom_robot = T_odom_robot_;
  result_.trajectory.push_back(pose);
}

// Whether the scan of the pose that is recorded next is kept: a node's is.
bool MaskedMapper::IsNextKept() const {
  return !result_.kept_scans.empty() &&
         result_.kept_scans.back().trajectory_index == result_.trajectory.size();
}

bool MaskedMapper::IsDueToBeKept(const FloorInterval& interval) const {
  if (interval.in_transit) return false;
  if (result_.kept_scans.empty()) return true;
  const std::size_t last = result_.kept_scans.back().trajectory_index;
  const double turned =
      WrapAngle(T_odom_robot_.theta - result_.trajectory[last].T_odom_robot.theta);
  return std::abs(turned) >= DegToRad(options_.nodes.kept_scan_angle_deg) ||
         travelled_since_kept_m_ >= options_.nodes.kept_scan_distance_m;
}

BuildingMap MaskedMapper::Finish() {
  closer_.Finish();
  BendTrajectory(result_.graph, result_.trajectory);
  result_.seconds.motion += motion_.seconds();
  return std::move(result_);
}

}  // namespace masked_mapper
