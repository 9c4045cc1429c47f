// SPDX-License-Identifier: BSD-3-Clause
// Lines of a CARMEN log in, mended observations out; the counting.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "carmen_line.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "scan_calibration.hpp"
#include "stamp_mender.hpp"
#include "unpadded_stamps.hpp"

namespace masked_mapper {

class CarmenLines {
 public:
  CarmenLines(const LogOptions& options, const ScanCalibration& calibration, bool is_unpadded)
      : read_ranges_(options.read_ranges), calibration_(calibration), is_unpadded_(is_unpadded) {
    statistics_.max_range = calibration.max_range();
  }

  /// False when the line was malformed.
  bool Add(const char* begin, const char* end, bool too_long) {
    ++statistics_.lines;
    const std::uint64_t bad_before = statistics_.bad_lines;
    if (too_long) {
      Handle(CarmenError{"longer than any message"});
    } else {
      std::visit([this](auto&& part) { Handle(std::forward<decltype(part)>(part)); },
                 ParseCarmenLine(begin, end, read_ranges_));
    }
    return statistics_.bad_lines == bad_before;
  }

  void SetTruncated() { statistics_.truncated = true; }
  void SetTrailingBytes(std::uint64_t count) { statistics_.trailing_bytes = count; }
  void Finish() { mender_.Finish(); }
  const UnpaddedStamps& unpadded_stamps() const { return unpadded_stamps_; }

  std::optional<Observation> Next() {
    std::optional<Observation> observation = mender_.Next();
    if (!observation) return observation;
    const double stamp = Stamp(*observation);
    if (!has_first_stamp_) statistics_.first_stamp = stamp;
    has_first_stamp_ = true;
    statistics_.last_stamp = stamp;
    return observation;
  }

  LogStatistics Statistics() const {
    LogStatistics statistics = statistics_;
    statistics.stamp_jumps = mender_.jumps();
    statistics.reordered = mender_.reordered();
    return statistics;
  }

 private:
  static constexpr std::size_t kMostMessageNames = 64;

  void Handle(CarmenNothing) {}
  void Handle(CarmenParam&&) {}
  void Handle(CarmenOther&& other) { CountOther(other.name); }
  void Handle(CarmenError&& error) {
    if (statistics_.bad_lines++ == 0) {
      statistics_.first_bad_line =
          "line " + std::to_string(statistics_.lines) + ": " + error.reason;
    }
  }
  void Handle(const OdometryReading& reading) { Take(reading, &statistics_.odometry); }
  void Handle(const PressureReading& reading) { Take(reading, &statistics_.pressure); }
  void Handle(AccelerationReading&& reading) {
    Take(std::move(reading), &statistics_.acceleration);
  }
  void Handle(FloorLabel&& reading) { Take(std::move(reading), &statistics_.floor_labels); }
  void Handle(CarmenScan&& carmen_scan) {
    if (carmen_scan.is_flaser && calibration_.flaser_is_twin()) {
      CountOther("FLASER (repeats ROBOTLASER1)");
      return;
    }
    LaserScan scan = calibration_.Apply(std::move(carmen_scan), &statistics_.invalid_ranges);
    const auto is_hit = [&scan](float range) { return range < scan.max_range; };
    if (read_ranges_ && std::none_of(scan.ranges.begin(), scan.ranges.end(), is_hit)) {
      ++statistics_.empty_scans;
    }
    Take(std::move(scan), &statistics_.scans);
  }

  void Take(Observation observation, std::uint64_t* count) {
    ++*count;
    const double meant = unpadded_stamps_.Meant(Stamp(observation), observation.index());
    if (is_unpadded_) std::visit([meant](auto& reading) { reading.stamp = meant; }, observation);
    mender_.Add(std::move(observation));
  }

  void CountOther(const std::string& name) {
    auto& others = statistics_.other_messages;
    const bool has_room = others.size() < kMostMessageNames || others.count(name) > 0;
    ++others[has_room ? name : "(others)"];
  }

  const bool read_ranges_;
  const ScanCalibration& calibration_;
  const bool is_unpadded_;
  UnpaddedStamps unpadded_stamps_;
  StampMender mender_;
  LogStatistics statistics_;
  bool has_first_stamp_ = false;
};

}  // namespace masked_mapper
