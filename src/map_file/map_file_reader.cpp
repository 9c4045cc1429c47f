// SPDX-License-Identifier: BSD-3-Clause
// Written as if the file came from an enemy: what a row says is believed only when it holds
// together with the rest, and nothing is allocated that the file does not pay for in bytes.
#include "masked_mapper/map_file/map_file_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "database.hpp"
#include "map_rows.hpp"
#include "masked_mapper/geometry/covariance.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "packed_bytes.hpp"
#include "schema.hpp"
#include "stored_options.hpp"

namespace masked_mapper {
namespace {

/// Packed bytes may grow so much; real ones stay below a tenth of it.
constexpr std::uint64_t kLargestGrowth = 256;

[[noreturn]] void Malformed(const std::string& table, const std::string& what) {
  throw DatabaseError("table " + table + ": " + what);
}

class Reader {
 public:
  Reader(const Database& database, std::int64_t version, std::uint64_t file_size)
      : database_(database),
        version_(version),
        bytes_left_(file_size * kLargestGrowth + (1U << 20U)) {}

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
    Link();
    ReadDrives();
    ReadLogStamps();
    return std::move(map_);
  }

 private:
  // Ids count from 0 without a gap, since rows refer to each other by place.
  static void TakeId(Statement& row, std::size_t expected, const std::string& table) {
    if (row.Integer() != static_cast<std::int64_t>(expected)) Malformed(table, "a row is missing");
  }

  static double Finite(Statement& row, const std::string& table) {
    const double value = row.Real();
    if (!std::isfinite(value)) Malformed(table, "a number is not finite");
    return value;
  }

  static Pose2 TakePose(Statement& row, const std::string& table) {
    Pose2 pose;
    pose.x = Finite(row, table);
    pose.y = Finite(row, table);
    pose.theta = Finite(row, table);
    return pose;
  }

  static Eigen::Matrix3d TakeCovariance(Statement& row, const std::string& table) {
    std::string_view bytes = row.Blob();
    if (bytes.size() != kCovarianceBytes) Malformed(table, "a covariance of the wrong size");
    Eigen::Matrix3d covariance;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) covariance(i, j) = TakeNumber<double>(bytes);
    }
    if (!IsCovariance(covariance)) Malformed(table, "a covariance that is none");
    return covariance;
  }

  static std::int64_t TakeBelow(Statement& row, std::size_t limit, const std::string& table,
                                const std::string& what) {
    const std::int64_t value = row.Integer();
    if (value < 0 || static_cast<std::uint64_t>(value) >= limit) {
      Malformed(table, what + " " + std::to_string(value) + " does not exist");
    }
    return value;
  }

  // -1 where there is none; that it exists is for later.
  static std::int32_t TakeIdOrNone(Statement& row, const std::string& table,
                                   const std::string& what) {
    if (row.NextType() == ValueType::kNull) {
      row.Skip();
      return -1;
    }
    return static_cast<std::int32_t>(
        TakeBelow(row, std::numeric_limits<std::int32_t>::max(), table, what));
  }

  static bool TakeFlag(Statement& row, const std::string& table) {
    return TakeBelow(row, 2, table, "the flag") == 1;
  }

  template <typename Enumeration, std::size_t kSize>
  static Enumeration TakeName(Statement& row, const std::array<const char*, kSize>& names,
                              const std::string& table) {
    return NameValue<Enumeration>(row.Text(), names, table);
  }

  template <typename Enumeration, std::size_t kSize>
  static Enumeration NameValue(std::string_view name, const std::array<const char*, kSize>& names,
                               const std::string& table) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (name == names[i]) return static_cast<Enumeration>(i);
    }
    Malformed(table, "an unknown name");
  }

  // The bytes of `count` records of `width` bytes, of the three columns count, bytes and checksum.
  std::string TakePacked(Statement& row, std::int64_t count, std::size_t width,
                         const std::string& table) {
    const std::string_view packed = row.Blob();
    if (row.Integer() != std::int64_t{Checksum(packed)}) {
      Malformed(table, "bytes that do not fit their checksum");
    }
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_left_ / width) {
      Malformed(table, "more is promised than the file can hold");
    }
    const std::size_t size = static_cast<std::size_t>(count) * width;
    bytes_left_ -= size;
    return Unpack(packed, width, size);
  }

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
    map_.origin.identity = values["identity"];
    for (std::size_t number = 2;; ++number) {
      const auto later = values.find("log." + std::to_string(number));
      if (later == values.end()) break;
      map_.origin.later_logs.push_back({later->second, values["floors." + std::to_string(number)]});
    }
    map_.result.motion_source =
        NameValue<MotionSource>(values["motion_source"], kMotionSources, "run");
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
        if (key == measure.key) log.*measure.field = Finite(rows, "log_statistics");
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
        *number = Finite(findings, "findings");
      }
      finding.consequence = findings.Text();
      map_.result.findings.push_back(std::move(finding));
    }
  }

  void ReadFloors() {
    PoseGraph& graph = map_.result.graph;
    Statement rows(database_, "SELECT * FROM floors ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, graph.floors().size(), "floors");
      Floor floor;
      floor.label = rows.Text();
      floor.elevation = Finite(rows, "floors");
      floor.elevation_sigma = Finite(rows, "floors");
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
      node.stamp = Finite(rows, "nodes");
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
      graph.AddNode(std::move(node));
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
      edge.kind = TakeName<EdgeKind>(rows, kEdgeKinds, "edges");
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
      closure.score = Finite(rows, table);
      closure.mahalanobis = Finite(rows, table);
      closure.agreement = Finite(rows, table);
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

  // What names another row must name one that there is, and that fits.
  void Link() {
    std::vector<Node> nodes = map_.result.graph.nodes();
    for (Node& node : nodes) {
      if (node.HasScan()) node.scan = ScanOf(node);
    }
    std::vector<Edge> edges = map_.result.graph.edges();
    if (version_ <= 2) NameClosures(edges);
    PoseGraph linked;
    for (const Floor& floor : map_.result.graph.floors()) linked.AddFloor(floor);
    for (Node& node : nodes) linked.AddNode(std::move(node));
    for (Edge& edge : edges) {
      if (edge.closure >= 0 && !IsOf(edge)) Malformed("edges", "an edge of another closure");
      linked.AddEdge(std::move(edge));
    }
    map_.result.graph = std::move(linked);
  }

  // Before version 3 a node's scan need not be among the kept ones: the one kept next to it is.
  KeptScanId ScanOf(const Node& node) const {
    const std::vector<KeptScan>& kept = map_.result.kept_scans;
    if (version_ > 2) {
      if (static_cast<std::size_t>(node.scan) < kept.size()) return node.scan;
      Malformed("nodes", "a node of a scan that does not exist");
    }
    const auto off = [&](const KeptScan& scan) { return std::abs(scan.scan.stamp - node.stamp); };
    const auto nearest = std::min_element(
        kept.begin(), kept.end(),
        [&](const KeptScan& one, const KeptScan& other) { return off(one) < off(other); });
    return nearest == kept.end() ? -1 : static_cast<KeptScanId>(nearest - kept.begin());
  }

  // Before version 3 the closures of a pair stand among the edges in the order of their records,
  // and lead from the newer node to the older.
  void NameClosures(std::vector<Edge>& edges) const {
    std::map<std::pair<NodeId, NodeId>, std::vector<ClosureId>> unnamed;
    for (std::size_t i = map_.result.closures.size(); i-- > 0;) {
      const Closure& closure = map_.result.closures[i];
      if (closure.state != ClosureState::kValidated) continue;
      unnamed[{closure.newer, closure.older}].push_back(static_cast<ClosureId>(i));
    }
    for (Edge& edge : edges) {
      const auto found = unnamed.find({edge.from, edge.to});
      if (edge.kind != EdgeKind::kClosure || found == unnamed.end() || found->second.empty()) {
        continue;
      }
      edge.closure = found->second.back();
      found->second.pop_back();
      std::swap(edge.from, edge.to);
      edge.T_from_to = Inverse(edge.T_from_to);
    }
  }

  bool IsOf(const Edge& edge) const {
    const auto id = static_cast<std::size_t>(edge.closure);
    if (edge.kind != EdgeKind::kClosure || id >= map_.result.closures.size()) return false;
    const Closure& closure = map_.result.closures[id];
    return closure.state == ClosureState::kValidated && closure.older == edge.from &&
           closure.newer == edge.to;
  }

  void ReadTrajectory() {
    std::size_t next = 0;
    Statement rows(database_, "SELECT * FROM trajectory ORDER BY id");
    while (rows.Next()) {
      TakeId(rows, next++, "trajectory");
      const std::int64_t count = rows.Integer();
      const std::string bytes = TakePacked(rows, count, kPoseBytes, "trajectory");
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

  LaserScan TakeScan(Statement& row) {
    LaserScan scan;
    scan.stamp = Finite(row, "scans");
    scan.T_robot_laser = TakePose(row, "scans");
    scan.first_angle = Finite(row, "scans");
    scan.angle_step = Finite(row, "scans");
    scan.max_range = static_cast<float>(Finite(row, "scans"));
    if (row.NextType() == ValueType::kNull) {
      for (int i = 0; i < 3; ++i) row.Skip();
    } else {
      scan.T_odom_robot = TakePose(row, "scans");
    }
    const std::int64_t count = row.Integer();
    const std::string bytes = TakePacked(row, count, sizeof(float), "scans");
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
      map.trajectory[static_cast<std::size_t>(pose)].log_stamp = Finite(rows, "log_stamps");
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
      drive.stamp_offset_s = Finite(rows, "drives");
      drive.motion_source = TakeName<MotionSource>(rows, kMotionSources, "drives");
      drive.reason = rows.Text();
      const bool follows = map.drives.empty() ? drive.first_pose == 0 && drive.first_node == 0
                                              : drive.first_pose > map.drives.back().first_pose &&
                                                    drive.first_node > map.drives.back().first_node;
      if (!follows) Malformed("drives", "drives that do not follow each other");
      map.drives.push_back(std::move(drive));
    }
    if (map.drives.size() < 2) return;
    for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
      const IndexRange nodes = NodesOfDrive(map, drive);
      const IndexRange poses = PosesOfDrive(map, drive);
      for (std::size_t i = poses.begin; i < poses.end; ++i) {
        const auto node = static_cast<std::size_t>(map.trajectory[i].node_before);
        if (node < nodes.begin || node >= nodes.end) {
          Malformed("drives", "a pose at a node of another drive");
        }
      }
    }
    for (std::size_t i = 1; i < map.kept_scans.size(); ++i) {
      if (map.kept_scans[i].trajectory_index <= map.kept_scans[i - 1].trajectory_index) {
        Malformed("scans", "scans that do not follow each other");
      }
    }
  }

  const Database& database_;
  std::int64_t version_;      // of the file
  std::uint64_t bytes_left_;  // that may still be unpacked
  SavedMap map_;
};

// What can be said before SQLite looks at the file, in clearer words than SQLite has.
std::uint64_t CheckIsDatabase(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path.string() + ": not a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path.string() + ": cannot be read");
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  std::string magic(kMagic.size(), '\0');
  in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (!in || magic != kMagic) throw InputError(path.string() + ": not a saved map");
  return std::filesystem::file_size(path, error);
}

}  // namespace

SavedMap ReadMapFile(const std::filesystem::path& path) {
  const std::uint64_t size = CheckIsDatabase(path);
  try {
    Database database(path, OpenMode::kRead);
    if (database.Number("PRAGMA application_id") != kMapApplicationId) {
      throw InputError(path.string() + ": not a saved map, but another database");
    }
    const std::int64_t version = database.Number("PRAGMA user_version");
    if (version > kMapVersion) {
      throw InputError(path.string() + ": written by a newer program (map version " +
                       std::to_string(version) + ", this one reads up to " +
                       std::to_string(kMapVersion) + ")");
    }
    if (version < 1) throw DatabaseError("it has no version");
    CheckSeal(database, version);
    if (version == kMapVersion) return Reader(database, version, size).Read();
    Database upgraded = Database::CopyInMemory(database);
    Upgrade(upgraded, version);
    return Reader(upgraded, version, size).Read();
  } catch (const DatabaseError& error) {
    throw InputError(path.string() + ": damaged, cannot be used: " + error.what());
  }
}

}  // namespace masked_mapper
