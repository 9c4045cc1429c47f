// SPDX-License-Identifier: BSD-3-Clause
// How much what was seen speaks for a place: the one rule by which a place is believed, given up,
// or held to be no better than another that looks alike.
//
// Each patch that was seen agrees with the map at a place, or does not, or the map says nothing
// there. In the right place nearly all agree, in one that looks alike many. Of two rivals, either
// what one of them shows has nothing to do with the other; or the one is a copy of the other (the
// floors of a tower): then what agrees with the one nearly always agrees with the other. Patches
// that do not are noise, which is rare and speaks for either copy alike, or they are what tells the
// two apart, and then nearly all speak for the one. Which of these it is, is weighed along; and so
// is how large the share of each is, which nobody knows beforehand. Evidence is counted in nats,
// the logarithm of how many times likelier.
#pragma once

#include <cstdint>
#include <vector>

#include "known_map.hpp"
#include "stretch.hpp"

namespace masked_mapper {

/// A share that nobody knows: as if so many patches had been seen before.
struct UnknownShare {
  double with = 1.0;
  double without = 1.0;
};

struct EvidenceOptions {
  double agrees_in_place = 0.8;              ///< share of patches that agree, in the right place
  double agrees_elsewhere = 0.5;             ///< in a wrong one that looks alike
  double agrees_anywhere = 0.35;             ///< in a wrong one as good as any other
  double believed_nats = 9.2;                ///< of a place against all others: ten thousand to one
  double speaks_for_right = 0.9;             ///< share of the patches that tell two copies apart
  UnknownShare strays_in_place{2.0, 8.0};    ///< patches that do not agree in the right place
  UnknownShare differs_by_noise{1.0, 30.0};  ///< patches that agree with one of two copies alone,
                                             ///< though they are the same
  UnknownShare differs_in_copies{1.0, 9.0};  ///< and where something tells the two apart
  double told_apart_nats = 7.0;              ///< of a place against one other: a thousand to one
  double copy_nats = 9.0;  ///< by which a pair of places is likelier not to be copies
  double leaves_map_per_m =
      0.005;                       ///< of a robot: how likely it is to go where the map has nothing
  double comes_back_per_m = 0.05;  ///< and back
};

/// How well a patch fits, in percent, or one of what follows.
using PatchFit = std::uint8_t;
constexpr PatchFit kMapSaysNothing = 255;
constexpr PatchFit kFreeAsSeen = 200;  ///< as most of any building: it tells little by itself

/// How well it fits with the robot's motion path lying at T_world_odom on `floor`.
PatchFit FitOf(const Patch& patch, const SearchableFloor& floor, const Pose2& T_world_odom);

/// Whether a scan fits the floor better from one pose than from another.
bool FitsBetter(const LaserScan& scan, const SearchableFloor& floor, const Pose2& T_world_robot,
                const Pose2& T_world_other);

/// What all patches say of one place.
struct Tally {
  int agreeing = 0;       ///< patches that hit something where the map has it
  int contradicting = 0;  ///< patches that the map has otherwise

  void Add(PatchFit fit);
};

/// How much likelier the right place made them than a wrong one, of which `agrees_wrong` agree.
double NatsOf(const Tally& tally, double agrees_wrong, const EvidenceOptions& options);

/// The same of all that was seen along a way: how large a share agrees in the right place is one
/// for all of it, and learnt along. A wrong one is as such that look alike are.
double NatsOfWay(const Tally& tally, const EvidenceOptions& options);

/// What of a robot's way lies where the map has nothing. That is a few stretches of many metres
/// rather than a metre here and there: what is dear is to leave the map.
class WayOffTheMap {
 public:
  /// What was seen next, at `at_m` of the way; only what was judged.
  void Add(PatchFit fit, double at_m, const EvidenceOptions& options);

  /// How much likelier a robot on the map is to have driven so than one that never leaves it; not
  /// above 0.
  double nats() const { return nats_ + leaves_nats_; }

 private:
  double look_begins_m_ = -1e9;
  int known_ = 0;
  int unknown_ = 0;
  bool is_off_ = false;
  double nats_ = 0.0;
  double leaves_nats_ = 0.0;  ///< of the look that goes on
};

/// A place that looks alike for a while fits on only by moving along: corridors whose doors are
/// spaced otherwise. How much likelier motion is not to have been off by `slip_m` after `way_m`
/// than to have been; as a negative number.
double SlipNats(double slip_m, double way_m);

/// How much likelier it is that the first of two places is the right one than the other.
double LeadOf(const std::vector<PatchFit>& one, const std::vector<PatchFit>& other,
              const EvidenceOptions& options);

}  // namespace masked_mapper
