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
  kEvidence,  ///< votes, each for what it is worth, and what the best validated way says
  kPaper,     ///< votes alone, as in the paper
};
constexpr std::array<const char*, 2> NamesOf(ValidatorRule /*any*/) {
  return {"evidence", "paper"};
}

struct ValidatorOptions {
  ValidatorRule rule = ValidatorRule::kEvidence;
  int votes_needed = 6;  ///< paper: 6
  /// Mahalanobis distance from the identity below which a loop agrees; paper: 2
  double max_loop_error = 2.0;

  /// Trace (m^2 and rad^2, Eq. 2) beyond which a loop would agree with whatever the matcher finds
  /// and is no evidence. The search ends there, which also keeps its cost apart from the size of
  /// the map.
  double max_loop_trace = 2.0;
  /// Trace up to which a loop is so sure that agreeing with it nearly means being right: each is a
  /// vote. A looser loop votes once for every set of unvalidated closures on it, and
  /// `max_loose_votes` times at most.
  double tight_loop_trace = 0.25;
  int max_loose_votes = 2;
  /// Trace up to which agreeing with a loop of validated closures and odometry alone is all the
  /// votes that are needed: the match says what the map says already, and can hardly move it. A
  /// corner passed twice offers no six loops.
  double sure_loop_trace = 0.1;
  /// Places, farther apart than `place_radius_m`, whose closures have to agree before closures
  /// enter that no sure way to the rest of the map confirms; more the more they surprise
  /// (PlacesNeeded()).
  int places_needed = 3;
  double place_radius_m = 2.5;
  /// Mahalanobis distance of the best validated way beyond which a closure stays out.
  double max_contradiction = 8.0;

  int max_loops = 40;       ///< loops looked at for one hypothesis; ours
  int hopeless_loops = 12;  ///< after so many without one that agrees it is left; ours
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
