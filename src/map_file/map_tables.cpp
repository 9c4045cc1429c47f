// SPDX-License-Identifier: BSD-3-Clause
#include "map_tables.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "annotation_rows.hpp"
#include "link_rows.hpp"
#include "map_rows.hpp"
#include "masked_mapper/map/drives.hpp"
#include "packed_bytes.hpp"
#include "row_values.hpp"
#include "schema.hpp"
#include "stored_options.hpp"

namespace masked_mapper {
namespace {

class Reader {
 public:
  Reader(const Database& database, std::int64_t version, std::uint64_t file_size)
      : database_(database), version_(version), packed_(file_size) {}

  SavedMap Read() {
    ReadOptions();
    ReadRun();
    ReadLog();
    ReadFloors();
    ReadNodes();
    ReadEdges();
    ReadClosures();
    ReadTrajectory();
    ReadScans();
    LinkRows(version_, map_.result);
    ReadTransits();
    ReadDrives();
    ReadLogStamps();
    ReadAnnotations(database_, map_.result);
    if (version_ > kMapVersionWithoutClouds) ReadClouds();
    return std::move(map_);
  }

 private:
  void ReadOptions() {
    StoredOptions stored;
    Statement rows(database_, "SELECT key, value FROM options ORDER BY id");
    while (rows.Next()) {
      std::string key(rows.Text());
      stored.Add(std::move(key), std::string(rows.Text()));
    }
    map_.origin.options = stored.Take(map_.left_aside);
  }

  void ReadRun() {
    std::map<std::string, std::string> values;
    Statement rows(database_, "SELECT key, value FROM run ORDER BY id");
    while (rows.Next()) {
      std::string key(rows.Text());
      values.emplace(std::move(key), rows.Text());
    }
    for (const char* key : {"log", "mask", "motion_source"}) {
      if (values.count(key) == 0) Malformed("run", std::string(key) + " is missing");
    }
    map_.origin.log = values["log"];
    map_.origin.mask = values["mask"];
    map_.origin.onto = values["onto"];
    map_.origin.so_far = values["so_far"];
    map_.origin.identity = values["identity"];
    for (std::size_t number = 2;; ++number) {
      const auto later = values.find("log." + std::to_string(number));
      if (later == values.end()) break;
      map_.origin.later_logs.push_back({later->second, values["floors." + std::to_string(number)]});
    }
    map_.result.motion_source = ValueNamed<MotionSource>(values["motion_source"], "run");
  }

  void ReadLog() {
    LogStatistics& log = map_.result.log;
    Statement rows(database_, "SELECT key, value FROM log_statistics ORDER BY id");
    while (rows.Next()) {
      const std::string key(rows.Text());
      for (const LogCount& count : kLogCounts) {
        if (key == count.key) log.*count.field = static_cast<std::uint64_t>(rows.Integer());
      }
      for (const LogMeasure& measure : kLogMeasures) {
        if (key == measure.key) log.*measure.field = TakeFinite(rows, "log_statistics");
      }
      if (key == "truncated") log.truncated = TakeFlag(rows, "log_statistics");
      if (key == "first_bad_line") log.first_bad_line = rows.Text();
    }
    Statement other(database_, "SELECT name, count FROM other_messages ORDER BY id");
    while (other.Next()) {
      std::string name(other.Text());
      log.other_messages.emplace(std::move(name), static_cast<std::uint64_t>(other.Integer()));
    }
    Statement warnings(database_, "SELECT text FROM warnings ORDER BY id");
    while (warnings.Next()) map_.result.warnings.emplace_back(warnings.Text());
    Statement findings(database_, "SELECT * FROM findings ORDER BY id");
    while (findings.Next()) {
      TakeId(findings, map_.result.findings.size(), "findings");
      SensorFinding finding;
      finding.what = findings.Text();
      for (double* number : {&finding.value, &finding.sigma, &finding.t_a, &finding.t_b}) {
        *number = TakeFinite(findings, "findings");
      }
      finding.consequence = findings.Text();
      map_.result.findings.push_back(std::move(finding));
    }
  }

  void ReadTransits() {
    Statement rows(database_, "SELECT * FROM transits ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, map_.result.transits.size(), "transits");
      TransitRecord transit;
      for (double* number : {&transit.t_out, &transit.t_in, &transit.height_m, &transit.sigma_m}) {
        *number = TakeFinite(rows, "transits");
      }
      std::istringstream sensors{std::string(rows.Text())};
      for (std::string sensor; sensors >> sensor;) transit.by.push_back(sensor);
      transit.open = rows.Text();
      map_.result.transits.push_back(std::move(transit));
    }
  }

  void ReadFloors() {
    PoseGraph& graph = map_.result.graph;
    Statement rows(database_, "SELECT * FROM floors ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, graph.floors().size(), "floors");
      Floor floor;
      floor.label = rows.Text();
      floor.elevation = TakeFinite(rows, "floors");
      floor.elevation_sigma = TakeFinite(rows, "floors");
      floor.elevation_measured = TakeFlag(rows, "floors");
      floor.label_given = TakeFlag(rows, "floors");
      graph.AddFloor(std::move(floor));
    }
  }

  void ReadNodes() {
    PoseGraph& graph = map_.result.graph;
    Statement rows(database_, "SELECT * FROM nodes ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, graph.nodes().size(), "nodes");
      Node node;
      node.stamp = TakeFinite(rows, "nodes");
      node.floor =
          static_cast<FloorId>(TakeBelow(rows, graph.floors().size(), "nodes", "the floor"));
      node.T_odom_robot = TakePose(rows, "nodes");
      node.T_world_robot = TakePose(rows, "nodes");
      // Before version 3 a node's points stand here; of them all that is told is that it has some.
      if (version_ <= 2) {
        node.scan = rows.NextType() == ValueType::kNull ? -1 : 0;
      } else {
        node.scan = TakeIdOrNone(rows, "nodes", "the scan");
      }
      graph.AddNode(node);
    }
  }

  void ReadEdges() {
    PoseGraph& graph = map_.result.graph;
    const std::size_t nodes = graph.nodes().size();
    Statement rows(database_, "SELECT * FROM edges ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, graph.edges().size(), "edges");
      Edge edge;
      edge.from = static_cast<NodeId>(TakeBelow(rows, nodes, "edges", "the node"));
      edge.to = static_cast<NodeId>(TakeBelow(rows, nodes, "edges", "the node"));
      edge.kind = ValueNamed<EdgeKind>(rows.Text(), "edges");
      edge.T_from_to.mean = TakePose(rows, "edges");
      edge.T_from_to.covariance = TakeCovariance(rows, "edges");
      const bool same_floor = graph.nodes()[static_cast<std::size_t>(edge.from)].floor ==
                              graph.nodes()[static_cast<std::size_t>(edge.to)].floor;
      if (edge.from == edge.to || (edge.kind == EdgeKind::kClosure && !same_floor)) {
        Malformed("edges", "an edge between nodes that none can join");
      }
      edge.closure = TakeIdOrNone(rows, "edges", "the closure");
      graph.AddEdge(edge);
    }
  }

  void ReadClosures() {
    const std::size_t nodes = map_.result.graph.nodes().size();
    const std::string table = version_ <= 2 ? "attempts" : "closures";
    Statement rows(database_, "SELECT * FROM " + table + " ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, map_.result.closures.size(), table);
      Closure closure;
      closure.older = static_cast<NodeId>(TakeBelow(rows, nodes, table, "the node"));
      closure.newer = static_cast<NodeId>(TakeBelow(rows, nodes, table, "the node"));
      closure.T_older_newer.mean = TakePose(rows, table);
      closure.T_older_newer.covariance = TakeCovariance(rows, table);
      if (version_ <= 2) {  // the newer one came first
        std::swap(closure.older, closure.newer);
        closure.T_older_newer = Inverse(closure.T_older_newer);
      }
      closure.score = TakeFinite(rows, table);
      closure.mahalanobis = TakeFinite(rows, table);
      closure.agreement = TakeFinite(rows, table);
      closure.votes = static_cast<int>(
          TakeBelow(rows, std::size_t{std::numeric_limits<int>::max()}, table, "the count"));
      const std::optional<ClosureState> state = ClosureStateOf(rows.Text());
      const std::optional<ClosureReason> reason = ClosureReasonOf(rows.Text());
      if (!state || !reason) Malformed(table, "an unknown name");
      closure.state = *state;
      closure.reason = *reason;
      map_.result.closures.push_back(std::move(closure));
    }
  }

  void ReadTrajectory() {
    std::size_t next = 0;
    Statement rows(database_, "SELECT * FROM trajectory ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, next++, "trajectory");
      const std::int64_t count = rows.Integer();
      const std::string bytes = packed_.Take(rows, count, kPoseBytes, "trajectory");
      std::string_view rest = bytes;
      while (!rest.empty()) map_.result.trajectory.push_back(TakeTrajectoryPose(rest));
    }
  }

  TrajectoryPose TakeTrajectoryPose(std::string_view& bytes) const {
    TrajectoryPose pose;
    pose.stamp = TakeNumber<double>(bytes);
    pose.floor = TakeNumber<FloorId>(bytes);
    const auto in_transit = TakeNumber<std::uint8_t>(bytes);
    pose.in_transit = in_transit == 1;
    pose.node_before = TakeNumber<NodeId>(bytes);
    bool is_finite = std::isfinite(pose.stamp);
    for (Pose2* T : {&pose.T_odom_robot, &pose.T_world_robot}) {
      for (double Pose2::*part : {&Pose2::x, &Pose2::y, &Pose2::theta}) {
        T->*part = TakeNumber<double>(bytes);
        is_finite = is_finite && std::isfinite(T->*part);
      }
    }
    const PoseGraph& graph = map_.result.graph;
    const auto exists = [](std::int32_t id, std::size_t count) {
      return id >= 0 && static_cast<std::size_t>(id) < count;
    };
    if (!is_finite || in_transit > 1 || !exists(pose.floor, graph.floors().size()) ||
        !exists(pose.node_before, graph.nodes().size())) {
      Malformed("trajectory", "a pose that cannot be");
    }
    return pose;
  }

  void ReadScans() {
    const std::size_t poses = map_.result.trajectory.size();
    Statement rows(database_, "SELECT * FROM scans ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, map_.result.kept_scans.size(), "scans");
      KeptScan kept;
      kept.trajectory_index = static_cast<std::size_t>(TakeBelow(rows, poses, "scans", "the pose"));
      kept.scan = TakeScan(rows);
      map_.result.kept_scans.push_back(std::move(kept));
    }
  }

  // What is in them is held against their lengths when it is wanted.
  void ReadClouds() {
    const std::vector<TrajectoryPose>& poses = map_.result.trajectory;
    Statement rows(database_, "SELECT * FROM clouds ORDER BY id");
    while (rows.Next()) {
      std::vector<KeptCloud>& clouds = map_.result.kept_clouds;
      TakeId(rows, clouds.size(), "clouds");
      KeptCloud kept;
      kept.trajectory_index =
          static_cast<std::size_t>(TakeBelow(rows, poses.size(), "clouds", "the pose"));
      if (!clouds.empty() && kept.trajectory_index <= clouds.back().trajectory_index) {
        Malformed("clouds", "clouds that do not follow each other");
      }
      kept.packed = std::make_shared<const std::string>(rows.Blob());
      clouds.push_back(std::move(kept));
    }
  }

  LaserScan TakeScan(Statement& row) {
    LaserScan scan;
    scan.stamp = TakeFinite(row, "scans");
    scan.T_robot_laser = TakePose(row, "scans");
    scan.first_angle = TakeFinite(row, "scans");
    scan.angle_step = TakeFinite(row, "scans");
    scan.max_range = static_cast<float>(TakeFinite(row, "scans"));
    if (row.NextType() == ValueType::kNull) {
      for (int i = 0; i < 3; ++i) row.Skip();
    } else {
      scan.T_odom_robot = TakePose(row, "scans");
    }
    const std::int64_t count = row.Integer();
    const std::string bytes = packed_.Take(row, count, sizeof(float), "scans");
    std::string_view rest = bytes;
    scan.ranges.reserve(static_cast<std::size_t>(count));
    while (!rest.empty()) {
      const auto range = TakeNumber<float>(rest);
      if (range <= 0.0F) Malformed("scans", "a range that is not above zero");
      scan.ranges.push_back(range);
    }
    return scan;
  }

  // The log's own stamps: those of the map without the shift of the drive, but for some.
  void ReadLogStamps() {
    BuildingMap& map = map_.result;
    for (TrajectoryPose& pose : map.trajectory) pose.log_stamp = pose.stamp;
    for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
      const IndexRange poses = PosesOfDrive(map, drive);
      for (std::size_t i = poses.begin; i < poses.end; ++i) {
        map.trajectory[i].log_stamp -= map.drives[drive].stamp_offset_s;
      }
    }
    Statement rows(database_, "SELECT * FROM log_stamps ORDER BY id");
    while (rows.Next()) {
      const std::int64_t pose = TakeBelow(rows, map.trajectory.size(), "log_stamps", "the pose");
      map.trajectory[static_cast<std::size_t>(pose)].log_stamp = TakeFinite(rows, "log_stamps");
    }
    for (KeptScan& kept : map.kept_scans) {
      kept.scan.log_stamp = map.trajectory[kept.trajectory_index].log_stamp;
    }
  }

  // Drives follow each other, each with a node and a pose at least, and keep to themselves.
  void ReadDrives() {
    BuildingMap& map = map_.result;
    Statement rows(database_, "SELECT * FROM drives ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, map.drives.size(), "drives");
      Drive drive;
      drive.log = rows.Text();
      drive.first_pose =
          static_cast<std::size_t>(TakeBelow(rows, map.trajectory.size(), "drives", "the pose"));
      drive.first_node =
          static_cast<NodeId>(TakeBelow(rows, map.graph.nodes().size(), "drives", "the node"));
      drive.stamp_offset_s = TakeFinite(rows, "drives");
      drive.motion_source = ValueNamed<MotionSource>(rows.Text(), "drives");
      drive.reason = rows.Text();
      const bool follows = map.drives.empty() ? drive.first_pose == 0 && drive.first_node == 0
                                              : drive.first_pose > map.drives.back().first_pose &&
                                                    drive.first_node > map.drives.back().first_node;
      if (!follows) Malformed("drives", "drives that do not follow each other");
      map.drives.push_back(std::move(drive));
    }
    CheckDrives(map);
  }

  const Database& database_;
  std::int64_t version_;  // of the file
  PackedColumns packed_;
  SavedMap map_;
};

}  // namespace

SavedMap ReadTables(const Database& database, std::int64_t version, std::uint64_t file_size) {
  return Reader(database, version, file_size).Read();
}

}  // namespace masked_mapper
