// SPDX-License-Identifier: BSD-3-Clause
// What may be set of the masks that come with the library.
#pragma once

namespace masked_mapper {

/// Of the space that a scan sees, as a polygon (Section III-D, 3).
struct IsovistOptions {
  double max_range_m = 10.0;  ///< m; beams end here at the latest (ours)
};

/// Of `eccentricity` (Section III-D, 3).
struct EccentricityMaskOptions {
  IsovistOptions isovist;
  /// Hysteresis (ours): a place is a corridor from `corridor_above` on, and until below
  /// `open_below`; 0-1.
  double open_below = 0.80;
  double corridor_above = 0.85;
  double max_drift = 1.2;  ///< Mahalanobis distance to the centroid beyond which a dead end is seen
  /// Drift is judged only when the scan spans this angle. A scanner that does not see behind stands
  /// at the edge of what it sees, so that its drift is about sqrt(3) in every corridor; to it a
  /// dead end shows as a loss of eccentricity (ours).
  double drift_min_span_deg = 330.0;
};

/// Of the directions that the robot could go (Section III-D, 4a-c).
struct OpeningOptions {
  double min_range_m = 5.0;    ///< m; runs are cut from ranges above it; paper: 5
  double max_depth_m = 5.0;    ///< m; how far along the centre line an end-point may be; paper: 5
  double min_width_m = 0.75;   ///< m; paper: 0.75
  double min_angle_deg = 9.0;  ///< deg, as seen from the laser; paper: 9
  double max_gap_deg = 2.0;    ///< deg of invalid beams that do not end a run (ours)
};

/// Of `openings` (Section III-D, 4).
struct OpeningsMaskOptions {
  OpeningOptions detection;

  // (d) Ours but for the idea: a direction is kept when it was seen in `min_share` of the views of
  // the horizon, with a standard deviation of at most `max_deviation_deg`. The horizon counts the
  // way and not the time, so that fast and slow robots have the same evidence; a robot at rest sees
  // nothing new.
  double view_step_m = 0.1;         ///< m between two views, or
  double view_step_deg = 5.0;       ///< deg turned between them
  double horizon_m = 0.5;           ///< m of path
  int min_views = 4;                ///< in the horizon, however far back, for fast robots
  int max_views = 12;               ///< in the horizon, for robots that turn on the spot
  double min_share = 0.7;           ///< 0-1
  double max_deviation_deg = 12.0;  ///< deg
  double max_jump_deg = 20.0;       ///< deg between sightings of one direction

  // (e)
  double min_turn_deg = 40.0;      ///< deg off the course; paper: 40
  double max_turn_deg = 90.0;      ///< deg off the course; paper: 90
  double course_distance_m = 0.5;  ///< m of path that the course is taken over (ours)

  // (f)
  double dead_end_turn_deg = 150.0;  ///< deg; paper: 150
  double dead_end_distance_m = 0.5;  ///< m from the last node before there is a direction (ours)
};

/// Of `sparse(part)` (ours).
struct SparseMaskOptions {
  double place_m = 3.0;       ///< m; views nearer than this, straight line, are of one place
  double pass_m = 15.0;       ///< m of path that are one pass; what was seen earlier is seen again
  double turn_deg = 120.0;    ///< deg between views of one direction; full circles: any
  double drift_share = 0.03;  ///< of odometry, m per m of path since the earlier view
};

struct MaskOptions {
  EccentricityMaskOptions eccentricity;
  OpeningsMaskOptions openings;
  SparseMaskOptions sparse;
};

}  // namespace masked_mapper
