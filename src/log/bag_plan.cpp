// SPDX-License-Identifier: BSD-3-Clause
#include "bag_plan.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "masked_mapper/text/input_error.hpp"
#include "range_limit.hpp"

namespace masked_mapper {
namespace {

constexpr double kLeastLimit = 1.0;  // m; a range_max below is none

std::string Listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    std::string part = text.substr(begin, comma - begin);
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    if (!part.empty()) parts.push_back(part);
    begin = comma + 1;
  }
  return parts;
}

/// The topics of a bag by kind, and which of them to read.
class TopicChoice {
 public:
  TopicChoice(const std::string& path, const std::map<std::uint32_t, BagConnection>& connections)
      : path_(path) {
    for (const auto& [id, connection] : connections) {
      const std::optional<TopicKind> kind = KindOf(connection);
      if (kind) kinds_.emplace(connection.topic, *kind);
    }
  }

  /// Throws InputError with all that the user is to choose or to mend, so that it is told once.
  BagPlan Choose(const LogOptions& options) {
    BagPlan plan;
    for (const std::string& name :
         Pick(Scanners(options), "scan", "log.scan_topic", options.scan_topic)) {
      plan.topics.push_back({name, kinds_.at(name), plan.scanners++, {}});
    }
    if (plan.scanners == 0 && problems_.empty()) return plan;
    const bool by_tf = !options.odom_frame.empty() && options.odometry_topic.empty();
    AddOne({TopicKind::kOdometry}, "odometry", "log.odometry_topic",
           by_tf ? "none" : options.odometry_topic, &plan);
    plan.has_odometry_topic = plan.topics.size() > plan.scanners;
    AddOne({TopicKind::kImu}, "IMU", "log.imu_topic", options.imu_topic, &plan);
    AddOne({TopicKind::kPressure}, "pressure", "log.pressure_topic", options.pressure_topic, &plan);
    if (!problems_.empty()) throw InputError(path_ + ": " + problems_);
    for (const auto& [name, kind] : kinds_) {
      if (kind == TopicKind::kTransforms) plan.topics.push_back({name, kind, 0, {}});
    }
    plan.mounts.resize(plan.scanners);
    plan.clocks.resize(plan.topics.size());
    plan.ranges.resize(plan.scanners);
    plan.T_robot_lidar.assign(plan.scanners, Eigen::Isometry3d::Identity());
    return plan;
  }

 private:
  void AddProblem(const std::string& problem) {
    problems_ += (problems_.empty() ? "" : "; ") + problem;
  }

  /// Who records scans besides clouds maps by the scans; clouds stand in where they are named, or
  /// alone.
  std::set<TopicKind> Scanners(const LogOptions& options) const {
    std::set<TopicKind> flat = {TopicKind::kScan, TopicKind::kMultiEcho};
    const bool has_flat = std::any_of(kinds_.begin(), kinds_.end(), [&flat](const auto& topic) {
      return flat.count(topic.second) > 0;
    });
    if (has_flat && options.scan_topic.empty()) return flat;
    return {TopicKind::kScan, TopicKind::kMultiEcho, TopicKind::kCloud};
  }

  std::vector<std::string> Pick(const std::set<TopicKind>& wanted, const std::string& what,
                                const std::string& option, const std::string& given) {
    std::vector<std::string> candidates;
    for (const auto& [name, kind] : kinds_) {
      if (wanted.count(kind) > 0) candidates.push_back(name);
    }
    if (given == "none") return {};
    if (!given.empty()) {
      std::vector<std::string> picked = SplitAtCommas(given);
      for (const std::string& name : picked) {
        if (std::count(picked.begin(), picked.end(), name) > 1) {
          AddProblem(option + ": names `" + name + "` twice");
          return {};
        }
        if (std::find(candidates.begin(), candidates.end(), name) != candidates.end()) continue;
        AddProblem(option + ": no " + what + " topic `" + name + "`" +
                   DidYouMean(name, candidates) + "; the bag has " +
                   (candidates.empty() ? "none" : Listed(candidates)));
        return {};
      }
      return picked;
    }
    if (candidates.size() > 1) {
      const bool may_be_merged = wanted.count(TopicKind::kScan) > 0;
      AddProblem("has several " + what + " topics (" + Listed(candidates) + "); choose with " +
                 option + "=" + candidates.front() +
                 (may_be_merged ? ", or several with commas to merge them" : ""));
      return {};
    }
    return candidates;
  }

  void AddOne(const std::set<TopicKind>& wanted, const std::string& what, const std::string& option,
              const std::string& given, BagPlan* plan) {
    const std::vector<std::string> picked = Pick(wanted, what, option, given);
    if (picked.size() > 1) AddProblem(option + ": takes one topic");
    if (picked.size() == 1)
      plan->topics.push_back({picked.front(), kinds_.at(picked.front()), 0, {}});
  }

  std::string path_;
  std::map<std::string, TopicKind> kinds_;
  std::string problems_;
};

}  // namespace

BagPlan ChooseTopics(const std::string& path,
                     const std::map<std::uint32_t, BagConnection>& connections,
                     const LogOptions& options) {
  return TopicChoice(path, connections).Choose(options);
}

std::optional<std::size_t> BagStreams::Find(std::uint32_t connection) {
  const auto known = streams_.find(connection);
  if (known != streams_.end()) return known->second;
  const BagConnection& wanted = bag_.Connections().at(connection);
  const auto topic =
      std::find_if(plan_.topics.begin(), plan_.topics.end(),
                   [&wanted](const BagTopic& read) { return read.name == wanted.topic; });
  std::optional<std::size_t> stream;
  if (KindOf(wanted) && topic != plan_.topics.end()) {
    stream = static_cast<std::size_t>(topic - plan_.topics.begin());
  }
  streams_.emplace(connection, stream);
  return stream;
}

bool BagStreams::IsCloud(std::uint32_t connection) {
  const std::optional<std::size_t> stream = Find(connection);
  return stream && plan_.topics[*stream].kind == TopicKind::kCloud;
}

bool ReadsOtherwise(const BagPlan& one, const BagPlan& other) {
  constexpr double kSameOffset = 1.0;  // s; nearer, the beginning said as much
  constexpr double kSameMount = 1e-9;
  const auto same_topic = [](const BagTopic& a, const BagTopic& b) { return a.frame == b.frame; };
  const auto same_clock = [](const TopicClock& a, const TopicClock& b) {
    return a.is_steady == b.is_steady && a.whole_seconds == b.whole_seconds &&
           a.offset.has_value() == b.offset.has_value() &&
           std::abs(a.offset.value_or(0.0) - b.offset.value_or(0.0)) < kSameOffset;
  };
  const auto same_mount = [](const PlanarMount& a, const PlanarMount& b) {
    return a.upside_down == b.upside_down &&
           (a.T_robot_laser.AsVector() - b.T_robot_laser.AsVector()).norm() < kSameMount;
  };
  const auto same_lidar = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.matrix() - b.matrix()).norm() < kSameMount;
  };
  const auto same_ranges = [](const ScannerRanges& a, const ScannerRanges& b) {
    return a.scale == b.scale && a.believes_range_min == b.believes_range_min;
  };
  const auto all = [](const auto& a, const auto& b, const auto& same) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
  };
  return !all(one.topics, other.topics, same_topic) || !all(one.clocks, other.clocks, same_clock) ||
         !all(one.mounts, other.mounts, same_mount) ||
         !all(one.T_robot_lidar, other.T_robot_lidar, same_lidar) ||
         !all(one.ranges, other.ranges, same_ranges) || one.is_disordered != other.is_disordered ||
         one.odometry_frame != other.odometry_frame || one.robot_frame != other.robot_frame ||
         (one.R_robot_imu - other.R_robot_imu).norm() > kSameMount;
}

std::optional<RosMessage> ParseMessage(TopicKind kind, const BagMessage& message,
                                       const LogOptions& options) {
  const auto as_message = [](auto parsed) -> std::optional<RosMessage> {
    if (!parsed) return std::nullopt;
    return RosMessage(std::move(*parsed));
  };
  const unsigned char* const data = message.data;
  const EchoChoice echo = options.strongest_echo ? EchoChoice::kStrongest : EchoChoice::kFirst;
  switch (kind) {
    case TopicKind::kScan:
      return as_message(ParseLaserScan(data, message.size, message.encoding));
    case TopicKind::kMultiEcho:
      return as_message(ParseMultiEchoLaserScan(data, message.size, echo, message.encoding));
    case TopicKind::kCloud:
      if (message.cloud) return RosMessage(std::move(*message.cloud));
      return as_message(ParsePointCloud(data, message.size, message.encoding));
    case TopicKind::kOdometry:
      return as_message(ParseOdometry(data, message.size, message.encoding));
    case TopicKind::kTransforms:
      return as_message(ParseTransforms(data, message.size, message.encoding));
    case TopicKind::kImu:
      return as_message(ParseImu(data, message.size, message.encoding));
    case TopicKind::kPressure:
      return as_message(ParseFluidPressure(data, message.size, message.encoding));
  }
  return std::nullopt;
}

std::string FaultOf(TopicKind kind, const BagMessage& message) {
  if (kind != TopicKind::kCloud) return "malformed";
  return "PointCloud2 that " + FaultOfPointCloud(message.data, message.size, message.encoding);
}

double BagPlan::StampOf(std::size_t stream, double time, double header) const {
  const TopicClock& clock = clocks[stream];
  const double offset = clock.offset.value_or(clock_offset);
  const bool same_clock = std::abs(offset - clock_offset) <= kClocksApart;
  if (!(header > 0.0) || !same_clock) return time + clock_offset;
  const bool is_stray = clock.is_steady && std::abs(header - time - offset) > kStray;
  return is_stray || clock.whole_seconds ? time + offset : header;
}

OdometryReading BagPlan::ReadingOf(std::size_t stream, double time,
                                   const RosOdometry& odometry) const {
  return {StampOf(stream, time, odometry.header.stamp),
          SeenFromAbove(odometry.T_frame_child).T_robot_laser};
}

std::optional<OdometryReading> BagPlan::ReadingOf(std::size_t stream, double time,
                                                  const RosTransform& transform) const {
  if (odometry_frame.empty() || transform.header.frame_id != odometry_frame ||
      transform.child_frame_id != robot_frame) {
    return std::nullopt;
  }
  return OdometryReading{StampOf(stream, time, transform.header.stamp),
                         SeenFromAbove(transform.T_frame_child).T_robot_laser};
}

AccelerationReading BagPlan::ReadingOf(std::size_t stream, double time, const RosImu& imu) const {
  return {StampOf(stream, time, imu.header.stamp), R_robot_imu * imu.acceleration};
}

bool IsRangeLimit(double range_max) {
  return range_max >= kLeastLimit && range_max < RangeLimitFinder::kAbsurdRange;
}

}  // namespace masked_mapper
