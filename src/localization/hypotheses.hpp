// SPDX-License-Identifier: BSD-3-Clause
// The places where the robot may be, while it is not known which: found on whole floors, followed
// along its way and through rides, given up where the map contradicts them, until one is believed.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evidence.hpp"
#include "known_map.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "stretch.hpp"

namespace masked_mapper {

/// From this scan on a hypothesis had the motion path there.
struct PathAnchor {
  std::size_t scan = 0;
  FloorId floor = 0;
  Pose2 T_world_odom;
};

struct Hypothesis {
  FloorId floor = 0;
  Pose2 T_world_odom;
  double prior_nats = 0.0;  ///< before anything was seen, against all other places together
  Tally tally;
  WayOffTheMap off_the_map;
  std::vector<PatchFit> fits;       ///< of all patches, in order
  std::size_t first_patch = 0;      ///< the first by which it was judged
  std::vector<PathAnchor> anchors;  ///< in order of scans
  double found_m = 0.0;             ///< of the stretch
  /// Where the motion path lay when the first metres had put it right, and where it has had to be
  /// moved since to fit on: nearly not at all in the right place.
  struct Settled {
    Pose2 T_world_odom;
    double at_m = 0.0;  ///< of the stretch
  };
  std::optional<Settled> settled;
  double slip_nats = 0.0;  ///< how much likelier motion is to have slipped so than not; not above 0
};

class Hypotheses {
 public:
  Hypotheses(const KnownMap& map, const EvidenceOptions& options) : map_(map), options_(options) {
    options_.copy_nats = map.LogPlaces();
  }

  /// Nothing is known; what follows is seen from `scan` on.
  void Restart(std::size_t scan);
  /// The robot is about there, with so many nats against all other places together.
  void Suggest(FloorId floor, const Pose2& T_world_odom, double prior_nats);
  /// It may be about where it was held to be, straight above or below, or anywhere.
  void SuggestAround(FloorId floor, const Pose2& T_world_odom);
  /// Only on this floor, and where rides from it lead.
  void KeepFloor(FloorId floor);
  /// It rode: `climb_m` up, give or take `sigma_m`; nothing: nobody knows. Floors alone change.
  /// Where no floor is that far, it is between floors until it rides on: on a landing of stairs.
  void Ride(std::optional<double> climb_m, double sigma_m, std::size_t scan);
  bool IsBetweenFloors() const { return climbed_.has_value(); }

  /// Takes what was seen since the last call; looks on whole floors when that is due, and around
  /// where motion puts the robot since it was last sure of its place, if it ever was.
  void Step(Stretch& stretch, std::size_t scan, const std::optional<UncertainPose2>& T_world_robot);

  /// The one that is believed; null while there is none.
  const Hypothesis* Believed() const;
  /// All that are held to be possible, the likeliest first.
  const std::vector<Hypothesis>& all() const { return hypotheses_; }

  /// How many there are and where, for people.
  std::string Description() const;

  int searches() const { return searches_; }

 private:
  struct SeenPatch {
    Patch patch;
    double at_m = 0.0;  ///< of the stretch
  };
  double Nats(const Hypothesis& hypothesis) const {
    return hypothesis.prior_nats + hypothesis.off_the_map.nats() + hypothesis.slip_nats +
           NatsOfWay(hypothesis.tally, options_);
  }
  double NatsAgainstElsewhere() const;
  void Judge(Hypothesis& hypothesis, std::size_t first_patch) const;
  void NoteSlip(Hypothesis& hypothesis, const Stretch& stretch) const;
  void Follow(Hypothesis& hypothesis, const Stretch& stretch, std::size_t scan) const;
  using Whereabouts = std::vector<std::pair<FloorId, double>>;  ///< nats of each floor

  bool MayBeOn(FloorId floor) const;
  void RideOn(std::optional<double> climb_m, double sigma_m);
  void Search(const Stretch& stretch);
  void SearchAround(const Stretch& stretch, const UncertainPose2& T_world_robot);
  void Add(Hypothesis&& hypothesis);
  bool IsKnown(const Hypothesis& found, const Pose2& T_odom_robot, double same_m,
               double same_deg) const;
  double NatsOffTheMap(const Hypothesis& hypothesis, std::size_t first_patch) const;
  bool IsBehind(const Hypothesis& rival, const Hypothesis& best) const;
  void MergeAndOrder(const Pose2& T_odom_robot);
  void Prune();

  const KnownMap& map_;
  EvidenceOptions options_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<SeenPatch> patches_;
  std::size_t first_scan_ = 0;
  std::vector<FloorId> only_floors_;  ///< on which it may be, as was said; empty: all
  struct Climb {
    double m = 0.0;
    double sigma_m = 0.0;
  };
  std::optional<Climb> climbed_;  ///< since it left the floors of all hypotheses
  Whereabouts whereabouts_;       ///< floors on which it was suggested
  double next_search_m_ = 0.0;
  bool search_was_complete_ = false;
  double elsewhere_nats_ = 0.0;  ///< against what no ride came to; before anything was seen
  int searches_ = 0;
};

}  // namespace masked_mapper
