// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_summary.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// Counts in bins, so that a quantile needs no memory that grows with the log.
class Histogram {
 public:
  Histogram(double bin, std::size_t bins) : bin_(bin), counts_(bins, 0) {}

  void Add(double value) {
    const double index = std::clamp(value / bin_, 0.0, static_cast<double>(counts_.size() - 1));
    ++counts_[static_cast<std::size_t>(index)];
    ++total_;
  }

  double Quantile(double share) const {
    const double wanted = share * static_cast<double>(total_);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      below += counts_[i];
      if (total_ > 0 && static_cast<double>(below) >= wanted) {
        return (static_cast<double>(i) + 0.5) * bin_;
      }
    }
    return 0.0;
  }

  std::uint64_t total() const { return total_; }

 private:
  double bin_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t total_ = 0;
};

/// Steps between the stamps of one kind, to 0.2 ms up to 20 s.
class Steps {
 public:
  void Add(double stamp) {
    if (last_) {
      const double step = stamp - *last_;
      steps_.Add(step);
      if (step < kPause) {
        ++steps_within_;
        time_within_ += step;
      }
      if (step > largest_gap_) {
        largest_gap_ = step;
        largest_gap_stamp_ = *last_;
      }
    }
    last_ = stamp;
  }

  /// Readings per second while there were some; of slow sensors, by the usual step.
  double Rate() const {
    if (2 * steps_within_ >= steps_.total() && time_within_ > 0.0) {
      return static_cast<double>(steps_within_) / time_within_;
    }
    return steps_.total() == 0 ? 0.0 : 1.0 / steps_.Quantile(0.5);
  }
  double largest_gap() const { return largest_gap_; }
  double largest_gap_stamp() const { return largest_gap_stamp_; }

 private:
  static constexpr double kPause = 2.0;  // s

  std::optional<double> last_;
  std::uint64_t steps_within_ = 0;
  double time_within_ = 0.0;  ///< s
  Histogram steps_{0.0002, 100000};
  double largest_gap_ = 0.0;
  double largest_gap_stamp_ = 0.0;
};

/// Length and turns of the path through the poses of one source.
class Path {
 public:
  void Add(const Pose2& T_odom_robot) {
    if (last_) {
      length_ += Distance(*last_, T_odom_robot);
      turned_ += std::abs(WrapAngle(T_odom_robot.theta - last_->theta));
    }
    last_ = T_odom_robot;
  }
  bool IsEmpty() const { return !last_; }
  double length() const { return length_; }
  double turned() const { return turned_; }

 private:
  std::optional<Pose2> last_;
  double length_ = 0.0;
  double turned_ = 0.0;
};

class Summariser {
 public:
  void Add(const OdometryReading& reading) {
    odometry_steps_.Add(reading.stamp);
    odometry_path_.Add(reading.T_odom_robot);
  }
  void Add(const PressureReading& reading) { pressure_steps_.Add(reading.stamp); }
  void Add(const AccelerationReading& reading) { acceleration_steps_.Add(reading.stamp); }
  void Add(const FloorLabel&) {}
  void Add(const LaserScan& scan) {
    if (summary_.scans_of_beams.empty()) summary_.T_robot_laser = scan.T_robot_laser;
    scan_steps_.Add(scan.stamp);
    if (scan.T_odom_robot) scan_path_.Add(*scan.T_odom_robot);
    ++summary_.scans_of_beams[scan.size()];
    const double span =
        std::abs(scan.angle_step) * static_cast<double>(std::max<std::size_t>(scan.size(), 1) - 1);
    summary_.field_of_view_rad = std::max(summary_.field_of_view_rad, span);
    for (const float range : scan.ranges) {
      if (std::isnan(range)) {
        ++invalid_;
      } else if (range < scan.max_range) {
        ranges_.Add(range);
      } else {
        ++no_return_;
      }
    }
  }

  LogSummary Finish(const LogStatistics& statistics) {
    LogSummary& summary = summary_;
    summary.statistics = statistics;
    summary.duration_s = statistics.last_stamp - statistics.first_stamp;
    const Path& path = scan_path_.IsEmpty() ? odometry_path_ : scan_path_;
    summary.has_odometry = !path.IsEmpty();
    summary.path_length_m = path.length();
    summary.turned_rad = path.turned();
    summary.max_range_m = statistics.max_range;
    for (std::size_t i = 0; i < LogSummary::kQuantiles.size(); ++i) {
      summary.range_quantiles_m[i] = ranges_.Quantile(LogSummary::kQuantiles[i]);
    }
    const double beams =
        static_cast<double>(std::max<std::uint64_t>(1, ranges_.total() + no_return_ + invalid_));
    summary.share_no_return = static_cast<double>(no_return_) / beams;
    summary.share_invalid = static_cast<double>(invalid_) / beams;
    summary.scan_rate_hz = scan_steps_.Rate();
    summary.odometry_rate_hz = odometry_steps_.Rate();
    summary.pressure_rate_hz = pressure_steps_.Rate();
    summary.acceleration_rate_hz = acceleration_steps_.Rate();
    summary.largest_gap_s = scan_steps_.largest_gap();
    summary.largest_gap_stamp = scan_steps_.largest_gap_stamp();
    return summary;
  }

 private:
  LogSummary summary_;
  Steps scan_steps_, odometry_steps_, pressure_steps_, acceleration_steps_;
  Path scan_path_, odometry_path_;
  Histogram ranges_{0.01, 100001};
  std::uint64_t no_return_ = 0;
  std::uint64_t invalid_ = 0;
};

}  // namespace

LogSummary Summarise(LogSource& source) {
  while (true) {
    const std::unique_ptr<LogReader> reader = source.Read();
    Summariser summariser;
    while (const std::optional<Observation> observation = reader->Next()) {
      std::visit([&summariser](const auto& reading) { summariser.Add(reading); }, *observation);
    }
    if (source.Reconsider()) continue;
    LogSummary summary = summariser.Finish(reader->Statistics());
    summary.findings = source.Findings();
    return summary;
  }
}

std::vector<std::string> WarningsOf(const LogStatistics& log) {
  std::vector<std::string> warnings;
  if (log.bad_lines > 0) {
    warnings.push_back(std::to_string(log.bad_lines) +
                       " bad lines skipped, the first: " + log.first_bad_line);
  }
  if (log.truncated) {
    warnings.emplace_back("the file is cut off; what came before the cut was used");
  }
  if (log.stamp_jumps > 0) {
    warnings.push_back(std::to_string(log.stamp_jumps) +
                       " stamps that step backwards or wrap were mended");
  }
  if (log.empty_scans > 0) {
    warnings.push_back(std::to_string(log.empty_scans) + " scans without a single return");
  }
  return warnings;
}

}  // namespace masked_mapper
