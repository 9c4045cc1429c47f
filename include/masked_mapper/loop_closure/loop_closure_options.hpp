// SPDX-License-Identifier: BSD-3-Clause
// What may be set of how loops are closed, from the candidates to the last audit.
#pragma once

#include <array>
#include <cstddef>

#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "masked_mapper/scan_matching/local_map.hpp"
#include "masked_mapper/scan_matching/matcher_options.hpp"

namespace masked_mapper {

struct CandidateOptions {
  double max_mahalanobis = 5.0;  ///< MaxMaha of the paper
  int max_matches = 5;           ///< MaxMatches of the paper
  double match_range_m = 2.0;    ///< R of Eq. 7
};

struct SubmapOptions {
  double half_length_m = 3.0;      ///< travel before and after the node
  double min_inlier_share = 0.65;  ///< of a scan that fits
  double max_correction_m = 0.4;   ///< a refinement that moves farther is not one
  double max_correction_deg = 4.0;
  double sigma_floor_m = 0.01;  ///< the motion path within a submap is not perfect
  double sigma_floor_deg = 0.05;
  double prior_weight = 0.05;  ///< say of the coarse match, beside the points'
  std::size_t cached = 48;     ///< submaps kept
  LocalMapOptions map;
};

/// When a match is not sure enough to be a closure. A blank corridor matches itself anywhere along
/// it, and loops of such matches agree with each other. Ours: the paper leaves it to MinScore.
struct AmbiguityOptions {
  double max_sigma_m = 0.2;  ///< in the least certain direction
  double max_sigma_deg = 3.0;
};

enum class ValidatorRule {
  kEvidence,  ///< what speaks for a match, against what chance would give
  kPaper,     ///< votes, as in the paper
};
constexpr std::array<const char*, 2> NamesOf(ValidatorRule /*any*/) {
  return {"evidence", "paper"};
}

struct ValidatorOptions {
  ValidatorRule rule = ValidatorRule::kEvidence;
  // Of the paper's rule.
  int votes_needed = 6;         ///< paper: 6
  double max_loop_error = 2.0;  ///< sigmas from the identity below which a loop agrees; paper: 2
  int max_loops = 40;           ///< loops looked at for one hypothesis; ours
  int hopeless_loops = 12;      ///< after so many without one that agrees it is left; ours
};

struct OpenRevisitOptions {
  double distance_m = 3.0;  ///< between two nodes at one place
  double walk_m = 6.0;      ///< along edges, up to which two nodes count as joined already
};

/// Which pairs enter once the whole map is known, matched again from their optimised poses.
struct PolishOptions {
  double most_m = 0.2;  ///< that the match may be away from the map, before and after
  double most_deg = 2.0;
  OpenRevisitOptions revisits;  ///< which pairs are offered late, as no mask offered them
};

struct LoopClosureOptions {
  CandidateOptions candidates;
  MatcherOptions matcher;
  /// Whether scans laid out the motion; if not, wheels alone did, and the map is sure only about
  /// what is closed.
  bool laid_out_by_scans = true;
  /// Whether matches are refined against submaps, which the motion lays out well enough for that.
  bool refine = true;
  SubmapOptions submaps;
  AmbiguityOptions ambiguity;
  ValidatorOptions validator;
  UpdateOptions optimizer;
  PolishOptions polish;
  AuditOptions audit;
};

}  // namespace masked_mapper
