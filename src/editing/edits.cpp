// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/editing/edits.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "annotation_edits.hpp"
#include "edit_line.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/yaml_tree.hpp"

namespace masked_mapper {
namespace {

constexpr double kStampTolerance = 0.5;  // s
/// Of a guess by hand: somebody who points at a map.
constexpr double kGuessSigmaM = 0.7;
constexpr double kGuessSigmaDeg = 7.0;

/// Ten digits of it, the same under every locale.
std::string Short(double value) {
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 10);
  return std::string(text.data(), end.ptr);
}

class Editor {
 public:
  Editor(const LoopClosureOptions& options, BuildingMap& map)
      : options_(options), map_(map), annotations_(map) {}

  void Apply(EditLine& edit) {
    const std::vector<std::pair<std::string, std::function<std::string(EditLine&)>>> edits = {
        {"add_closure", [this](EditLine& line) { return AddClosure(line); }},
        {"forbid_closure", [this](EditLine& line) { return ForbidClosure(line); }},
        {"name_floor", [this](EditLine& line) { return NameFloor(line); }},
        {"pin_elevation", [this](EditLine& line) { return PinElevation(line); }},
        {"same_floor", [this](EditLine& line) { return SameFloor(line); }},
        {"places", [this](EditLine& line) { return annotations_.NamePlaces(line, map_); }},
        {"keep_out",
         [this](EditLine& line) { return annotations_.Draw(AreaKind::kKeepOut, line, map_); }},
        {"erase",
         [this](EditLine& line) { return annotations_.Draw(AreaKind::kErased, line, map_); }},
        {"anchor", [this](EditLine& line) { return annotations_.Anchor(line, map_); }},
    };
    std::vector<std::string> names;
    for (const auto& [name, apply] : edits) {
      if (name == edit.what()) {
        map_.warnings.push_back("edited: " + apply(edit));
        return;
      }
      names.push_back(name);
    }
    edit.Fail("unknown edit `" + edit.what() + "`" + DidYouMean(edit.what(), names));
  }

  void Solve() {
    if (pulled_) {
      Optimize(options_.optimizer.solver, map_.graph);
      BendTrajectory(map_.graph, map_.trajectory);
      annotations_.Carry(map_);
    }
    annotations_.MoveToAnchors(map_);
  }

 private:
  /// A scan of the log and the node that it hangs on.
  struct Place {
    std::size_t scan = 0;
    NodeId node = 0;
    Pose2 T_node_robot;
  };

  const Node& NodeOf(NodeId id) const { return map_.graph.nodes()[static_cast<std::size_t>(id)]; }

  Place PlaceAt(std::size_t scan) const {
    const TrajectoryPose& pose = map_.trajectory[scan];
    return {scan, pose.node_before,
            Between(NodeOf(pose.node_before).T_odom_robot, pose.T_odom_robot)};
  }

  std::size_t ScanAt(double stamp, const EditLine& edit) const {
    std::optional<std::size_t> nearest;
    double smallest = kStampTolerance;
    for (std::size_t i = 0; i < map_.trajectory.size(); ++i) {
      const double off = std::abs(map_.trajectory[i].stamp - stamp);
      if (off > smallest || (nearest && off == smallest)) continue;
      smallest = off;
      nearest = i;
    }
    if (!nearest) edit.Fail("no scan within half a second of stamp " + Short(stamp));
    return *nearest;
  }

  FloorId FloorNamed(const std::string& label, const EditLine& edit) const {
    return FloorOfEdit(label, edit, map_);
  }

  static UncertainPose2 Uncertain(const std::vector<double>& pose, double sigma_m,
                                  double sigma_deg) {
    UncertainPose2 T;
    T.mean = {pose[0], pose[1], WrapAngle(DegToRad(pose[2]))};
    const double sigma_rad = DegToRad(sigma_deg);
    T.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
    return T;
  }

  std::string AddClosure(EditLine& edit) {
    const double from_stamp = edit.Number("from");
    const double to_stamp = edit.Number("to");
    std::size_t from = ScanAt(from_stamp, edit);
    std::size_t to = ScanAt(to_stamp, edit);
    Closure closure;
    closure.state = ClosureState::kValidated;
    closure.reason = ClosureReason::kAddedByHand;
    UncertainPose2 T_from_to;
    if (edit.Has("transform")) {
      const std::vector<double> sigma =
          edit.Has("sigma") ? edit.Numbers("sigma", 2) : std::vector<double>{0.05, 0.5};
      // Finer than a micrometre and coarser than a building nobody means.
      for (const double part : sigma) {
        if (!(part >= 1e-6 && part <= 1e4)) edit.Fail("sigma must be 0.000001 to 10000");
      }
      T_from_to = Uncertain(edit.Numbers("transform", 3), sigma[0], sigma[1]);
      edit.RequireAllTaken();
    } else {
      UncertainPose2 guess;
      if (edit.Has("guess")) {
        guess = Uncertain(edit.Numbers("guess", 3), kGuessSigmaM, kGuessSigmaDeg);
      } else {
        const Pose2 T =
            Between(map_.trajectory[from].T_world_robot, map_.trajectory[to].T_world_robot);
        guess = Uncertain({T.x, T.y, RadToDeg(T.theta)}, kGuessSigmaM, kGuessSigmaDeg);
      }
      edit.RequireAllTaken();
      const Match match = MatchScans(from, to, guess, edit);
      from = match.from;
      to = match.to;
      T_from_to = match.T_from_to;
      closure.score = match.score;
    }
    Join(PlaceAt(from), PlaceAt(to), T_from_to, closure, edit);
    return "a closure between stamps " + Short(from_stamp) + " and " + Short(to_stamp);
  }

  void Join(const Place& from, const Place& to, const UncertainPose2& T_from_to, Closure closure,
            const EditLine& edit) {
    if (NodeOf(from.node).floor != NodeOf(to.node).floor) {
      edit.Fail("the two stamps are on different floors");
    }
    if (from.node == to.node) edit.Fail("the two stamps are at one node of the graph");
    // From node to node, by way of the two scans; the little motion in between is taken as exact.
    closure.older = from.node;
    closure.newer = to.node;
    closure.T_older_newer = UncertainPose2{from.T_node_robot, Eigen::Matrix3d::Zero()} * T_from_to *
                            UncertainPose2{Inverse(to.T_node_robot), Eigen::Matrix3d::Zero()};
    if (closure.older > closure.newer) {
      std::swap(closure.older, closure.newer);
      closure.T_older_newer = Inverse(closure.T_older_newer);
    }
    NoteJoined(DriveOfNode(map_, closure.newer), DriveOfNode(map_, closure.older));
    map_.closures.push_back(std::move(closure));
    AddClosureEdge(map_.closures, static_cast<ClosureId>(map_.closures.size() - 1), map_.graph);
    pulled_ = true;
  }

  /// Before the closure between them: a drive that is a piece of its own is one no more.
  void NoteJoined(std::size_t one, std::size_t other) {
    const std::vector<std::size_t> pieces = PiecesOfDrives(map_);
    if (pieces[one] != pieces[other]) map_.drives[std::max(one, other)].reason = "joined by hand";
  }

  struct Match {
    std::size_t from = 0;  ///< the scans that were matched, the kept ones next to those asked for
    std::size_t to = 0;
    UncertainPose2 T_from_to;
    double score = 0.0;
  };

  /// The kept scan nearest to a scan of the log.
  const KeptScan& KeptNear(std::size_t scan, const EditLine& edit) const {
    const KeptScan* nearest = nullptr;
    for (const KeptScan& kept : map_.kept_scans) {
      const double off = std::abs(kept.scan.stamp - map_.trajectory[scan].stamp);
      if (nearest == nullptr || off < std::abs(nearest->scan.stamp - map_.trajectory[scan].stamp)) {
        nearest = &kept;
      }
    }
    if (nearest == nullptr) edit.Fail("the map has no scans to match");
    return *nearest;
  }

  Match MatchScans(std::size_t from, std::size_t to, const UncertainPose2& T_from_to_guess,
                   const EditLine& edit) const {
    const KeptScan& reference = KeptNear(from, edit);
    const KeptScan& query = KeptNear(to, edit);
    const auto offset = [&](std::size_t scan, const KeptScan& kept) {
      return Between(map_.trajectory[scan].T_odom_robot,
                     map_.trajectory[kept.trajectory_index].T_odom_robot);
    };
    UncertainPose2 guess = T_from_to_guess;
    guess.mean = Inverse(offset(from, reference)) * guess.mean * offset(to, query);
    MatcherOptions options = options_.matcher;
    options.threads = 1;
    const MatchResult result =
        JointMatcher(options)
            .Match({{0, PointsInRobot(reference.scan), PointsInRobot(query.scan), guess}})
            .front();
    if (result.outcome != MatchOutcome::kMatched) {
      edit.Fail("the scans at these stamps do not match near the guess (score below " +
                Short(options.min_score) + ")");
    }
    return {reference.trajectory_index, query.trajectory_index, result.T_reference_query,
            result.score};
  }

  std::string ForbidClosure(EditLine& edit) {
    const double from = edit.Number("from");
    const double to = edit.Number("to");
    edit.RequireAllTaken();
    // Stamps that were copied are met exactly; others by what is near.
    std::size_t removed = RemoveClosures(from, to, 1e-3);
    if (removed == 0) removed = RemoveClosures(from, to, kStampTolerance);
    if (removed == 0) {
      edit.Fail("no closure between stamps " + Short(from) + " and " + Short(to) +
                " (closures.csv lists them: t_a, t_b, state validated)");
    }
    pulled_ = true;
    return "no closure between stamps " + Short(from) + " and " + Short(to);
  }

  std::size_t RemoveClosures(double from, double to, double tolerance_s) {
    const auto is_near = [&](NodeId node, double stamp) {
      return std::abs(NodeOf(node).stamp - stamp) <= tolerance_s;
    };
    std::vector<EdgeId> removed;
    for (std::size_t i = 0; i < map_.graph.edges().size(); ++i) {
      const Edge& edge = map_.graph.edges()[i];
      if (edge.kind != EdgeKind::kClosure) continue;
      if (!(is_near(edge.from, from) && is_near(edge.to, to)) &&
          !(is_near(edge.from, to) && is_near(edge.to, from))) {
        continue;
      }
      removed.push_back(static_cast<EdgeId>(i));
      if (edge.closure < 0) continue;
      Closure& closure = map_.closures[static_cast<std::size_t>(edge.closure)];
      closure.state = ClosureState::kAuditedOut;
      closure.reason = ClosureReason::kForbiddenByHand;
    }
    map_.graph.RemoveEdges(removed);
    return removed.size();
  }

  std::string NameFloor(EditLine& edit) {
    const std::string label = edit.Word("floor");
    const std::string name = edit.Word("name");
    edit.RequireAllTaken();
    const FloorId floor = FloorNamed(label, edit);
    if (!IsName(name)) {
      edit.Fail("a floor's name is made of letters, digits, `_`, `.` and `-`");
    }
    for (std::size_t i = 0; i < map_.graph.floors().size(); ++i) {
      if (static_cast<FloorId>(i) != floor && map_.graph.floors()[i].label == name) {
        edit.Fail("another floor is called `" + name + "` already");
      }
    }
    Rebuild([&](FloorId id, Floor& changed) {
      if (id == floor) {
        changed.label = name;
        changed.label_given = true;
      }
      return id;
    });
    return "floor " + label + " is called " + name;
  }

  std::string PinElevation(EditLine& edit) {
    const std::string label = edit.Word("floor");
    const double elevation = edit.Number("elevation_m");
    edit.RequireAllTaken();
    map_.graph.SetElevation(FloorNamed(label, edit), elevation, 0.0, true);
    return "floor " + label + " is at " + Short(elevation) + " m";
  }

  std::string SameFloor(EditLine& edit) {
    const std::string label = edit.Word("floor");
    const std::string as = edit.Word("as");
    edit.RequireAllTaken();
    const FloorId gone = FloorNamed(label, edit);
    const FloorId stays = FloorNamed(as, edit);
    if (gone == stays) edit.Fail("these are one floor already");
    Rebuild([&](FloorId id, Floor&) { return id == gone ? stays : id; });
    return "floor " + label + " is the same as " + as;
  }

  /// The same graph with other floors: `change` may alter a floor, and says which it becomes;
  /// floors that became another are gone.
  void Rebuild(const std::function<FloorId(FloorId, Floor&)>& change) {
    std::vector<Floor> floors;
    std::vector<FloorId> becomes;
    std::vector<FloorId> new_id(map_.graph.floors().size(), -1);
    for (std::size_t i = 0; i < new_id.size(); ++i) {
      Floor floor = map_.graph.floors()[i];
      becomes.push_back(change(static_cast<FloorId>(i), floor));
      if (becomes.back() != static_cast<FloorId>(i)) continue;
      new_id[i] = static_cast<FloorId>(floors.size());
      floors.push_back(std::move(floor));
    }
    const auto renamed = [&](FloorId id) {
      return new_id[static_cast<std::size_t>(becomes[static_cast<std::size_t>(id)])];
    };
    std::vector<FloorId> floor_of_node;
    for (const Node& node : map_.graph.nodes()) floor_of_node.push_back(renamed(node.floor));
    map_.graph.Refloor(std::move(floors), floor_of_node);
    for (TrajectoryPose& pose : map_.trajectory) pose.floor = renamed(pose.floor);
    for (NamedPlace& place : map_.places) place.floor = renamed(place.floor);
    for (Area& area : map_.areas) area.floor = renamed(area.floor);
    annotations_.RenameFloors(renamed);
  }

  const LoopClosureOptions& options_;
  BuildingMap& map_;
  AnnotationEdits annotations_;
  bool pulled_ = false;  ///< edges came or went
};

}  // namespace

void ApplyEditsText(const std::string& name, const std::string& text,
                    const LoopClosureOptions& options, BuildingMap& map) {
  const YamlTree tree = ParseYaml(name, text);
  if (tree.kind == YamlTree::Kind::kEmpty) return;
  if (tree.kind != YamlTree::Kind::kList) {
    throw InputError(name + ":" + std::to_string(tree.line) +
                     ": expected a list of edits, each a line that starts with `- `");
  }
  BuildingMap changed = map;
  Editor editor(options, changed);
  for (const YamlTree& item : tree.list) {
    EditLine line(name, item);
    editor.Apply(line);
  }
  editor.Solve();
  map = std::move(changed);
}

void ApplyEdits(const std::string& path, const LoopClosureOptions& options, BuildingMap& map) {
  ApplyEditsText(path, ReadSmallFile(path, "list of edits"), options, map);
}

}  // namespace masked_mapper
