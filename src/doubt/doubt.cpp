// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/doubt/doubt.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "place_index.hpp"
#include "visit_agreement.hpp"
#include "wall_crossings.hpp"

namespace masked_mapper {
namespace {

// Visits. On right maps, real and simulated, two visits of one place contradict each other in less
// than a fifth of their points at 99 of 100 places (people, doors, what was moved), and never over
// metres; where one hangs beside the other, in a third to all of them, over the whole stretch.
constexpr double kPlaceEvery = 1.0;      // m of travel from one place looked at to the next
constexpr double kOtherVisit = 15.0;     // m of travel after which a robot is there again
constexpr double kSamePlace = 6.0;       // m between two visits
constexpr double kAround = 3.0;          // m of travel of the older visit that is asked
constexpr double kRange = 8.0;           // m
constexpr double kSameWall = 0.25;       // m
constexpr int kLeastTold = 20;           // points that the older visit tells of
constexpr double kContradiction = 0.25;  // share of them
constexpr double kLongestGap = 5.0;      // m of travel between two places of one stretch
constexpr double kLeastStretch = 4.0;    // m of travel over which they contradict each other

// Edges: chi^2 (3 degrees of freedom) beyond what one in ten thousand right ones shows, after the
// tolerance within which a closure is imprecise and not wrong.
constexpr double kMostChi2 = 25.0;
constexpr double kToleranceM = 0.15;
constexpr double kToleranceDeg = 1.5;

/// A place that contradicts an older visit.
struct Contradicted {
  const Visit* newer = nullptr;
  const Visit* older = nullptr;
  double share = 0.0;
};

class VisitCheck {
 public:
  explicit VisitCheck(const BuildingMap& map) : map_(map), visits_(VisitsOf(map)) {
    for (std::size_t i = 0; i < visits_.size(); ++i) {
      index_.Add(visits_[i].floor, visits_[i].T_world_robot.Translation(), kSamePlace, i);
    }
  }

  std::vector<Doubt> Find() const {
    std::vector<Doubt> doubts;
    std::vector<Contradicted> run;
    double looked_at = -kPlaceEvery;
    const auto end_run = [&] {
      if (!run.empty() &&
          run.back().newer->travelled_m - run.front().newer->travelled_m >= kLeastStretch) {
        doubts.push_back(DoubtOf(run));
      }
      run.clear();
    };
    for (std::size_t i = 0; i < visits_.size(); ++i) {
      if (visits_[i].travelled_m - looked_at < kPlaceEvery) continue;
      looked_at = visits_[i].travelled_m;
      const std::optional<std::size_t> older = OlderVisitOf(i);
      if (!older) continue;
      const Agreement agreement =
          AgreementOf(map_, visits_[i], PassAround(*older), kRange, kSameWall);
      if (agreement.met + agreement.through < kLeastTold) continue;
      if (agreement.Contradiction() <= kContradiction) {
        end_run();
        continue;
      }
      if (!run.empty() && (run.back().newer->floor != visits_[i].floor ||
                           visits_[i].travelled_m - run.back().newer->travelled_m > kLongestGap)) {
        end_run();
      }
      run.push_back({&visits_[i], &visits_[*older], agreement.Contradiction()});
    }
    end_run();
    return doubts;
  }

 private:
  // Nearest of those that were there on another occasion; ties: the older.
  std::optional<std::size_t> OlderVisitOf(std::size_t newer) const {
    std::optional<std::size_t> nearest;
    double least = kSamePlace;
    const Visit& visit = visits_[newer];
    for (const std::size_t i : index_.Near(visit.floor, visit.T_world_robot.Translation())) {
      if (i >= newer || visit.travelled_m - visits_[i].travelled_m < kOtherVisit) break;
      const double distance = Distance(visits_[i].T_world_robot, visit.T_world_robot);
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return nearest;
  }

  std::vector<Visit> PassAround(std::size_t middle) const {
    std::vector<Visit> pass;
    const auto is_near = [&](std::size_t i) {
      return std::abs(visits_[i].travelled_m - visits_[middle].travelled_m) <= kAround &&
             visits_[i].floor == visits_[middle].floor && visits_[i].drive == visits_[middle].drive;
    };
    for (std::size_t i = middle; i < visits_.size() && is_near(i); ++i) pass.push_back(visits_[i]);
    for (std::size_t i = middle; i-- > 0 && is_near(i);) pass.push_back(visits_[i]);
    return pass;
  }

  double StampOf(const Visit& visit) const { return map_.kept_scans[visit.kept].scan.stamp; }

  Doubt DoubtOf(const std::vector<Contradicted>& run) const {
    const Contradicted worst = *std::max_element(
        run.begin(), run.end(),
        [](const auto& one, const auto& other) { return one.share < other.share; });
    Doubt doubt;
    doubt.kind = DoubtKind::kWalls;
    doubt.floor = worst.newer->floor;
    doubt.x = worst.newer->T_world_robot.x;
    doubt.y = worst.newer->T_world_robot.y;
    doubt.t_a = StampOf(*run.front().newer);
    doubt.t_b = StampOf(*run.back().newer);
    doubt.size_m = run.back().newer->travelled_m - run.front().newer->travelled_m;
    doubt.text = "two visits do not see the same walls along " + FixedText(doubt.size_m, 0) +
                 " m: through " + FixedText(100.0 * worst.share, 0) + " % of what was seen at " +
                 FixedText(StampOf(*worst.newer), 2) + " s the scans of " +
                 FixedText(StampOf(*worst.older), 2) + " s pass";
    doubt.edit = "- add_closure: {from: " + ExactText(StampOf(*worst.newer)) +
                 ", to: " + ExactText(StampOf(*worst.older)) + "}";
    return doubt;
  }

  const BuildingMap& map_;
  std::vector<Visit> visits_;
  PlaceIndex index_{kSamePlace};
};

std::vector<Doubt> DoubtsOfWays(const BuildingMap& map) {
  std::vector<Doubt> doubts;
  const std::vector<Visit> visits = VisitsOf(map);
  for (const WallCrossing& crossing : FindWallCrossings(map, visits)) {
    const Visit& driven = visits[crossing.driven];
    const double stamp = map.kept_scans[driven.kept].scan.stamp;
    const double seen = map.kept_scans[visits[crossing.seen.front()].kept].scan.stamp;
    Doubt doubt;
    doubt.kind = DoubtKind::kWalls;
    doubt.floor = driven.floor;
    doubt.x = driven.T_world_robot.x;
    doubt.y = driven.T_world_robot.y;
    doubt.t_a = std::min(stamp, seen);
    doubt.t_b = std::max(stamp, seen);
    doubt.text = "the way at " + FixedText(stamp, 2) + " s leads through a wall that was seen at " +
                 FixedText(seen, 2) +
                 " s: a door, or one of both was on another floor or lies wrong";
    doubts.push_back(doubt);
  }
  return doubts;
}

/// What a solved edge is off its measurement by.
std::optional<Doubt> DoubtOf(const BuildingMap& map, Edge edge) {
  const bool is_closure = edge.kind == EdgeKind::kClosure;
  if (is_closure) {
    const double radians = DegToRad(kToleranceDeg);
    edge.T_from_to.covariance.diagonal() +=
        Eigen::Vector3d(kToleranceM * kToleranceM, kToleranceM * kToleranceM, radians * radians);
  }
  if (EdgeChi2(map.graph, edge) <= kMostChi2) return std::nullopt;
  const Node& from = map.graph.node(edge.from);
  const Node& to = map.graph.node(edge.to);
  const Pose2 left = Between(edge.T_from_to.mean, Between(from.T_world_robot, to.T_world_robot));
  Doubt doubt;
  doubt.kind = is_closure ? DoubtKind::kClosure : DoubtKind::kMotion;
  doubt.floor = to.floor;
  doubt.x = to.T_world_robot.x;
  doubt.y = to.T_world_robot.y;
  doubt.t_a = std::min(from.stamp, to.stamp);
  doubt.t_b = std::max(from.stamp, to.stamp);
  doubt.size_m = left.Translation().norm();
  const bool by_hand =
      edge.closure >= 0 &&
      map.closures[static_cast<std::size_t>(edge.closure)].reason == ClosureReason::kAddedByHand;
  if (is_closure) {
    doubt.edit =
        "- forbid_closure: {from: " + ExactText(to.stamp) + ", to: " + ExactText(from.stamp) + "}";
  }
  const std::string what = by_hand      ? "the closure added by hand"
                           : is_closure ? "the closure"
                                        : "the way driven";
  doubt.text = what + " between " + FixedText(doubt.t_a, 2) + " and " + FixedText(doubt.t_b, 2) +
               " s contradicts the rest of the map by " + FixedText(doubt.size_m, 2) + " m and " +
               FixedText(RadToDeg(std::abs(left.theta)), 1) + " deg";
  return doubt;
}

std::vector<Doubt> DoubtsOfPieces(const BuildingMap& map) {
  std::vector<Doubt> doubts;
  const std::vector<std::size_t> pieces = PiecesOfDrives(map);
  std::size_t told = 0;
  for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
    if (pieces[drive] <= told) continue;
    told = pieces[drive];
    const IndexRange poses = PosesOfDrive(map, drive);
    if (poses.begin == poses.end) continue;
    const TrajectoryPose& first = map.trajectory[poses.begin];
    Doubt doubt;
    doubt.kind = DoubtKind::kApart;
    doubt.floor = first.floor;
    doubt.x = first.T_world_robot.x;
    doubt.y = first.T_world_robot.y;
    doubt.t_a = first.stamp;
    doubt.t_b = map.trajectory[poses.end - 1].stamp;
    doubt.text = map.drives[drive].log + " lies beside the others, not where it was driven";
    doubts.push_back(doubt);
  }
  return doubts;
}

/// Why a change of floor may lead elsewhere: what is said of it, or that it climbed what does not
/// lie between these floors, as edits have them.
std::string QuestionOf(const BuildingMap& map, const TransitRecord& transit, FloorId left,
                       FloorId reached) {
  constexpr double kHalfAStorey = 1.2;  // m
  constexpr double kMostSigmas = 4.0;
  if (!transit.open.empty()) return transit.open;
  const Floor& from = map.graph.floors()[static_cast<std::size_t>(left)];
  const Floor& to = map.graph.floors()[static_cast<std::size_t>(reached)];
  const double apart = to.elevation - from.elevation;
  const double off = std::abs(apart - transit.height_m);
  if (off <= std::max(kHalfAStorey, kMostSigmas * transit.sigma_m)) return "";
  return "it lies " + FixedText(apart, 1) + " m above the one left, and the way there climbed " +
         FixedText(transit.height_m, 1) + " m";
}

std::vector<Doubt> DoubtsOfFloors(const BuildingMap& map) {
  std::vector<Doubt> doubts;
  for (const TransitRecord& transit : map.transits) {
    const auto reached = std::find_if(
        map.trajectory.begin(), map.trajectory.end(),
        [&](const TrajectoryPose& pose) { return pose.stamp >= transit.t_in && !pose.in_transit; });
    if (reached == map.trajectory.end()) continue;
    const auto left = std::find_if(std::make_reverse_iterator(reached), map.trajectory.rend(),
                                   [](const TrajectoryPose& pose) { return !pose.in_transit; });
    if (left == map.trajectory.rend()) continue;
    const std::string question = QuestionOf(map, transit, left->floor, reached->floor);
    if (question.empty()) continue;
    Doubt doubt;
    doubt.kind = DoubtKind::kFloor;
    doubt.floor = reached->floor;
    doubt.x = reached->T_world_robot.x;
    doubt.y = reached->T_world_robot.y;
    doubt.t_a = transit.t_out;
    doubt.t_b = transit.t_in;
    doubt.text = "the floor that was reached at " + FixedText(transit.t_in, 2) +
                 " s may be another one: " + question;
    doubts.push_back(doubt);
  }
  return doubts;
}

}  // namespace

const char* Name(DoubtKind kind) {
  constexpr std::array<const char*, 5> kNames = {"walls", "closure", "motion", "apart", "floor"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::vector<Doubt> FindDoubts(const BuildingMap& map) {
  std::vector<Doubt> doubts = VisitCheck(map).Find();
  for (const Doubt& doubt : DoubtsOfWays(map)) doubts.push_back(doubt);
  for (const Edge& edge : map.graph.edges()) {
    if (edge.kind == EdgeKind::kHeading) continue;
    if (const std::optional<Doubt> doubt = DoubtOf(map, edge)) doubts.push_back(*doubt);
  }
  for (const Doubt& doubt : DoubtsOfPieces(map)) doubts.push_back(doubt);
  for (const Doubt& doubt : DoubtsOfFloors(map)) doubts.push_back(doubt);
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& one, const Doubt& other) {
    return std::make_pair(one.kind, one.t_a) < std::make_pair(other.kind, other.t_a);
  });
  return doubts;
}

}  // namespace masked_mapper
