// SPDX-License-Identifier: BSD-3-Clause
// What scan lines leave unsaid, found from a first look at the log: which ranges mean "no return",
// where the laser sits on the robot, and which directions FLASER's beams have (DESIGN, Logs).
// Options given by the user overrule the log, the log's lines overrule its PARAMs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "carmen_line.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "range_limit.hpp"

namespace masked_mapper {

/// First direction and step of a scan's beams, rad.
struct BeamGeometry {
  double first_angle = 0.0;
  double angle_step = 0.0;
};

/// FLASER has no geometry of its own: an odd number of beams spans the field of view exactly, an
/// even one spans it less one step (181 and 361, 180 and 360 beams of 180 degrees).
BeamGeometry FlaserGeometry(std::size_t beams, double field_of_view);

/// From the scan's own header; where its fields disagree, from those that agree with the number of
/// beams.
BeamGeometry RobotLaserGeometry(const CarmenScan& scan);

class ScanCalibration {
 public:
  /// m, the limit in force, for logs whose scans do not each say theirs.
  double max_range() const { return max_range_; }
  /// Whether FLASER lines only repeat the ROBOTLASER1 lines of the same log.
  bool flaser_is_twin() const { return flaser_is_twin_; }

  /// The scan in our terms; its stamp as it is. Beams that say nothing, but should, are counted.
  LaserScan Apply(CarmenScan scan, std::uint64_t* invalid_ranges) const;

 private:
  friend class CalibrationFinder;
  BeamGeometry Geometry(const CarmenScan& scan) const;

  double min_range_ = 0.0;              ///< m
  float no_return_ = 0.0F;              ///< m, ranges at or beyond it are no return
  double max_range_ = 0.0;              ///< m
  bool trust_scans_own_limit_ = false;  ///< ROBOTLASER1's maximum_range
  bool flaser_is_twin_ = false;
  bool upside_down_ = false;
  double field_of_view_ = 0.0;                ///< rad, of FLASER; 0: 180 degrees or by resolution
  double resolution_ = 0.0;                   ///< rad, of FLASER; 0: unknown
  std::array<Pose2, 2> T_robot_laser_;        ///< of ROBOTLASER1 and FLASER
  std::array<bool, 2> odometry_is_lasers_{};  ///< only the laser's pose is written in this log
};

/// Collects what a first look at a log shows.
class CalibrationFinder {
 public:
  explicit CalibrationFinder(const LogOptions& options) : options_(options) {}

  void Add(const CarmenScan& scan);
  void Add(const CarmenParam& param);
  /// Whether more of the log would change nothing.
  bool IsSettled() const;
  ScanCalibration Find() const;

 private:
  struct Poses {
    std::vector<Pose2> T_robot_laser;  ///< of the first scans
    std::optional<Pose2> first_robot;
    std::optional<Pose2> first_laser;
    double robot_moved = 0.0;  ///< m, or rad when that is more
    double laser_moved = 0.0;
  };
  std::optional<double> DeclaredLimit() const;
  Pose2 LaserOnRobot(const Poses& poses) const;

  LogOptions options_;
  RangeLimitFinder ranges_;
  std::uint64_t scans_ = 0;
  std::array<Poses, 2> poses_;
  std::array<std::optional<double>, 2> last_stamp_;
  std::uint64_t twins_ = 0;
  double scan_limit_ = 0.0;           ///< m, the largest maximum_range of ROBOTLASER1
  double param_limit_ = 0.0;          ///< m
  double param_field_of_view_ = 0.0;  ///< rad
  double param_resolution_ = 0.0;     ///< rad
  Pose2 param_T_robot_laser_;
};

}  // namespace masked_mapper
