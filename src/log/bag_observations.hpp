// SPDX-License-Identifier: BSD-3-Clause
// Messages of a bag in, observations in order out; the counting.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bag_evidence.hpp"
#include "bag_plan.hpp"
#include "cloud_scanner.hpp"
#include "odometry_at_scans.hpp"
#include "scan_merger.hpp"
#include "stamp_mender.hpp"

namespace masked_mapper {

/// Scans of several scanners become one; everything else keeps its place in the order of stamps.
class InOrder {
 public:
  explicit InOrder(std::size_t scanners) : scanners_(scanners), merger_(scanners) {}

  void Add(Observation observation, std::size_t scanner) {
    auto* scan = std::get_if<LaserScan>(&observation);
    if (scan == nullptr || scanners_ == 1) {
      waiting_.emplace_back(std::move(observation));
      return;
    }
    if (scanner == 0) waiting_.emplace_back(std::nullopt);  // its place
    merger_.Add(std::move(*scan), scanner);
  }

  void Finish() { merger_.Finish(); }

  std::optional<Observation> Next() {
    if (waiting_.empty()) return std::nullopt;
    if (!waiting_.front()) {
      std::optional<LaserScan> merged = merger_.Next();
      if (!merged) return std::nullopt;
      waiting_.front() = std::move(*merged);
    }
    std::optional<Observation> next = std::move(waiting_.front());
    waiting_.pop_front();
    return next;
  }

 private:
  std::size_t scanners_;
  ScanMerger merger_;
  std::deque<std::optional<Observation>> waiting_;
};

/// Whether clouds are kept beside the scans that are cut from them.
enum class CloudsKept { kNone, kWhereTheRobotWentOn };

class BagObservations {
 public:
  /// All must outlive it. With `evidence`, what is read is noted there.
  BagObservations(const LogOptions& options, const BagPlan& plan, const RosBag& bag,
                  BagEvidence* evidence = nullptr, CloudsKept clouds = CloudsKept::kNone);

  void Add(const BagMessage& message);
  /// No more will come.
  void Finish();
  /// The next observation that is ready.
  std::optional<Observation> Next();
  LogStatistics Statistics() const;
  /// Those that were worth keeping since it was asked last.
  std::vector<StampedCloud> TakeClouds() { return std::exchange(kept_clouds_, {}); }

 private:
  /// From the mender to the odometry to the order of what is handed out.
  void MoveOn();
  /// False when the message is malformed.
  bool Take(std::size_t stream, const BagMessage& message);
  void TakeMessage(std::size_t stream, double time, RosLaserScan& scan);
  void TakeMessage(std::size_t stream, double time, RosPointCloud& cloud);
  void TakeMessage(std::size_t stream, double time, const RosOdometry& odometry);
  void TakeMessage(std::size_t stream, double time, const std::vector<RosTransform>& transforms);
  void TakeMessage(std::size_t stream, double time, const RosImu& imu);
  void TakeMessage(std::size_t stream, double time, const RosFluidPressure& pressure);
  /// Whether the message is of the frame that is read of its topic; counted when not.
  bool IsOfFrame(std::size_t stream, const RosHeader& header);
  void AddOdometry(std::size_t stream, const OdometryReading& reading);
  LaserScan Convert(RosLaserScan ros_scan, double stamp, std::size_t scanner);
  void Count(const Observation& observation);
  void CountOther(const std::string& name);

  const LogOptions& options_;
  const BagPlan& plan_;
  const RosBag& bag_;
  BagEvidence* evidence_;
  BagStreams streams_;
  CloudsKept clouds_;
  std::vector<StampedCloud> kept_clouds_;
  RobotMotion motion_;
  std::vector<CloudScanner> lidars_;  ///< of the scanners
  StampMender mender_;
  OdometryAtScans at_scans_;
  InOrder in_order_;
  LogStatistics statistics_;
  bool has_first_stamp_ = false;
  bool finished_ = false;
};

}  // namespace masked_mapper
