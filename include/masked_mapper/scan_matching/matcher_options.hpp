// SPDX-License-Identifier: BSD-3-Clause
// What may be set of the matching of scans.
#pragma once

#include <cstddef>

namespace masked_mapper {

/// Of the look-up table of a reference.
struct LookupTableOptions {
  double resolution_m = 0.05;  ///< side of a cell, m
  double sigma_m = 0.1;        ///< blur, m; the paper leaves it open
  double max_range_m = 30.0;   ///< m; points farther from the frame's origin are left out
  double join_gap_m =
      0.3;         ///< m; consecutive points nearer than this are joined by a line; 0: never
  int levels = 5;  ///< of the pyramid, cells included; a small table has fewer
};

/// Of the refinement of a match below the cell.
struct RefineOptions {
  int max_iterations = 15;
  double max_shift_m = 0.3;   ///< m; the climb ends where it would leave this distance of its start
  double max_turn_deg = 5.0;  ///< deg, the same for the angle
  /// Likelihood of a pose = exp(sharpness * score): how much score counts as evidence. Ours.
  double sharpness = 30.0;
  double floor_sigma_m = 0.02;   ///< m; added to the covariance: what no response surface knows
  double floor_sigma_deg = 0.3;  ///< deg
  double reach_m = 3.0;          ///< m; how far from the maximum the response surface is looked at
};

struct MatcherOptions {
  LookupTableOptions table;
  RefineOptions refine;
  double min_score = 0.425;      ///< 0-1, the paper's MinScore
  double window_sigmas = 3.0;    ///< half-width of the search window, in sigmas of the guess
  double min_window_m = 0.3;     ///< half-width, m
  double max_window_m = 6.0;     ///< half-width, m
  double min_window_deg = 3.0;   ///< half-width, deg
  double max_window_deg = 45.0;  ///< half-width, deg
  double angle_step_deg = 0.5;   ///< deg between search angles
  double point_spacing_m = 0.1;  ///< the query scan is thinned to one point per cell of this size
  double prior_weight = 0.005;   ///< objective = score - prior_weight * chi^2 of the guess
  std::size_t table_memory_mib = 64;  ///< budget of cached look-up tables
  int threads = 1;
  /// Also look for the best pose more than elsewhere_m or elsewhere_deg away from the match (along
  /// any axis), of at least elsewhere_floor times its score. Costs about half a match more.
  bool look_elsewhere = false;
  double elsewhere_m = 0.5;      ///< m
  double elsewhere_deg = 5.0;    ///< deg
  double elsewhere_floor = 0.7;  ///< of the match's score
};

}  // namespace masked_mapper
