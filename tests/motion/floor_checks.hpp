// SPDX-License-Identifier: BSD-3-Clause
// How well a floor timeline fits the truth of a synthetic drive.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "motion/pressure_heights.hpp"
#include "motion/synthetic_drive.hpp"
#include "motion/wheel_track.hpp"

namespace masked_mapper {

inline WheelTrack TrackOf(const SyntheticDrive& drive) {
  WheelTrack track;
  for (const SyntheticDrive::State& state : drive.states()) {
    track.Observe({state.stamp, state.T_odom_robot});
  }
  return track;
}

/// By elevator to 1, 3, 0, 2, 1 and 0, with so long on each.
inline SyntheticDrive FourFloors(unsigned seed, double roam_s) {
  SyntheticDrive drive({0.0, 4.0, 7.5, 11.0}, 0, seed);
  drive.Roam(200.0);
  for (const std::size_t floor : {1U, 3U, 0U, 2U, 1U, 0U}) {
    drive.TakeElevator(floor);
    drive.Roam(roam_s);
  }
  return drive;
}

inline PressureHeights HeightsOf(const std::vector<PressureReading>& readings) {
  PressureTrack track;
  for (const PressureReading& reading : readings) track.Observe(reading);
  return track.Heights({});
}

struct FloorScore {
  double right_share = 0.0;  ///< of states outside transit, that stand on the floor they stood on
  double cab_share = 0.0;    ///< of states in transit, that the timeline has in transit
  double lost_share = 0.0;   ///< of states outside transit, that the timeline has in transit
  int transits_missed = 0;   ///< rides that the timeline is not in transit at the middle of
  double worst_elevation = 0.0;  ///< m off, over levels
  std::size_t levels = 0;
};

inline FloorScore ScoreFloors(const FloorTimeline& timeline, const SyntheticDrive& drive) {
  FloorScore score;
  score.levels = timeline.levels.size();
  // A level is the floor it is met on most.
  std::vector<std::map<std::size_t, int>> votes(timeline.levels.size());
  double outside = 0.0;
  double inside = 0.0;
  for (const SyntheticDrive::State& state : drive.states()) {
    const FloorInterval& interval = timeline.At(state.stamp);
    (state.in_transit ? inside : outside) += 1.0;
    if (state.in_transit) {
      score.cab_share += interval.in_transit;
    } else if (interval.in_transit) {
      score.lost_share += 1.0;
    } else {
      ++votes[interval.level][state.floor];
    }
  }
  std::map<std::size_t, std::size_t> level_of_floor;
  for (std::size_t level = 0; level < votes.size(); ++level) {
    int most = 0;
    std::size_t floor = 0;
    for (const auto& [candidate, count] : votes[level]) {
      if (count > most) floor = candidate;
      most = std::max(most, count);
    }
    // A floor that came out as two is right once.
    if (level_of_floor.emplace(floor, level).second) score.right_share += most;
    const double reference = drive.elevations()[drive.states().front().floor];
    score.worst_elevation = std::max(
        score.worst_elevation,
        std::abs(timeline.levels[level].elevation - (drive.elevations()[floor] - reference)));
  }
  score.right_share /= std::max(1.0, outside - score.lost_share);
  score.lost_share /= std::max(1.0, outside);
  score.cab_share /= std::max(1.0, inside);
  for (const SyntheticDrive::Ride& ride : drive.rides()) {
    score.transits_missed += !timeline.At(0.5 * (ride.start + ride.end)).in_transit;
  }
  return score;
}

}  // namespace masked_mapper
