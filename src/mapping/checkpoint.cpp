// SPDX-License-Identifier: BSD-3-Clause
// What of a mapper, of a map and of a survey goes into a checkpoint. Kept apart from Algorithm 1,
// which knows nothing of it.
#include "masked_mapper/mapping/checkpoint.hpp"

#include <cmath>
#include <utility>

#include "masked_mapper.hpp"
#include "masked_mapper/sensor/state_archive.hpp"

namespace masked_mapper {

// In namespace masked_mapper, where an archive finds them by the type of what it is given.

template <class Archive>
void Serialize(Archive& archive, TrajectoryPose& pose) {
  archive(pose.stamp, pose.log_stamp, pose.floor, pose.in_transit, pose.node_before,
          pose.T_odom_robot, pose.T_world_robot);
}

template <class Archive>
void Serialize(Archive& archive, LaserScan& scan) {
  archive(scan.stamp, scan.log_stamp, scan.T_robot_laser, scan.first_angle, scan.angle_step,
          scan.max_range, scan.ranges, scan.T_odom_robot);
}

template <class Archive>
void Serialize(Archive& archive, KeptScan& kept) {
  archive(kept.trajectory_index, kept.scan);
}

template <class Archive>
void Serialize(Archive& archive, Closure& closure) {
  archive(closure.older, closure.newer, closure.T_older_newer, closure.score, closure.mahalanobis,
          closure.agreement, closure.votes, closure.state, closure.reason);
}

template <class Archive>
void Serialize(Archive& archive, Floor& floor) {
  archive(floor.label, floor.elevation, floor.elevation_sigma, floor.elevation_measured,
          floor.label_given);
}

template <class Archive>
void Serialize(Archive& archive, Edge& edge) {
  archive(edge.from, edge.to, edge.T_from_to, edge.kind, edge.closure);
}

template <class Archive>
void Serialize(Archive& archive, Node& node) {
  archive(node.stamp, node.floor, node.T_odom_robot, node.T_world_robot, node.scan);
}

template <class Archive>
void Serialize(Archive& archive, FloorLevel& level) {
  archive(level.label, level.elevation, level.elevation_sigma, level.elevation_measured,
          level.identity_known, level.open);
}

template <class Archive>
void Serialize(Archive& archive, FloorInterval& interval) {
  archive(interval.start, interval.level, interval.in_transit, interval.travelled_m,
          interval.by.bits, interval.climb, interval.climb_sigma);
}

template <class Archive>
void Serialize(Archive& archive, SensorFinding& finding) {
  archive(finding.what, finding.value, finding.sigma, finding.t_a, finding.t_b,
          finding.consequence);
}

template <class Archive>
void Serialize(Archive& archive, TimeSpan& span) {
  archive(span.start, span.end);
}

template <class Archive>
void Serialize(Archive& archive, OdometryMending& mending) {
  archive(mending.scan_clock_s, mending.travel_factor, mending.turn_factor, mending.turns_left_out,
          mending.left_out);
}

template <class Archive>
void Serialize(Archive& archive, LogSurvey& survey) {
  archive(survey.scans, survey.has_odometry, survey.odometry_moves, survey.median_travel_m,
          survey.median_turn_rad, survey.median_period_s, survey.sweep_s_per_rad,
          survey.floors.levels, survey.floors.intervals, survey.floors.heard, survey.floors.joined,
          survey.floor_source, survey.findings, survey.mending, survey.wheels, survey.reconsidered,
          survey.warnings);
}

namespace {

bool Exists(std::int32_t id, std::size_t count) {
  return id >= 0 && static_cast<std::size_t>(id) < count;
}

void WriteGraph(const PoseGraph& graph, StateWriter& writer) {
  std::vector<Floor> floors = graph.floors();
  std::vector<Edge> edges = graph.edges();
  std::vector<Node> nodes = graph.nodes();
  writer(floors, nodes, edges);
}

// The graph reads like the drive made it: floors, nodes, edges in order of their ids.
PoseGraph ReadGraph(StateReader& reader) {
  std::vector<Floor> floors;
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  reader(floors, nodes, edges);
  PoseGraph graph;
  for (Floor& floor : floors) graph.AddFloor(std::move(floor));
  for (Node& node : nodes) {
    if (!Exists(node.floor, floors.size())) StateReader::Refuse("a node on no floor");
    graph.AddNode(node);
  }
  for (const Edge& edge : edges) {
    if (!Exists(edge.from, nodes.size()) || !Exists(edge.to, nodes.size()) ||
        edge.from == edge.to ||
        (edge.kind == EdgeKind::kClosure && nodes[static_cast<std::size_t>(edge.from)].floor !=
                                                nodes[static_cast<std::size_t>(edge.to)].floor)) {
      StateReader::Refuse("an edge between nodes that none can join");
    }
    graph.AddEdge(edge);
  }
  return graph;
}

// Ids that the mapper would follow without a look.
void CheckMap(const BuildingMap& map) {
  const std::size_t nodes = map.graph.nodes().size();
  for (const TrajectoryPose& pose : map.trajectory) {
    if (!Exists(pose.floor, map.graph.floors().size()) || !Exists(pose.node_before, nodes)) {
      StateReader::Refuse("a pose that cannot be");
    }
  }
  for (const KeptScan& kept : map.kept_scans) {
    if (kept.trajectory_index >= map.trajectory.size()) {
      StateReader::Refuse("a scan without a pose");
    }
  }
  for (const Node& node : map.graph.nodes()) {
    if (node.scan != -1 && !Exists(node.scan, map.kept_scans.size())) {
      StateReader::Refuse("a node of a scan that there is not");
    }
  }
  for (const Closure& closure : map.closures) {
    if (!Exists(closure.older, nodes) || !Exists(closure.newer, nodes)) {
      StateReader::Refuse("a closure between nodes that there are not");
    }
  }
  for (const Edge& edge : map.graph.edges()) {
    if (edge.closure != -1 && !Exists(edge.closure, map.closures.size())) {
      StateReader::Refuse("an edge of a closure that there is not");
    }
  }
}

}  // namespace

std::string PackPoses(const std::vector<TrajectoryPose>& poses, std::size_t first) {
  StateWriter writer;
  for (std::size_t i = first; i < poses.size(); ++i) {
    TrajectoryPose pose = poses[i];
    writer(pose);
  }
  return writer.Take();
}

void AppendPoses(const std::string& bytes, GrownParts& parts) {
  StateReader reader(bytes);
  while (!reader.IsAtEnd()) reader(parts.trajectory.emplace_back());
}

std::string PackScans(const std::vector<KeptScan>& scans, std::size_t first) {
  StateWriter writer;
  for (std::size_t i = first; i < scans.size(); ++i) {
    KeptScan kept = scans[i];
    writer(kept);
  }
  return writer.Take();
}

void AppendScans(const std::string& bytes, GrownParts& parts) {
  StateReader reader(bytes);
  while (!reader.IsAtEnd()) reader(parts.kept_scans.emplace_back());
}

std::string PackSurvey(const LogSurvey& survey) {
  StateWriter writer;
  LogSurvey copy = survey;
  writer(copy);
  return writer.Take();
}

LogSurvey UnpackSurvey(const std::string& bytes) {
  LogSurvey survey;
  StateReader reader(bytes);
  reader(survey);
  reader.RequireEnd();
  const FloorTimeline& floors = survey.floors;
  if (floors.levels.empty() || floors.intervals.empty()) StateReader::Refuse("a drive on no floor");
  for (const FloorInterval& interval : floors.intervals) {
    if (interval.level >= floors.levels.size()) StateReader::Refuse("an interval on no floor");
  }
  return survey;
}

template <class Archive>
void DriveMotion::SerializeState(Archive& archive) {
  archive(motion_, level_, in_transit_, on_stairs_);
}

std::string DriveMotion::SaveState() {
  StateWriter writer;
  SerializeState(writer);
  return writer.Take();
}

void DriveMotion::RestoreState(const std::string& bytes) {
  StateReader reader(bytes);
  SerializeState(reader);
  reader.RequireEnd();
}

template <class Archive>
void MaskedMapper::SerializeState(Archive& archive) {
  archive(result_.closures, closer_, T_odom_robot_, T_node_robot_, last_scan_node_, in_transit_,
          travelled_since_kept_m_);
}

std::string MaskedMapper::SaveState(std::string motion) {
  StateWriter writer;
  WriteGraph(result_.graph, writer);
  SerializeState(writer);
  writer(motion);
  return writer.Take();
}

void MaskedMapper::RestoreState(const std::string& bytes, GrownParts parts) {
  StateReader reader(bytes);
  result_.graph = ReadGraph(reader);
  result_.trajectory = std::move(parts.trajectory);
  result_.kept_scans = std::move(parts.kept_scans);
  SerializeState(reader);
  std::string motion;
  reader(motion);
  reader.RequireEnd();
  motion_.RestoreState(motion);
  CheckMap(result_);
  const std::size_t nodes = result_.graph.nodes().size();
  const bool holds = result_.graph.floors().size() == floors_.levels.size() &&
                     (!last_scan_node_ || Exists(*last_scan_node_, nodes));
  if (!holds) StateReader::Refuse("a mapper that does not hold together");
}

// What Observe and the functions below it tell the mask, and nothing else of them.
void MaskedMapper::RememberScan(const LaserScan& scan) {
  const std::vector<TrajectoryPose>& trajectory = result_.trajectory;
  const TrajectoryPose& pose = trajectory.at(remembered_scans_);
  const bool is_first = remembered_scans_ == 0;
  const TrajectoryPose& before = is_first ? pose : trajectory[remembered_scans_ - 1];
  ++remembered_scans_;
  bool made_scan_node = false;
  for (NodeId node = is_first ? 0 : before.node_before + 1; node <= pose.node_before; ++node) {
    made_scan_node =
        made_scan_node || result_.graph.nodes()[static_cast<std::size_t>(node)].HasScan();
  }
  if (pose.in_transit) return;
  if (before.in_transit || before.floor != pose.floor) mask_->Restart();
  const std::size_t place = remembered_scans_ - 1;
  mask_->Observe({StraightenedAt(scan, place, pose.T_odom_robot), pose.T_odom_robot});
  if (made_scan_node) mask_->OnNode();
}

}  // namespace masked_mapper
