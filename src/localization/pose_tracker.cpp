// SPDX-License-Identifier: BSD-3-Clause
#include "pose_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "evidence.hpp"

namespace masked_mapper {
namespace {

constexpr double kReach = 6.0;         // m, to the nodes that a scan is matched with
constexpr std::size_t kMostNodes = 2;  // tried for one scan
constexpr double kSureM = 0.2;         // sigma up to which no window is searched
constexpr double kSureDeg = 1.5;
constexpr double kMapSigma = 0.02;  // m; neighbouring nodes of a map are that good
constexpr double kMapSigmaDeg = 0.15;
constexpr double kMostChi2 = 9.0;  // of three degrees of freedom

UncertainPose2 Exact(const Pose2& pose) { return {pose, Eigen::Matrix3d::Zero()}; }

bool IsSure(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance(0, 0) + covariance(1, 1)) < kSureM &&
         std::sqrt(covariance(2, 2)) < DegToRad(kSureDeg);
}

Eigen::Vector3d Off(const UncertainPose2& motion, const UncertainPose2& match) {
  return {match.mean.x - motion.mean.x, match.mean.y - motion.mean.y,
          WrapAngle(match.mean.theta - motion.mean.theta)};
}

bool GoTogether(const UncertainPose2& motion, const UncertainPose2& match) {
  const Eigen::Vector3d off = Off(motion, match);
  const Eigen::Matrix3d both = motion.covariance + match.covariance;
  return off.dot(both.inverse() * off) <= kMostChi2;
}

// Of two answers to one question that go together.
UncertainPose2 Weighed(const UncertainPose2& motion, const UncertainPose2& match) {
  const Eigen::Matrix3d gain = motion.covariance * (motion.covariance + match.covariance).inverse();
  const Eigen::Vector3d step = gain * Off(motion, match);
  UncertainPose2 weighed;
  weighed.mean = {motion.mean.x + step.x(), motion.mean.y + step.y(),
                  WrapAngle(motion.mean.theta + step.z())};
  weighed.covariance = (Eigen::Matrix3d::Identity() - gain) * motion.covariance;
  weighed.covariance = 0.5 * (weighed.covariance + weighed.covariance.transpose()).eval();
  return weighed;
}

}  // namespace

std::optional<UncertainPose2> PoseTracker::Match(const LaserScan& scan, FloorId floor,
                                                 const UncertainPose2& T_world_robot) {
  const ScanPoints::ConstPtr points_in_robot = PointsInRobot(scan);
  std::vector<NodeId> nodes = map_.NodesNear(floor, T_world_robot.mean.Translation(), kReach);
  nodes.resize(std::min(nodes.size(), kMostNodes));
  for (const NodeId node : nodes) {
    std::optional<UncertainPose2> match = MatchWith(node, points_in_robot, T_world_robot);
    if (!match) continue;
    if (GoTogether(T_world_robot, *match)) return Weighed(T_world_robot, *match);
    // Motion was surer than it should have been (wheels slip, and walls are said to be), or the
    // match is wrong: what the map has beyond the node tells.
    if (FitsBetter(scan, *map_.FloorAt(floor), match->mean, T_world_robot.mean)) return match;
  }
  return std::nullopt;
}

std::optional<UncertainPose2> PoseTracker::MatchWith(NodeId node,
                                                     const ScanPoints::ConstPtr& points_in_robot,
                                                     const UncertainPose2& T_world_robot) {
  const UncertainPose2 T_world_node = Exact(map_.map().graph.node(node).T_world_robot);
  ClosureOffer offer;
  offer.older = node;
  offer.newer = -1;  // no node of the map
  offer.T_older_newer = Inverse(T_world_node) * T_world_robot;
  offer.points_in_newer = points_in_robot;
  ++matches_;
  Closure closure;
  if (options_.refine && IsSure(T_world_robot.covariance)) {
    closure.older = node;
    closure.newer = offer.newer;
    closure.T_older_newer = offer.T_older_newer;
    matcher_.RefineAndBelieve(*points_in_robot, closure);
  } else {
    if (!matcher_.Has(node)) {
      offer.points_in_older = matcher_.PointsAround(node);
      if (offer.points_in_older->empty()) return std::nullopt;
    }
    closure = matcher_.Match({offer}, GuessIs::kAWindow).front();
  }
  const bool fits =
      closure.state == ClosureState::kHypothesis && closure.reason != ClosureReason::kDoesNotFit;
  if (!fits) return std::nullopt;
  UncertainPose2 match = T_world_node * closure.T_older_newer;
  const double sigma_rad = DegToRad(kMapSigmaDeg);
  match.covariance.diagonal() +=
      Eigen::Vector3d(kMapSigma * kMapSigma, kMapSigma * kMapSigma, sigma_rad * sigma_rad);
  return match;
}

}  // namespace masked_mapper
