// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/loop_closure/closure_matcher.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <future>
#include <optional>

#include "submaps.hpp"

namespace masked_mapper {

ClosureMatcher::ClosureMatcher(const MatcherOptions& matcher, const SubmapOptions& submaps,
                               const AmbiguityOptions& ambiguity, bool refine,
                               const BuildingMap& map)
    : ambiguity_(ambiguity),
      refine_(refine),
      threads_(matcher.threads),
      matcher_(matcher),
      submaps_(std::make_unique<Submaps>(submaps, map)) {}
ClosureMatcher::~ClosureMatcher() = default;

std::vector<Closure> ClosureMatcher::Match(const std::vector<ClosureOffer>& offers, GuessIs guess) {
  std::vector<MatchPair> pairs;
  for (const ClosureOffer& offer : offers) {
    pairs.push_back(
        {offer.older, offer.points_in_older, offer.points_in_newer, offer.T_older_newer});
  }
  // What is near by the map mostly matches: the submap that refines it is built meanwhile.
  std::future<void> submap;
  if (refine_ && threads_ > 1 && guess != GuessIs::kAWindow && offers.size() == 1) {
    submap = std::async(std::launch::async, [&] { submaps_->Prepare(offers.front().older); });
  }
  // 1. Coarse.
  const std::vector<MatchResult> matches = matcher_.Match(pairs);
  if (submap.valid()) submap.get();
  std::vector<Closure> closures;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    const ClosureOffer& offer = offers[i];
    Closure closure;
    closure.older = offer.older;
    closure.newer = offer.newer;
    closure.mahalanobis = offer.mahalanobis;
    closure.score = matches[i].score;
    const bool by_match = guess != GuessIs::kAsGoodAsAMatch || !refine_;
    closure.T_older_newer = by_match ? matches[i].T_reference_query : offer.T_older_newer;
    // 2. Threshold.
    if (matches[i].outcome == MatchOutcome::kMatched) {
      RefineAndBelieve(*offer.points_in_newer, closure);
      if (guess != GuessIs::kAWindow && closure.reason == ClosureReason::kAlikeAlongALine) {
        // The way says how far along; it is not counted again in the closure.
        Believe(
            (closure.T_older_newer.covariance.inverse() + offer.T_older_newer.covariance.inverse())
                .inverse(),
            closure);
      }
    }
    closures.push_back(std::move(closure));
  }
  return closures;
}

ScanPoints::ConstPtr ClosureMatcher::PointsAround(NodeId node) const {
  return submaps_->PointsAround(node);
}

void ClosureMatcher::Forget() {
  matcher_.Forget();
  submaps_->Forget();
}

void ClosureMatcher::RefineAndBelieve(const ScanPoints& points_in_newer, Closure& closure) {
  closure.state = ClosureState::kHypothesis;
  // 3. Refine.
  if (refine_) {
    const std::optional<SubmapMatch> refined =
        submaps_->Refine(closure.older, points_in_newer, closure.T_older_newer);
    if (!refined) {
      closure.reason = ClosureReason::kDoesNotFit;
      return;
    }
    closure.T_older_newer = refined->T_node_robot;
    closure.agreement = refined->inlier_share;
  }
  // 4. Believe.
  Believe(closure.T_older_newer.covariance, closure);
}

// Whether a match leaves its least certain direction open.
void ClosureMatcher::Believe(const Eigen::Matrix3d& covariance, Closure& closure) const {
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                             covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .maxCoeff();
  const bool is_open = std::sqrt(largest) > ambiguity_.max_sigma_m ||
                       std::sqrt(covariance(2, 2)) > DegToRad(ambiguity_.max_sigma_deg);
  closure.reason = is_open ? ClosureReason::kAlikeAlongALine : ClosureReason::kTooFewVotes;
}

}  // namespace masked_mapper
