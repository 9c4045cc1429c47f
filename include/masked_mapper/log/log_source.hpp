// SPDX-License-Identifier: BSD-3-Clause
// A robot's log that is opened and planned once, and then read pass after pass: to survey it, to
// map it. What a first look must settle (topics, mounts, clocks, the limit of the ranges) is
// settled once; a stream that can be read but once is kept in a temporary file.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"

namespace masked_mapper {

/// What a survey found out of wheels that lie, and by which a log is read as if they did not.
struct OdometryMending {
  double scan_clock_s = 0.0;    ///< s by which the stamps of scans are ahead of the odometry's
  double travel_factor = 1.0;   ///< true travel over what wheels say
  double turn_factor = 1.0;     ///< the same of turns
  bool turns_left_out = false;  ///< turns by wheels are of no use, the length of their way is
  /// In which wheels say nothing of use, by the stamps of scans as they are read with
  /// `scan_clock_s` taken off; in order, ends included.
  std::vector<TimeSpan> left_out;

  bool IsNone() const {
    return scan_clock_s == 0.0 && travel_factor == 1.0 && turn_factor == 1.0 && !turns_left_out &&
           left_out.empty();
  }
};

class LogPlan;
class Spool;

class LogSource {
 public:
  /// `-` is standard input. Throws InputError when it cannot be read as a log at all: no such file,
  /// empty, binary, a bag without a scan.
  LogSource(const std::string& path, const LogOptions& options);
  /// Bags of one recording, in its order (RecordingsOf).
  LogSource(const std::vector<std::string>& paths, const LogOptions& options);
  /// A stream that another has read; as much of it as is kept now is the log.
  LogSource(std::shared_ptr<Spool> stream, const LogOptions& options);
  ~LogSource();
  LogSource(const LogSource&) = delete;
  LogSource& operator=(const LogSource&) = delete;

  /// As it was given; of several, the first.
  const std::string& path() const { return path_; }
  /// Whether it can be read but once, and is gone when the program ends.
  bool is_stream() const { return spool_ != nullptr; }

  /// A pass from the beginning. May outlive the source.
  std::unique_ptr<LogReader> Read() const;

  /// To be called behind the first pass, read to its end. True when all of the log says otherwise
  /// of its sensors than its beginning did: what was read is to be read again.
  bool Reconsider();
  /// Passes from now on are mended so.
  void Mend(OdometryMending mending) { mending_ = std::move(mending); }
  /// Passes from now on keep of the clouds that scans are cut from those before which the robot
  /// went on.
  void KeepClouds();
  /// Those of the last pass, once it was read to its end, in order.
  std::vector<StampedCloud> KeptClouds() const;
  /// What the log says of its own sensors, as far as it was read.
  std::vector<SensorFinding> Findings() const;

 private:
  std::string path_;
  std::shared_ptr<Spool> spool_;
  std::unique_ptr<LogPlan> plan_;
  OdometryMending mending_;
};

/// Whether a path is a ROS bag of any kind, by what it is, not by its name; false also when it
/// cannot be opened.
bool IsBag(const std::string& path);

/// The files of each recording, in the order of recording; recordings in the order of their first
/// file among those given. Bags of the same topics of which one begins as the other ends are one;
/// anything else stands by itself. Throws InputError when a bag cannot be read.
std::vector<std::vector<std::string>> RecordingsOf(const std::vector<std::string>& files);
/// One of those recordings. Throws InputError when it cannot be read as a log.
std::unique_ptr<LogSource> OpenRecording(const std::vector<std::string>& files,
                                         const LogOptions& options);

}  // namespace masked_mapper
