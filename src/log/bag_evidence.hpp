// SPDX-License-Identifier: BSD-3-Clause
// What the messages of a bag say of its sensors: frames, clocks, units, order. Gathered from the
// beginning of the bag before anything is read, and from all of it in the first pass.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag_plan.hpp"
#include "clock_evidence.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"
#include "range_limit.hpp"
#include "scanner_evidence.hpp"

namespace masked_mapper {

class BagEvidence {
 public:
  /// `topics`: a plan of which nothing but the topics is settled.
  BagEvidence(const LogOptions& options, const BagPlan& topics);

  /// The messages of a stream, in the order of the file; `time` is that of recording.
  void Add(std::size_t stream, double time, const RosLaserScan& scan);
  void Add(std::size_t stream, double time, const RosPointCloud& cloud);
  void Add(std::size_t stream, double time, const RosOdometry& odometry);
  void Add(std::size_t stream, double time, const std::vector<RosTransform>& transforms);
  void Add(std::size_t stream, double time, const RosImu& imu);
  void Add(std::size_t stream, double time, const RosFluidPressure& pressure);

  /// The first scanner without a scan; empty: each has spoken.
  std::optional<std::size_t> SilentScanner() const;
  /// Whether all has been seen that a plan needs.
  bool IsEnough() const;

  /// What to tell a user who named a frame of odometry that is not there; empty: it is, or none was
  /// named.
  std::string MissingOdometryFrame() const;

  BagPlan Conclude() const;
  /// What of the plan is other than the messages claim.
  std::vector<SensorFinding> Findings(const BagPlan& plan) const;

 private:
  /// Empty: too many frames on one topic.
  ScannerEvidence* NoteScanner(std::size_t stream, double time, const RosHeader& header);
  void Note(std::size_t stream, double time, double header);
  /// The frame of a scanner; of several, the one with the most scans that see anything.
  std::string FrameOf(std::size_t scanner) const;
  const ScannerEvidence& EvidenceOf(std::size_t scanner) const;
  /// Of a scanner's topic, that of the frame which is read.
  const ClockEvidence& ClockOf(std::size_t stream) const;
  std::optional<std::pair<std::string, std::string>> OdometryLink(const std::string& frame) const;
  std::string RobotFrame(const std::string& scan_frame, BagPlan* plan) const;
  void SetMounts(BagPlan* plan) const;
  void SetLimit(BagPlan* plan) const;

  LogOptions options_;
  BagPlan topics_;
  FrameTree frames_;
  std::vector<ClockEvidence> clocks_;                             ///< by stream
  std::vector<std::map<std::string, ScannerEvidence>> scanners_;  ///< by frame, as below
  std::vector<std::map<std::string, ClockEvidence>> scan_clocks_;
  std::optional<std::string> child_frame_;
  std::string imu_frame_;
  RangeLimitFinder ranges_;
  double max_range_ = 0.0;  ///< m, as stated
  bool limit_is_stated_ = true;
  std::uint64_t scans_ = 0;
  double first_time_ = 0.0;  ///< s, of recording
  double newest_time_ = 0.0;
  bool has_time_ = false;
  bool is_disordered_ = false;
};

}  // namespace masked_mapper
