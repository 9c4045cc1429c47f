// SPDX-License-Identifier: BSD-3-Clause
// A mask (Section III-A, Eq. 1): a function of all observations so far to true or false, that says
// where a scan is worth storing and matching. It sees everything and answers one question. Masks go
// by name, and by expressions of names: `openings`, `any(openings,eccentricity)`, `not(never)`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/masks/mask_options.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// One scan as a mask sees it.
struct MaskObservation {
  const LaserScan& scan;
  Pose2 T_odom_robot;  ///< where motion puts the robot at the scan, in a frame that drifts slowly
};

class Mask {
 public:
  virtual ~Mask() = default;
  /// Called for every scan, in order, whether or not a node may be made there.
  virtual void Observe(const MaskObservation& observation) = 0;
  /// Whether the scan observed last is worth a node.
  virtual bool Fires() const = 0;
  /// A scan node was made at the observation seen last.
  virtual void OnNode() {}
  /// The robot is somewhere else altogether (a new floor): forget everything.
  virtual void Restart() = 0;
};

using MaskFactory = std::function<std::unique_ptr<Mask>(const MaskOptions&)>;

/// Adds a mask under a name ([a-z0-9_]+, not a combination's); true, so that one line at namespace
/// scope registers a user's mask. A bad name, or one taken twice, is the caller's bug:
/// std::logic_error.
bool RegisterMask(const std::string& name, MaskFactory factory);

/// The names that an expression may use, sorted.
std::vector<std::string> RegisteredMasks();

/// Builds the mask of an expression. Throws InputError with one line that says what is
/// wrong and where ("unknown mask `openingz` (did you mean `openings`?)").
std::unique_ptr<Mask> MakeMask(const std::string& expression, const MaskOptions& options);

}  // namespace masked_mapper
