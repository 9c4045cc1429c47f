// SPDX-License-Identifier: BSD-3-Clause
// Many-to-many multi-resolution correlative scan matching (M3RSM; Olson 2015, Section III-D of the
// masked mapper). All pairs of a call share one best-first queue keyed by an upper bound of their
// objective; the first full-resolution entry of a pair to reach the top is the exact optimum of
// that pair over its search grid, and a pair that cannot reach the minimum score is never refined.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// A second place in the window where the query fits. On a ridge, as in a corridor, it is explained
/// by the match's covariance; one that is not makes the match ambiguous.
struct Elsewhere {
  Pose2 T_reference_query;  ///< to the cell
  double score = 0.0;       ///< 0-1, may exceed that of the match, which has the better prior
};

/// One pair offered to the matcher. Scans are named by a caller's key so that tables can be cached.
struct MatchPair {
  std::int64_t reference_key = 0;
  ScanPoints::ConstPtr points_in_reference;  ///< not asked for where the matcher Has() the key
  ScanPoints::ConstPtr points_in_query;
  UncertainPose2 T_reference_query_guess;  ///< centre of the window, and prior
};

enum class MatchOutcome { kMatched, kBelowMinScore };

struct MatchResult {
  MatchOutcome outcome = MatchOutcome::kBelowMinScore;
  /// Matched: the optimum refined below the cell, with the covariance of the response surface.
  /// Otherwise the guess.
  UncertainPose2 T_reference_query;
  /// 0-1, of the best pose of the search grid; for an abandoned pair a bound that no pose of the
  /// window exceeds, below min_score.
  double score = 0.0;
  std::optional<Elsewhere> elsewhere;  ///< when asked for and there is one
};

class JointMatcher {
 public:
  explicit JointMatcher(const MatcherOptions& options);
  ~JointMatcher();

  /// Matches all pairs; results in the order of the pairs, the same at any number of threads.
  std::vector<MatchResult> Match(const std::vector<MatchPair>& pairs);

  /// Whether the table of a reference is at hand, until the next call of Match().
  bool Has(std::int64_t reference_key) const;

  /// Gives back the memory of tables, which are made again where they are asked for.
  void Forget();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
