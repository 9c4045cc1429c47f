// SPDX-License-Identifier: BSD-3-Clause
// How a pair of nodes becomes a closure that may be judged, in four stages:
//   1. coarse   joint scan matching over the window of the guess (Section III-D)
//   2. threshold   MinScore
//   3. refine   against what was seen around the older node, below the size of a cell (ours)
//   4. believe   only what leaves no direction open (ours)
#pragma once

#include <memory>
#include <vector>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/closure.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// A pair to be matched.
struct ClosureOffer {
  NodeId older = 0;
  NodeId newer = 0;
  UncertainPose2 T_older_newer;          ///< the guess
  double mahalanobis = 0.0;              ///< Eq. 7
  ScanPoints::ConstPtr points_in_older;  ///< not asked for where the matcher Has() the node
  ScanPoints::ConstPtr points_in_newer;
};

/// What the guess of an offer is worth.
enum class GuessIs {
  kAWindow,        ///< where to search; the match stands for itself
  kASureWindow,    ///< where to search; it may tell how far along a corridor
  kAsGoodAsAMatch  ///< from an optimised map: it is refined itself, and may tell along a corridor
};

class Submaps;

class ClosureMatcher {
 public:
  /// `map` outlives this. Without `refine`, stage 3 is left out.
  ClosureMatcher(const MatcherOptions& matcher, const SubmapOptions& submaps,
                 const AmbiguityOptions& ambiguity, bool refine, const BuildingMap& map);
  ~ClosureMatcher();

  /// One closure for each offer, in their order: kTooFewVotes where it passed all stages, else why
  /// it did not.
  std::vector<Closure> Match(const std::vector<ClosureOffer>& offers, GuessIs guess);

  /// Stages 3 and 4 alone, from `closure.T_older_newer`, which they change.
  void RefineAndBelieve(const ScanPoints& points_in_newer, Closure& closure);

  /// Whether the points of an older node were taken up already, until the next call.
  bool Has(NodeId older) const { return matcher_.Has(older); }

  /// What was seen around a node, in its frame.
  ScanPoints::ConstPtr PointsAround(NodeId node) const;

  /// Gives back the memory of tables and submaps; they are made again where they are asked for.
  void Forget();

  const Submaps& submaps() const { return *submaps_; }

 private:
  void Believe(const Eigen::Matrix3d& covariance, Closure& closure) const;

  AmbiguityOptions ambiguity_;
  bool refine_;
  int threads_;
  JointMatcher matcher_;
  std::unique_ptr<Submaps> submaps_;
};

}  // namespace masked_mapper
