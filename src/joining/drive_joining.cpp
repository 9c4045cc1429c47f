// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/drive_joining.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/loop_closure/loop_closer.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/map/surroundings.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "piece_search.hpp"

namespace masked_mapper {
namespace {

constexpr double kGapBetweenPieces = 5.0;  // m
constexpr double kScanEvery = 0.5;         // m of travel between scans around a node

void AddStatistics(const LogStatistics& more, LogStatistics& log) {
  log.lines += more.lines;
  log.scans += more.scans;
  log.odometry += more.odometry;
  log.pressure += more.pressure;
  log.acceleration += more.acceleration;
  log.floor_labels += more.floor_labels;
  log.bad_lines += more.bad_lines;
  log.invalid_ranges += more.invalid_ranges;
  log.empty_scans += more.empty_scans;
  log.stamp_jumps += more.stamp_jumps;
  log.reordered += more.reordered;
  log.trailing_bytes += more.trailing_bytes;
  for (const auto& [name, count] : more.other_messages) log.other_messages[name] += count;
  log.truncated = log.truncated || more.truncated;
  if (log.first_bad_line.empty()) log.first_bad_line = more.first_bad_line;
  log.max_range = std::max(log.max_range, more.max_range);
  log.first_stamp = std::min(log.first_stamp, more.first_stamp);
  log.last_stamp = std::max(log.last_stamp, more.last_stamp);
}

void ShiftStamps(double seconds, BuildingMap& map) {
  if (seconds == 0.0) return;
  map.graph.ShiftStamps(seconds);
  for (TrajectoryPose& pose : map.trajectory) pose.stamp += seconds;
  for (KeptScan& kept : map.kept_scans) kept.scan.stamp += seconds;
  for (TransitRecord& transit : map.transits) {
    transit.t_out += seconds;
    transit.t_in += seconds;
  }
  for (Drive& drive : map.drives) drive.stamp_offset_s += seconds;
  map.log.first_stamp += seconds;
  map.log.last_stamp += seconds;
}

class DriveJoiner {
 public:
  DriveJoiner(BuildingMap first, const DriveJoinOptions& options,
              const LoopClosureOptions& closures)
      : joins_(options), closures_(closures) {
    map_ = std::move(first);
  }

  void Append(BuildingMap more) {
    const double offset = StampOffset(more);
    ShiftStamps(offset, more);
    const auto floors = static_cast<FloorId>(map_.graph.floors().size());
    const auto nodes = static_cast<NodeId>(map_.graph.nodes().size());
    const std::size_t poses = map_.trajectory.size();
    for (const Floor& floor : more.graph.floors()) map_.graph.AddFloor(floor);
    const auto scans = static_cast<KeptScanId>(map_.kept_scans.size());
    for (Node node : more.graph.nodes()) {
      node.floor += floors;
      if (node.HasScan()) node.scan += scans;
      map_.graph.AddNode(node);
    }
    const auto closures = static_cast<ClosureId>(map_.closures.size());
    for (Edge edge : more.graph.edges()) {
      edge.from += nodes;
      edge.to += nodes;
      if (edge.closure >= 0) edge.closure += closures;
      map_.graph.AddEdge(std::move(edge));
    }
    for (Closure& closure : more.closures) {
      closure.older += nodes;
      closure.newer += nodes;
      map_.closures.push_back(std::move(closure));
    }
    for (TrajectoryPose pose : more.trajectory) {
      pose.floor += floors;
      pose.node_before += nodes;
      map_.trajectory.push_back(pose);
    }
    map_.transits.insert(map_.transits.end(), more.transits.begin(), more.transits.end());
    for (KeptScan& kept : more.kept_scans) {
      kept.trajectory_index += poses;
      map_.kept_scans.push_back(std::move(kept));
    }
    for (KeptCloud& kept : more.kept_clouds) {
      kept.trajectory_index += poses;
      map_.kept_clouds.push_back(std::move(kept));
    }
    for (Drive& drive : more.drives) {
      drive.first_pose += poses;
      drive.first_node += nodes;
      map_.drives.push_back(std::move(drive));
    }
    AddStatistics(more.log, map_.log);
    map_.seconds += more.seconds;
    map_.findings.insert(map_.findings.end(), more.findings.begin(), more.findings.end());
    map_.warnings.insert(map_.warnings.end(), more.warnings.begin(), more.warnings.end());
    if (offset != 0.0) {
      said_.push_back(map_.drives.back().log + ": its stamps are shifted by " +
                      FixedText(offset, 0) + " s, to follow the others");
    }
  }

  /// Each piece is held against those before it, and those that it joins against the rest again.
  void Join(ProgressSink& progress) {
    PartFloors();
    std::size_t newer = 1;
    double done = 0.0;
    while (newer < CountPieces()) {
      bool joined = false;
      for (std::size_t older = 0; older < newer && !joined; ++older) {
        // Also lets an interrupt through. Pieces that joined are tried again, which is no way back.
        const auto pieces = static_cast<double>(CountPieces());
        done = std::max(done, static_cast<double>(newer - 1) / pieces);
        progress.Progress(done, 0);
        joined = TryJoin(older, newer);
      }
      newer = joined ? 1 : newer + 1;
    }
    NameFloors();
    PlaceBeside();
    BendTrajectory(map_.graph, map_.trajectory);
  }

  /// What people should know of the joining.
  const std::vector<std::string>& said() const { return said_; }

  BuildingMap Take() {
    map_.warnings.insert(map_.warnings.end(), said_.begin(), said_.end());
    return std::move(map_);
  }

 private:
  // Whole seconds that keep stamps from stepping back.
  double StampOffset(const BuildingMap& more) const {
    if (more.trajectory.empty() || map_.trajectory.empty()) return 0.0;
    const double last = map_.trajectory.back().stamp;
    const double first = more.trajectory.front().stamp;
    if (first > last) return 0.0;
    return std::floor(last - first) + 1.0;
  }

  std::size_t CountPieces() const {
    const std::vector<std::size_t> pieces = PiecesOfDrives(map_);
    return 1 + *std::max_element(pieces.begin(), pieces.end());
  }

  std::vector<std::size_t> DrivesOf(std::size_t piece) const {
    const std::vector<std::size_t> pieces = PiecesOfDrives(map_);
    std::vector<std::size_t> drives;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i] == piece) drives.push_back(i);
    }
    return drives;
  }

  // Every piece on floors of its own, called as its logs call them. In a map that was mended by
  // hand two pieces may be on one floor: closures were forbidden, or are still to be added.
  void PartFloors() {
    std::vector<Floor> floors = map_.graph.floors();
    std::vector<bool> is_owned(floors.size(), false);
    std::vector<FloorId> floor_of_node(map_.graph.nodes().size());
    for (std::size_t piece = 0; piece < CountPieces(); ++piece) {
      const std::vector<std::size_t> drives = DrivesOf(piece);
      std::map<FloorId, FloorId> becomes;
      for (const FloorId floor : FloorsOf(drives)) {
        becomes[floor] = floor;
        if (is_owned[static_cast<std::size_t>(floor)]) {
          becomes[floor] = static_cast<FloorId>(floors.size());
          floors.push_back(map_.graph.floors()[static_cast<std::size_t>(floor)]);
        } else {
          is_owned[static_cast<std::size_t>(floor)] = true;
        }
        Floor& own = floors[static_cast<std::size_t>(becomes[floor])];
        if (own.label_given) own.label = WithoutSuffix(own.label, SuffixOf(piece, drives));
      }
      for (const std::size_t drive : drives) {
        const IndexRange nodes = NodesOfDrive(map_, drive);
        for (std::size_t i = nodes.begin; i < nodes.end; ++i) {
          floor_of_node[i] = becomes.at(map_.graph.nodes()[i].floor);
        }
        const IndexRange poses = PosesOfDrive(map_, drive);
        for (std::size_t i = poses.begin; i < poses.end; ++i) {
          map_.trajectory[i].floor = becomes.at(map_.trajectory[i].floor);
        }
      }
    }
    map_.graph.Refloor(std::move(floors), floor_of_node);
  }

  static std::string SuffixOf(std::size_t piece, const std::vector<std::size_t>& drives) {
    return piece == 0 ? "" : ".drive" + std::to_string(drives.front() + 1);
  }

  // The parts of the map that joining changes.
  struct Before {
    PoseGraph graph;
    std::vector<TrajectoryPose> trajectory;
    std::vector<Closure> closures;
  };

  bool TryJoin(std::size_t older_piece, std::size_t newer_piece) {
    const std::vector<std::size_t> older = DrivesOf(older_piece);
    const std::vector<std::size_t> newer = DrivesOf(newer_piece);
    // A pair that was looked at before is looked at again only when one of them has grown.
    if (!tried_.emplace(std::make_pair(older, newer)).second) return false;
    std::string& reason = map_.drives[newer.front()].reason;
    if (AreForbidden(older, newer)) {
      reason = "its closures were forbidden by hand";
      return false;
    }
    PieceSearchResult found;
    {
      const StageTimer timer(map_.seconds.matching);
      found = FindPiece(map_, older, newer, joins_, closures_.matcher);
    }
    if (!found.placement) {
      if (older_piece == 0) reason = found.reason;
      return false;
    }
    Before before{map_.graph, map_.trajectory, map_.closures};
    Lay(*found.placement, older, newer);
    const std::size_t offered_from = map_.closures.size();
    LoopClosureOptions options = closures_;
    options.laid_out_by_scans = AreLaidOutByScans(older) && AreLaidOutByScans(newer);
    options.refine = options.laid_out_by_scans;
    LoopCloser closer(options, map_, [this](NodeId node) { return SurroundingsOf(node); });
    std::size_t closures = 0;
    for (const std::size_t drive : newer) {
      const IndexRange nodes = NodesOfDrive(map_, drive);
      for (std::size_t i = nodes.begin; i < nodes.end; ++i) {
        if (map_.graph.nodes()[i].HasScan()) {
          closures += closer.Close(static_cast<NodeId>(i), CandidatesOf(i, older));
        }
      }
    }
    // Late closures are held against the map, which says nothing where none tied the two.
    if (closures > 0) closer.Finish();
    const std::vector<std::size_t> pieces = PiecesOfDrives(map_);
    const bool joined = pieces[older.front()] == pieces[newer.front()];
    if (!joined) {
      const auto first_new = map_.closures.begin() + static_cast<std::ptrdiff_t>(offered_from);
      for (auto closure = first_new; closure != map_.closures.end(); ++closure) {
        if (closure->state != ClosureState::kValidated) continue;
        closure->state = ClosureState::kAuditedOut;
        closure->reason = ClosureReason::kTooFewTies;
      }
      before.closures.insert(before.closures.end(), first_new, map_.closures.end());
      map_.graph = std::move(before.graph);
      map_.trajectory = std::move(before.trajectory);
      map_.closures = std::move(before.closures);
      map_.drives[newer.front()].reason =
          found.reason + ", but too few matches agree for a closure to be sure";
      return false;
    }
    BendTrajectory(map_.graph, map_.trajectory);
    map_.drives[newer.front()].reason = found.reason;
    return true;
  }

  bool AreLaidOutByScans(const std::vector<std::size_t>& drives) const {
    return std::all_of(drives.begin(), drives.end(), [&](std::size_t drive) {
      return map_.drives[drive].motion_source != MotionSource::kOdometry;
    });
  }

  // Whether somebody took closures between these drives away, and so the drives apart.
  bool AreForbidden(const std::vector<std::size_t>& older,
                    const std::vector<std::size_t>& newer) const {
    const auto is_of = [&](const std::vector<std::size_t>& drives, NodeId node) {
      return std::count(drives.begin(), drives.end(), DriveOfNode(map_, node)) > 0;
    };
    return std::any_of(map_.closures.begin(), map_.closures.end(), [&](const Closure& closure) {
      return closure.reason == ClosureReason::kForbiddenByHand &&
             ((is_of(older, closure.newer) && is_of(newer, closure.older)) ||
              (is_of(older, closure.older) && is_of(newer, closure.newer)));
    });
  }

  // What an older node is matched against: drives go opposite ways, and a scanner looks ahead. By
  // the motion path, which stays the same while poses move: the matcher keeps what it made of it.
  ScanPoints::ConstPtr SurroundingsOf(NodeId node) const {
    const LookupTableOptions& table = closures_.matcher.table;
    const SurroundingsOptions surroundings{closures_.submaps.half_length_m, kScanEvery,
                                           LaidOutBy::kMotion};
    return AsScanPoints(ThinPoints(*PointsAround(map_, node, surroundings, table.max_range_m),
                                   table.resolution_m, table.max_range_m));
  }

  // Moves the newer piece into the older one's frame, and its floors that were met again onto the
  // older ones.
  void Lay(const PiecePlacement& placement, const std::vector<std::size_t>& older,
           const std::vector<std::size_t>& newer) {
    Move(newer, placement.T_older_newer);
    std::vector<Floor> old_floors = map_.graph.floors();
    double shift = 0.0;
    for (const auto& [from, to] : placement.older_floor_of) {
      shift += (old_floors[static_cast<std::size_t>(to)].elevation -
                old_floors[static_cast<std::size_t>(from)].elevation) /
               static_cast<double>(placement.older_floor_of.size());
    }
    for (const FloorId floor : FloorsOf(newer)) {
      old_floors[static_cast<std::size_t>(floor)].elevation += shift;
    }
    const std::map<FloorId, FloorId> older_floor_of =
        WithFloorsCalledAlike(placement.older_floor_of, older, newer);
    std::vector<Floor> floors;
    std::vector<FloorId> becomes(old_floors.size());
    for (std::size_t i = 0; i < old_floors.size(); ++i) {
      if (older_floor_of.count(static_cast<FloorId>(i)) != 0) continue;
      becomes[i] = static_cast<FloorId>(floors.size());
      floors.push_back(old_floors[i]);
    }
    for (const auto& [from, to] : older_floor_of) {
      const Floor& met = old_floors[static_cast<std::size_t>(from)];
      becomes[static_cast<std::size_t>(from)] = becomes[static_cast<std::size_t>(to)];
      Floor& known = floors[static_cast<std::size_t>(becomes[static_cast<std::size_t>(to)])];
      if (met.label_given && !known.label_given) {
        known.label = met.label;
        known.label_given = true;
      }
    }
    Refloor(becomes, std::move(floors));
  }

  // Floors that were seen too little to be met again are one by the labels that were given to both.
  std::map<FloorId, FloorId> WithFloorsCalledAlike(std::map<FloorId, FloorId> older_floor_of,
                                                   const std::vector<std::size_t>& older,
                                                   const std::vector<std::size_t>& newer) const {
    const std::vector<Floor>& floors = map_.graph.floors();
    for (const FloorId from : FloorsOf(newer)) {
      const Floor& one = floors[static_cast<std::size_t>(from)];
      if (!one.label_given || older_floor_of.count(from) != 0) continue;
      for (const FloorId to : FloorsOf(older)) {
        const Floor& other = floors[static_cast<std::size_t>(to)];
        if (other.label_given && other.label == one.label) older_floor_of.emplace(from, to);
      }
    }
    return older_floor_of;
  }

  std::vector<FloorId> FloorsOf(const std::vector<std::size_t>& drives) const {
    std::vector<FloorId> floors;
    for (const std::size_t drive : drives) {
      const IndexRange nodes = NodesOfDrive(map_, drive);
      for (std::size_t i = nodes.begin; i < nodes.end; ++i) {
        floors.push_back(map_.graph.nodes()[i].floor);
      }
      const IndexRange poses = PosesOfDrive(map_, drive);
      for (std::size_t i = poses.begin; i < poses.end; ++i) {
        floors.push_back(map_.trajectory[i].floor);
      }
    }
    std::sort(floors.begin(), floors.end());
    floors.erase(std::unique(floors.begin(), floors.end()), floors.end());
    return floors;
  }

  // `becomes` is the new place of each floor.
  void Refloor(const std::vector<FloorId>& becomes, std::vector<Floor> floors) {
    std::vector<FloorId> floor_of_node;
    for (const Node& node : map_.graph.nodes()) {
      floor_of_node.push_back(becomes[static_cast<std::size_t>(node.floor)]);
    }
    map_.graph.Refloor(std::move(floors), floor_of_node);
    for (TrajectoryPose& pose : map_.trajectory) {
      pose.floor = becomes[static_cast<std::size_t>(pose.floor)];
    }
  }

  // The motion path moves along: a drive's lies in the frame of the map before optimisation.
  void Move(const std::vector<std::size_t>& drives, const Pose2& T_to_from) {
    for (const std::size_t drive : drives) {
      const IndexRange nodes = NodesOfDrive(map_, drive);
      for (std::size_t i = nodes.begin; i < nodes.end; ++i) {
        map_.graph.MoveNode(static_cast<NodeId>(i), T_to_from);
      }
      const IndexRange poses = PosesOfDrive(map_, drive);
      for (std::size_t i = poses.begin; i < poses.end; ++i) {
        TrajectoryPose& pose = map_.trajectory[i];
        pose.T_world_robot = T_to_from * pose.T_world_robot;
        pose.T_odom_robot = T_to_from * pose.T_odom_robot;
      }
    }
  }

  // The nearest nodes of the older drives on the floor, where the places put the new one.
  std::vector<Candidate> CandidatesOf(std::size_t new_node,
                                      const std::vector<std::size_t>& older) const {
    const Node& from = map_.graph.nodes()[new_node];
    const double sigma_rad = DegToRad(joins_.sigma_deg);
    std::vector<Candidate> candidates;
    for (const std::size_t drive : older) {
      const IndexRange nodes = NodesOfDrive(map_, drive);
      for (std::size_t i = nodes.begin; i < nodes.end; ++i) {
        const Node& to = map_.graph.nodes()[i];
        if (!to.HasScan() || to.floor != from.floor) continue;
        if (Distance(from.T_world_robot, to.T_world_robot) > joins_.reach_m) continue;
        Candidate candidate;
        candidate.node = static_cast<NodeId>(i);
        candidate.T_new_node.mean = Between(from.T_world_robot, to.T_world_robot);
        candidate.T_new_node.covariance.diagonal() << joins_.sigma_m * joins_.sigma_m,
            joins_.sigma_m * joins_.sigma_m, sigma_rad * sigma_rad;
        candidate.mahalanobis =
            MahalanobisDistance(candidate.T_new_node.mean.Translation(),
                                candidate.T_new_node.covariance.topLeftCorner<2, 2>(),
                                closures_.candidates.match_range_m);
        candidates.push_back(std::move(candidate));
      }
    }
    std::stable_sort(
        candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
          return a.T_new_node.mean.Translation().norm() < b.T_new_node.mean.Translation().norm();
        });
    const auto most = static_cast<std::size_t>(std::max(0, closures_.candidates.max_matches));
    if (candidates.size() > most) candidates.resize(most);
    return candidates;
  }

  // Each piece names its floors as a map of its own would; those of a piece that stays apart say of
  // which drive they are.
  void NameFloors() {
    std::vector<Floor> floors = map_.graph.floors();
    std::vector<FloorId> same(floors.size());
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = static_cast<FloorId>(i);
    std::set<std::string> taken;
    for (std::size_t piece = 0; piece < CountPieces(); ++piece) {
      const std::vector<std::size_t> drives = DrivesOf(piece);
      const std::string suffix = SuffixOf(piece, drives);
      std::vector<FloorId> own = FloorsOf(drives);
      // The floor that the piece began on is its floor 0.
      const FloorId first = map_.graph.nodes()[NodesOfDrive(map_, drives.front()).begin].floor;
      std::stable_partition(own.begin(), own.end(), [&](FloorId id) { return id == first; });
      std::vector<FloorLevel> levels;
      for (const FloorId id : own) {
        const Floor& floor = floors[static_cast<std::size_t>(id)];
        FloorLevel level;
        level.elevation = floor.elevation;
        if (floor.label_given) level.label = WithoutSuffix(floor.label, suffix);
        levels.push_back(level);
      }
      const std::vector<std::string> names = FloorNames(levels);
      for (std::size_t i = 0; i < own.size(); ++i) {
        std::string& label = floors[static_cast<std::size_t>(own[i])].label;
        label = names[i] + suffix;
        // A log may call its floors as a piece of its own would be called.
        while (!taken.insert(label).second) label += '_';
      }
    }
    Refloor(same, std::move(floors));
  }

  static std::string WithoutSuffix(const std::string& label, const std::string& suffix) {
    const bool has = label.size() > suffix.size() &&
                     label.compare(label.size() - suffix.size(), suffix.size(), suffix) == 0;
    return has && !suffix.empty() ? label.substr(0, label.size() - suffix.size()) : label;
  }

  struct Box {
    double left = std::numeric_limits<double>::infinity();
    double right = -std::numeric_limits<double>::infinity();
    double bottom = std::numeric_limits<double>::infinity();
  };

  Box BoxOf(const std::vector<std::size_t>& drives) const {
    Box box;
    const auto take = [&](const Eigen::Vector2d& point) {
      box.left = std::min(box.left, point.x());
      box.right = std::max(box.right, point.x());
      box.bottom = std::min(box.bottom, point.y());
    };
    for (const std::size_t drive : drives) {
      const IndexRange poses = PosesOfDrive(map_, drive);
      for (std::size_t i = poses.begin; i < poses.end; ++i) {
        take(map_.trajectory[i].T_world_robot.Translation());
      }
    }
    for (const KeptScan& kept : map_.kept_scans) {
      const std::size_t drive = DriveOfPose(map_, kept.trajectory_index);
      if (std::count(drives.begin(), drives.end(), drive) == 0) continue;
      const PointTransform to_world(map_.trajectory[kept.trajectory_index].T_world_robot);
      const ScanPoints::ConstPtr points = PointsInRobot(kept.scan);
      for (const pcl::PointXY& point : *points) {
        const Eigen::Vector2d in_robot(point.x, point.y);
        if (in_robot.norm() <= joins_.seen.max_usable_range_m) take(to_world * in_robot);
      }
    }
    return box;
  }

  void PlaceBeside() {
    BendTrajectory(map_.graph, map_.trajectory);
    Box all = BoxOf(DrivesOf(0));
    for (std::size_t piece = 1; piece < CountPieces(); ++piece) {
      const std::vector<std::size_t> drives = DrivesOf(piece);
      const Box box = BoxOf(drives);
      Pose2 T_beside_piece;
      T_beside_piece.x = std::ceil(all.right + kGapBetweenPieces - box.left);
      T_beside_piece.y = std::ceil(all.bottom - box.bottom);
      Move(drives, T_beside_piece);
      all.right = box.right + T_beside_piece.x;
    }
  }

  DriveJoinOptions joins_;
  LoopClosureOptions closures_;
  BuildingMap map_;
  std::vector<std::string> said_;
  std::set<std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> tried_;
};

}  // namespace

BuildingMap JoinDrives(std::vector<BuildingMap> maps, const DriveJoinOptions& options,
                       const LoopClosureOptions& closures, ProgressSink& progress) {
  if (maps.size() == 1) return std::move(maps.front());
  double seconds = 0.0;
  std::optional<StageTimer> timer(std::in_place, seconds);
  progress.Stage("joining");
  DriveJoiner joiner(std::move(maps.front()), options, closures);
  for (std::size_t i = 1; i < maps.size(); ++i) joiner.Append(std::move(maps[i]));
  joiner.Join(progress);
  for (const std::string& warning : joiner.said()) progress.Warn(warning);
  BuildingMap joined = joiner.Take();
  const std::vector<std::string> warnings = WarningsOf(joined);
  for (std::size_t i = joined.warnings.size(); i < warnings.size(); ++i) progress.Warn(warnings[i]);
  timer.reset();
  joined.seconds.total += seconds;
  return joined;
}

}  // namespace masked_mapper
