// SPDX-License-Identifier: BSD-3-Clause
// Where a robot is in a finished map, one observation at a time: no start pose, floor unknown.
//
// Until a place is believed, all that come into question are kept (on whole floors, and through
// rides). Then the robot is followed by its motion, and a scan is matched only where the mask says
// that it pays, against what the map knows around its nodes. When what is seen no longer fits, the
// robot is not sure any more and looks again. The map stays as it is.
//
// Poses are in the map's world. Ours; the paper builds maps for this and stops there.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

struct LocalizerOptions {
  MotionOptions motion;  ///< kAuto: fused where the first scan has odometry, else by scans alone
  FloorOptions floors;
  MaskOptions masks;
  LoopClosureOptions closures;
  SearchableFloorOptions floor_search;
  double min_edge_length_m = 1.5;  ///< of way between two matches at the least
  double max_edge_length_m = 9.0;  ///< at the most
};

/// The answer to one scan.
struct LocatedScan {
  double stamp = 0.0;      ///< s
  double log_stamp = 0.0;  ///< s, as the log gives it to the scan
  Pose2 T_odom_robot;      ///< along the motion path
  bool sure = false;       ///< the place was believed when the scan came
  bool placed = false;     ///< there is a pose: sure, or found in hindsight
  FloorId floor = 0;       ///< of the map; where placed
  UncertainPose2 T_world_robot;
};

struct UnsureSpan {
  double t_a = 0.0;  ///< s, first and last scan
  double t_b = 0.0;
  std::string why;  ///< for people
};

struct Localization {
  std::vector<LocatedScan> scans;  ///< in order
  bool found = false;
  double found_after_m = 0.0;  ///< of driving, the first time; where found
  int matches = 0;             ///< scans held against a node of the map
  int searches = 0;            ///< on whole floors
  std::vector<UnsureSpan> unsure_spans;
};

enum class ChangeKind { kNew, kGone };
constexpr const char* Name(ChangeKind kind) { return kind == ChangeKind::kNew ? "new" : "gone"; }

/// What is no longer as the map has it: a region of a floor, in world.
struct MapChange {
  ChangeKind kind = ChangeKind::kNew;
  FloorId floor = 0;
  double x = 0.0;  ///< m, its middle
  double y = 0.0;
  double size_m = 0.0;  ///< its longest side
};

class Localizer {
 public:
  /// `map` outlives this. Throws InputError when `mask` is no mask expression.
  Localizer(const BuildingMap& map, const std::string& mask, const LocalizerOptions& options);
  ~Localizer();

  /// Another log begins, whose motion `source` tells: not kAuto. To be called before the first one
  /// only where kAuto is settled by more than the first scan. Between two logs the robot may have
  /// been carried anywhere.
  void BeginLog(MotionSource source);

  /// Observations in order of stamps. True: it was a scan, and result().scans has the answer.
  bool Observe(const Observation& observation);

  /// Up to now.
  const Localization& result() const;

  /// What is no longer as the map has it, as far as was seen from places that were sure.
  std::vector<MapChange> Changes() const;

  /// Why the robot is not sure where it is, in one line for people; empty when it is.
  std::string Doubt() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
