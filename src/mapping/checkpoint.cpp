// SPDX-License-Identifier: BSD-3-Clause
// What of a mapper, of a map and of a survey goes into a checkpoint. Kept apart from Algorithm 1,
// which knows nothing of it.
#include "masked_mapper/mapping/checkpoint.hpp"

#include <cmath>
#include <utility>

#include "masked_mapper/mapping/masked_mapper.hpp"
#include "masked_mapper/mapping/state_archive.hpp"

namespace masked_mapper {

// In namespace masked_mapper, where an archive finds them by the type of what it is given.

template <class Archive>
void Serialize(Archive& archive, TrajectoryPose& pose) {
  archive(pose.stamp, pose.floor, pose.in_transit, pose.node_before, pose.T_odom_robot,
          pose.T_world_robot);
}

template <class Archive>
void Serialize(Archive& archive, LaserScan& scan) {
  archive(scan.stamp, scan.T_robot_laser, scan.first_angle, scan.angle_step, scan.max_range,
          scan.ranges, scan.T_odom_robot);
}

template <class Archive>
void Serialize(Archive& archive, KeptScan& kept) {
  archive(kept.trajectory_index, kept.scan);
}

template <class Archive>
void Serialize(Archive& archive, ClosureAttempt& attempt) {
  archive(attempt.a, attempt.b, attempt.T_a_b, attempt.score, attempt.mahalanobis,
          attempt.agreement, attempt.votes, attempt.state, attempt.reason);
}

template <class Archive>
void Serialize(Archive& archive, Floor& floor) {
  archive(floor.label, floor.elevation, floor.elevation_sigma, floor.elevation_measured,
          floor.label_given);
}

template <class Archive>
void Serialize(Archive& archive, Edge& edge) {
  archive(edge.from, edge.to, edge.T_from_to, edge.kind);
}

template <class Archive>
void Serialize(Archive& archive, FloorLevel& level) {
  archive(level.label, level.elevation, level.elevation_sigma, level.elevation_measured,
          level.identity_known);
}

template <class Archive>
void Serialize(Archive& archive, FloorInterval& interval) {
  archive(interval.start, interval.level, interval.in_transit, interval.travelled_m);
}

template <class Archive>
void Serialize(Archive& archive, LogSurvey& survey) {
  archive(survey.scans, survey.has_odometry, survey.odometry_moves, survey.median_travel_m,
          survey.median_turn_rad, survey.median_period_s, survey.floors.levels,
          survey.floors.intervals, survey.floor_source, survey.warnings);
}

namespace {

/// A node without its points, which are among the grown parts.
struct BareNode {
  double stamp = 0.0;
  FloorId floor = 0;
  Pose2 T_odom_robot;
  Pose2 T_world_robot;

  template <class Archive>
  void Serialize(Archive& archive) {
    archive(stamp, floor, T_odom_robot, T_world_robot);
  }
};

bool Exists(std::int32_t id, std::size_t count) {
  return id >= 0 && static_cast<std::size_t>(id) < count;
}

void WriteGraph(const PoseGraph& graph, StateWriter& writer) {
  std::vector<Floor> floors = graph.floors();
  std::vector<Edge> edges = graph.edges();
  std::vector<BareNode> nodes;
  nodes.reserve(graph.nodes().size());
  for (const Node& node : graph.nodes()) {
    nodes.push_back({node.stamp, node.floor, node.T_odom_robot, node.T_world_robot});
  }
  writer(floors, nodes, edges);
}

// The graph reads like the drive made it: floors, nodes, edges in order of their ids.
PoseGraph ReadGraph(const std::vector<ScanPoints::ConstPtr>& points_of_nodes, StateReader& reader) {
  std::vector<Floor> floors;
  std::vector<BareNode> nodes;
  std::vector<Edge> edges;
  reader(floors, nodes, edges);
  if (nodes.size() != points_of_nodes.size()) StateReader::Refuse("nodes without their points");
  PoseGraph graph;
  for (Floor& floor : floors) graph.AddFloor(std::move(floor));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const BareNode& bare = nodes[i];
    if (!Exists(bare.floor, floors.size())) StateReader::Refuse("a node on no floor");
    Node node;
    node.stamp = bare.stamp;
    node.floor = bare.floor;
    node.T_odom_robot = bare.T_odom_robot;
    node.T_world_robot = bare.T_world_robot;
    node.points_in_robot = points_of_nodes[i];
    graph.AddNode(std::move(node));
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
void CheckMap(const MappingResult& map) {
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
  for (const ClosureAttempt& attempt : map.attempts) {
    if (!Exists(attempt.a, nodes) || !Exists(attempt.b, nodes)) {
      StateReader::Refuse("an attempt between nodes that there are not");
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

std::string PackPoints(const std::vector<Node>& nodes, std::size_t first) {
  StateWriter writer;
  std::vector<float> numbers;
  for (std::size_t i = first; i < nodes.size(); ++i) {
    bool has_scan = nodes[i].HasScan();
    numbers.clear();
    if (has_scan) {
      for (const pcl::PointXY& point : *nodes[i].points_in_robot) {
        numbers.push_back(point.x);
        numbers.push_back(point.y);
      }
    }
    writer(has_scan, numbers);
  }
  return writer.Take();
}

void AppendPoints(const std::string& bytes, GrownParts& parts) {
  StateReader reader(bytes);
  bool has_scan = false;
  std::vector<float> numbers;
  while (!reader.IsAtEnd()) {
    reader(has_scan, numbers);
    if (numbers.size() % 2 != 0) StateReader::Refuse("half a point");
    ScanPoints::Ptr points;
    if (has_scan) points.reset(new ScanPoints);
    for (std::size_t i = 0; has_scan && i < numbers.size(); i += 2) {
      pcl::PointXY point;
      point.x = numbers[i];
      point.y = numbers[i + 1];
      points->push_back(point);
    }
    parts.points_of_nodes.push_back(points);
  }
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
void MaskedMapper::SerializeState(Archive& archive) {
  archive(motion_, result_.attempts, closer_, last_scan_node_, in_transit_, on_stairs_,
          travelled_since_kept_m_);
}

std::string MaskedMapper::SaveState() {
  StateWriter writer;
  WriteGraph(result_.graph, writer);
  SerializeState(writer);
  return writer.Take();
}

void MaskedMapper::RestoreState(const std::string& bytes, GrownParts parts) {
  StateReader reader(bytes);
  result_.graph = ReadGraph(parts.points_of_nodes, reader);
  result_.trajectory = std::move(parts.trajectory);
  result_.kept_scans = std::move(parts.kept_scans);
  SerializeState(reader);
  reader.RequireEnd();
  CheckMap(result_);
  const std::size_t nodes = result_.graph.nodes().size();
  const bool holds = result_.graph.floors().size() == floors_.levels.size() &&
                     (!last_scan_node_ || Exists(*last_scan_node_, nodes));
  if (!holds) StateReader::Refuse("a mapper that does not hold together");
}

// What ObserveScan and the functions below it tell the mask, and nothing else of them.
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
  if (is_first && made_scan_node) mask_->OnNode();
  if (pose.in_transit) return;
  if (before.in_transit || before.floor != pose.floor) mask_->Restart();
  mask_->Observe({scan, pose.T_odom_robot});
  if (!is_first && made_scan_node) mask_->OnNode();
}

}  // namespace masked_mapper
