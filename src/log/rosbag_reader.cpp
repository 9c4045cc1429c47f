// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/rosbag_reader.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/angle.hpp"
#include "masked_mapper/log/bag_file.hpp"
#include "masked_mapper/log/frame_tree.hpp"
#include "masked_mapper/log/odometry_at_scans.hpp"
#include "masked_mapper/log/range_limit.hpp"
#include "masked_mapper/log/read_ahead.hpp"
#include "masked_mapper/log/ros2_bag_file.hpp"
#include "masked_mapper/log/ros_messages.hpp"
#include "masked_mapper/log/scan_merger.hpp"
#include "masked_mapper/log/stamp_mender.hpp"
#include "masked_mapper/text/did_you_mean.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongestLook = 60.0;  // s of the bag, for frames that come late
constexpr std::size_t kScansForLimit = 300;
constexpr double kClocksApart = 5.0;  // s
constexpr double kLeastLimit = 1.0;   // m; a range_max below is none
constexpr std::size_t kMostOtherTopics = 64;

enum class Kind { kScan, kMultiEcho, kOdometry, kTransforms, kImu, kPressure };

struct MessageType {
  const char* type;
  const char* md5sum;  ///< empty: of ROS 2
  Kind kind;
};
constexpr MessageType kMessageTypes[] = {
    {"sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", Kind::kScan},
    {"sensor_msgs/MultiEchoLaserScan", "6fefb0c6da89d7c8abe4b339f5c2f8fb", Kind::kMultiEcho},
    {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7", Kind::kOdometry},
    {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", Kind::kTransforms},
    {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec", Kind::kTransforms},
    {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2", Kind::kImu},
    {"sensor_msgs/FluidPressure", "804dc5cea1c5306d6a2eb80b9833befe", Kind::kPressure},
    {"sensor_msgs/msg/LaserScan", "", Kind::kScan},
    {"sensor_msgs/msg/MultiEchoLaserScan", "", Kind::kMultiEcho},
    {"nav_msgs/msg/Odometry", "", Kind::kOdometry},
    {"tf2_msgs/msg/TFMessage", "", Kind::kTransforms},
    {"sensor_msgs/msg/Imu", "", Kind::kImu},
    {"sensor_msgs/msg/FluidPressure", "", Kind::kPressure},
};

std::optional<Kind> KindOf(const BagConnection& connection) {
  for (const MessageType& known : kMessageTypes) {
    if (connection.type == known.type && connection.md5sum == known.md5sum) return known.kind;
  }
  return std::nullopt;
}

/// A topic that is read; its place among `topics` is its stream.
struct Topic {
  std::string name;
  Kind kind = Kind::kScan;
  std::size_t scanner = 0;
};

/// What the look at a bag found out, and all that reading it needs to know.
struct BagPlan {
  std::vector<Topic> topics;
  std::size_t scanners = 0;
  bool has_odometry_topic = false;
  std::vector<PlanarMount> mounts;  ///< of the scanners
  std::string odometry_frame;       ///< of tf, when there is no Odometry; empty: none
  std::string robot_frame;
  Eigen::Matrix3d R_robot_imu = Eigen::Matrix3d::Identity();
  std::vector<std::optional<double>> clock_offsets;  ///< s, of topics: header minus recording
  double clock_offset = 0.0;                         ///< s, of the first scanner
  double max_range = 0.0;                            ///< m
  float no_return = 0.0F;                            ///< m; 0: each scan's own range_max
};

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
      all_.insert(connection.topic);
      const std::optional<Kind> kind = KindOf(connection);
      if (kind) kinds_.emplace(connection.topic, *kind);
    }
  }

  BagPlan Choose(const LogOptions& options) const {
    BagPlan plan;
    for (const std::string& name :
         Pick({Kind::kScan, Kind::kMultiEcho}, "scan", "log.scan_topic", options.scan_topic)) {
      plan.topics.push_back({name, kinds_.at(name), plan.scanners++});
    }
    if (plan.scanners == 0) {
      throw InputError(path_ + ": holds no sensor_msgs/LaserScan (topics: " +
                       (all_.empty() ? "none" : Listed({all_.begin(), all_.end()})) + ")");
    }
    AddOne({Kind::kOdometry}, "odometry", "log.odometry_topic", options.odometry_topic, &plan);
    plan.has_odometry_topic = plan.topics.size() > plan.scanners;
    AddOne({Kind::kImu}, "IMU", "log.imu_topic", options.imu_topic, &plan);
    AddOne({Kind::kPressure}, "pressure", "log.pressure_topic", options.pressure_topic, &plan);
    for (const auto& [name, kind] : kinds_) {
      if (kind == Kind::kTransforms) plan.topics.push_back({name, kind, 0});
    }
    plan.mounts.resize(plan.scanners);
    plan.clock_offsets.resize(plan.topics.size());
    return plan;
  }

 private:
  std::vector<std::string> Pick(const std::set<Kind>& wanted, const std::string& what,
                                const std::string& option, const std::string& given) const {
    std::vector<std::string> candidates;
    for (const auto& [name, kind] : kinds_) {
      if (wanted.count(kind) > 0) candidates.push_back(name);
    }
    if (given == "none") return {};
    if (!given.empty()) {
      std::vector<std::string> picked = SplitAtCommas(given);
      for (const std::string& name : picked) {
        if (std::find(candidates.begin(), candidates.end(), name) != candidates.end()) continue;
        throw InputError(path_ + ": " + option + ": no " + what + " topic `" + name + "`" +
                         DidYouMean(name, candidates) + "; the bag has " +
                         (candidates.empty() ? "none" : Listed(candidates)));
      }
      return picked;
    }
    if (candidates.size() > 1) {
      const bool may_be_merged = wanted.count(Kind::kScan) > 0;
      throw InputError(path_ + ": has several " + what + " topics (" + Listed(candidates) +
                       "); choose with " + option + "=" + candidates.front() +
                       (may_be_merged ? ", or several with commas to merge them" : ""));
    }
    return candidates;
  }

  void AddOne(const std::set<Kind>& wanted, const std::string& what, const std::string& option,
              const std::string& given, BagPlan* plan) const {
    const std::vector<std::string> picked = Pick(wanted, what, option, given);
    if (picked.size() > 1) throw InputError(path_ + ": " + option + ": takes one topic");
    if (!picked.empty()) plan->topics.push_back({picked.front(), kinds_.at(picked.front()), 0});
  }

  std::string path_;
  std::set<std::string> all_;
  std::map<std::string, Kind> kinds_;
};

/// The stream of a message's topic.
std::optional<std::size_t> StreamOf(const BagPlan& plan, const BagConnection& connection) {
  if (!KindOf(connection)) return std::nullopt;
  for (std::size_t i = 0; i < plan.topics.size(); ++i) {
    if (plan.topics[i].name == connection.topic) return i;
  }
  return std::nullopt;
}

/// StreamOf for every connection, so that messages need no names compared.
class Streams {
 public:
  Streams(const BagPlan& plan, const RosBag& bag) : plan_(plan), bag_(bag) {}

  std::optional<std::size_t> Find(std::uint32_t connection) {
    const auto known = streams_.find(connection);
    if (known != streams_.end()) return known->second;
    const auto stream = StreamOf(plan_, bag_.Connections().at(connection));
    streams_.emplace(connection, stream);
    return stream;
  }

 private:
  const BagPlan& plan_;
  const RosBag& bag_;
  std::map<std::uint32_t, std::optional<std::size_t>> streams_;
};

std::optional<RosLaserScan> ParseScan(Kind kind, const BagMessage& message, bool strongest_echo) {
  if (kind == Kind::kScan) return ParseLaserScan(message.data, message.size, message.encoding);
  return ParseMultiEchoLaserScan(message.data, message.size,
                                 strongest_echo ? EchoChoice::kStrongest : EchoChoice::kFirst,
                                 message.encoding);
}

bool IsLimit(double range_max) {
  return range_max >= kLeastLimit && range_max < RangeLimitFinder::kAbsurdRange;
}

/// Reads the beginning of a bag for frames, clocks and the limit of the ranges.
class BagLook {
 public:
  BagLook(const LogOptions& options, BagPlan plan)
      : options_(options), plan_(std::move(plan)), scan_frames_(plan_.scanners) {}

  BagPlan Run(const std::string& path, RosBag* bag) {
    Streams streams(plan_, *bag);
    std::optional<double> begin;
    while (const std::optional<BagMessage> message = bag->Next()) {
      if (!begin) begin = message->time;
      const std::optional<std::size_t> stream = streams.Find(message->connection);
      if (!stream) continue;
      Add(*stream, *message);
      const bool long_enough = message->time > *begin + kLongestLook;
      if (SawScans() && (long_enough || KnowsEverything())) break;
    }
    if (scans_ == 0) throw InputError(path + ": holds no scan that can be read");
    Conclude();
    return std::move(plan_);
  }

 private:
  void Add(std::size_t stream, const BagMessage& message) {
    const Topic& topic = plan_.topics[stream];
    switch (topic.kind) {
      case Kind::kScan:
      case Kind::kMultiEcho:
        if (const auto scan = ParseScan(topic.kind, message, options_.strongest_echo)) {
          NoteHeader(stream, message, scan->header);
          AddScan(topic.scanner, *scan);
        }
        break;
      case Kind::kOdometry:
        if (const auto odometry = ParseOdometry(message.data, message.size, message.encoding)) {
          NoteHeader(stream, message, odometry->header);
          if (!child_frame_) child_frame_ = odometry->child_frame_id;
        }
        break;
      case Kind::kTransforms:
        if (const auto transforms = ParseTransforms(message.data, message.size, message.encoding)) {
          for (const RosTransform& transform : *transforms) {
            frames_.Add(transform.header.frame_id, transform.child_frame_id,
                        transform.T_frame_child);
          }
        }
        break;
      case Kind::kImu:
        if (const auto imu = ParseImu(message.data, message.size, message.encoding)) {
          NoteHeader(stream, message, imu->header);
          imu_frame_ = imu->header.frame_id;
        }
        break;
      case Kind::kPressure:
        if (const auto pressure =
                ParseFluidPressure(message.data, message.size, message.encoding)) {
          NoteHeader(stream, message, pressure->header);
        }
        break;
    }
  }

  void NoteHeader(std::size_t stream, const BagMessage& message, const RosHeader& header) {
    std::optional<double>& offset = plan_.clock_offsets[stream];
    if (!offset && header.stamp > 0.0) offset = header.stamp - message.time;
  }

  void AddScan(std::size_t scanner, const RosLaserScan& scan) {
    ++scans_;
    if (!scan_frames_[scanner]) scan_frames_[scanner] = scan.header.frame_id;
    plan_.max_range = std::max(plan_.max_range, IsLimit(scan.range_max) ? scan.range_max : 0.0);
    limit_is_stated_ = limit_is_stated_ && IsLimit(scan.range_max);
    if (!limit_is_stated_) ranges_.Add(scan.ranges, scan.angle_increment, {});
  }

  bool SawScans() const {
    return std::all_of(scan_frames_.begin(), scan_frames_.end(),
                       [](const auto& frame) { return frame.has_value(); });
  }

  bool KnowsEverything() const {
    const bool has_tf =
        std::any_of(plan_.topics.begin(), plan_.topics.end(),
                    [](const Topic& topic) { return topic.kind == Kind::kTransforms; });
    if (plan_.has_odometry_topic && !child_frame_) return false;
    if (!limit_is_stated_ && scans_ < kScansForLimit) return false;
    for (std::size_t i = 0; i < plan_.topics.size(); ++i) {
      const Kind kind = plan_.topics[i].kind;
      if ((kind == Kind::kImu || kind == Kind::kPressure) && !plan_.clock_offsets[i]) return false;
    }
    if (!has_tf) return true;
    return std::all_of(scan_frames_.begin(), scan_frames_.end(), [this](const auto& frame) {
      return plan_.has_odometry_topic ? frames_.Find(*child_frame_, *frame).has_value()
                                      : OdometryChild(*frame).has_value();
    });
  }

  /// The frame that tf moves in `odom`, above a sensor's frame.
  std::optional<std::pair<std::string, std::string>> OdometryChild(const std::string& frame) const {
    const std::vector<std::string> chain = frames_.Ancestors(frame);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      if (LastPartOfFrame(chain[i]) == "odom") return std::make_pair(chain[i], chain[i - 1]);
    }
    return std::nullopt;
  }

  std::string RobotFrame() {
    const std::string& scan_frame = *scan_frames_.front();
    const std::vector<std::string> chain = frames_.Ancestors(scan_frame);
    if (plan_.has_odometry_topic) {
      if (child_frame_ && frames_.Find(*child_frame_, scan_frame)) return *child_frame_;
    } else if (const auto odometry = OdometryChild(scan_frame);
               odometry && options_.odometry_topic != "none") {
      plan_.odometry_frame = odometry->first;
      return odometry->second;
    }
    for (const char* usual : {"base_link", "base_footprint"}) {
      for (const std::string& frame : chain) {
        if (LastPartOfFrame(frame) == usual) return frame;
      }
    }
    return scan_frame;
  }

  void Conclude() {
    plan_.robot_frame = RobotFrame();
    for (std::size_t scanner = 0; scanner < plan_.scanners; ++scanner) {
      const auto T_robot_laser = frames_.Find(plan_.robot_frame, *scan_frames_[scanner]);
      if (T_robot_laser) plan_.mounts[scanner] = SeenFromAbove(*T_robot_laser);
    }
    const bool given =
        options_.laser_x != 0.0 || options_.laser_y != 0.0 || options_.laser_theta_deg != 0.0;
    if (given && plan_.scanners == 1) {
      plan_.mounts[0].T_robot_laser = {options_.laser_x, options_.laser_y,
                                       WrapAngle(DegToRad(options_.laser_theta_deg))};
    }
    if (const auto T_robot_imu = frames_.Find(plan_.robot_frame, imu_frame_)) {
      plan_.R_robot_imu = T_robot_imu->linear();
    }
    plan_.clock_offset = plan_.clock_offsets.front().value_or(0.0);
    SetLimit();
  }

  void SetLimit() {
    if (options_.max_range > 0.0) {
      plan_.max_range = options_.max_range;
      plan_.no_return = static_cast<float>(options_.max_range);
    } else if (!limit_is_stated_) {
      // Only the beginning was looked at: what is farther later is still a return.
      const std::optional<RangeLimitFinder::Finding> finding = ranges_.Find();
      constexpr double kFarEnough = 100.0;  // m
      plan_.max_range = finding && IsLimit(finding->far_value)
                            ? finding->far_value
                            : std::max<double>(kFarEnough, ranges_.Farthest());
      plan_.no_return = finding ? finding->no_return : static_cast<float>(plan_.max_range);
    }
  }

  const LogOptions& options_;
  BagPlan plan_;
  FrameTree frames_;
  std::vector<std::optional<std::string>> scan_frames_;
  std::optional<std::string> child_frame_;
  std::string imu_frame_;
  RangeLimitFinder ranges_;
  bool limit_is_stated_ = true;
  std::uint64_t scans_ = 0;
};

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

/// Messages in, observations in order out; the counting.
class MessageReader {
 public:
  MessageReader(const LogOptions& options, const BagPlan& plan, const RosBag& bag)
      : options_(options), plan_(plan), bag_(bag), streams_(plan, bag), in_order_(plan.scanners) {
    statistics_.max_range = plan.max_range;
  }

  void Add(const BagMessage& message) {
    ++statistics_.lines;
    const std::optional<std::size_t> stream = streams_.Find(message.connection);
    if (!stream) {
      CountOther(bag_.Connections().at(message.connection));
    } else if (!Take(*stream, message)) {
      if (statistics_.bad_lines++ == 0) {
        statistics_.first_bad_line = "message " + std::to_string(statistics_.lines) + " on " +
                                     plan_.topics[*stream].name + ": malformed";
      }
    }
  }

  void Finish() {
    mender_.Finish();
    finished_ = true;
  }

  std::optional<Observation> Next() {
    MoveOn();
    std::optional<Observation> observation = in_order_.Next();
    if (observation) Count(*observation);
    return observation;
  }

  LogStatistics Statistics() const {
    LogStatistics statistics = statistics_;
    statistics.stamp_jumps = mender_.jumps();
    statistics.reordered = mender_.reordered();
    statistics.truncated = bag_.Truncated();
    statistics.bad_lines += bag_.Damaged();
    if (statistics.first_bad_line.empty() && bag_.Damaged() > 0) {
      statistics.first_bad_line = "a chunk or record of the bag is damaged";
    }
    return statistics;
  }

 private:
  /// From the mender to the odometry to the order of what is handed out.
  void MoveOn() {
    while (std::optional<Observation> mended = mender_.Next()) {
      at_scans_.Add(std::move(*mended), mender_.last_stream());
    }
    if (finished_) at_scans_.Finish();
    while (auto next = at_scans_.Next()) {
      in_order_.Add(std::move(next->first), plan_.topics[next->second].scanner);
    }
    if (finished_) in_order_.Finish();
  }

  double StampOf(std::size_t stream, const BagMessage& message, const RosHeader& header) const {
    const double offset = plan_.clock_offsets[stream].value_or(plan_.clock_offset);
    const bool same_clock = std::abs(offset - plan_.clock_offset) <= kClocksApart;
    return header.stamp > 0.0 && same_clock ? header.stamp : message.time + plan_.clock_offset;
  }

  bool Take(std::size_t stream, const BagMessage& message) {
    const Topic& topic = plan_.topics[stream];
    switch (topic.kind) {
      case Kind::kScan:
      case Kind::kMultiEcho: {
        auto scan = ParseScan(topic.kind, message, options_.strongest_echo);
        if (!scan) return false;
        const double stamp = StampOf(stream, message, scan->header);
        mender_.Add(Convert(std::move(*scan), stamp, plan_.mounts[topic.scanner]), stream);
        return true;
      }
      case Kind::kOdometry: {
        const auto odometry = ParseOdometry(message.data, message.size, message.encoding);
        if (!odometry) return false;
        mender_.Add(OdometryReading{StampOf(stream, message, odometry->header),
                                    SeenFromAbove(odometry->T_frame_child).T_robot_laser},
                    stream);
        return true;
      }
      case Kind::kTransforms:
        return TakeTransforms(stream, message);
      case Kind::kImu: {
        const auto imu = ParseImu(message.data, message.size, message.encoding);
        if (!imu) return false;
        mender_.Add(AccelerationReading{StampOf(stream, message, imu->header),
                                        plan_.R_robot_imu * imu->acceleration},
                    stream);
        return true;
      }
      case Kind::kPressure: {
        const auto pressure = ParseFluidPressure(message.data, message.size, message.encoding);
        if (!pressure) return false;
        mender_.Add(
            PressureReading{StampOf(stream, message, pressure->header), pressure->pressure_pa},
            stream);
        return true;
      }
    }
    return false;
  }

  bool TakeTransforms(std::size_t stream, const BagMessage& message) {
    const auto transforms = ParseTransforms(message.data, message.size, message.encoding);
    if (!transforms) return false;
    if (plan_.odometry_frame.empty()) return true;
    for (const RosTransform& transform : *transforms) {
      if (transform.header.frame_id != plan_.odometry_frame ||
          transform.child_frame_id != plan_.robot_frame) {
        continue;
      }
      mender_.Add(OdometryReading{StampOf(stream, message, transform.header),
                                  SeenFromAbove(transform.T_frame_child).T_robot_laser},
                  stream);
    }
    return true;
  }

  LaserScan Convert(RosLaserScan ros_scan, double stamp, const PlanarMount& mount) {
    LaserScan scan;
    scan.stamp = stamp;
    scan.T_robot_laser = mount.T_robot_laser;
    const double sense = mount.upside_down != options_.upside_down ? -1.0 : 1.0;
    scan.first_angle = sense * ros_scan.angle_min;
    scan.angle_step = sense * ros_scan.angle_increment;
    const bool own_limit = plan_.no_return == 0.0F && IsLimit(ros_scan.range_max);
    scan.max_range = static_cast<float>(own_limit ? ros_scan.range_max : plan_.max_range);
    const float no_return = plan_.no_return > 0.0F ? plan_.no_return : scan.max_range;
    if (!options_.read_ranges) return scan;
    scan.ranges = std::move(ros_scan.ranges);
    const double least =
        ros_scan.range_min > options_.min_range && ros_scan.range_min < scan.max_range
            ? ros_scan.range_min
            : options_.min_range;
    const auto min_range = static_cast<float>(least);
    for (float& range : scan.ranges) {
      if (range >= min_range && range < no_return) continue;
      if (!(range >= 0.0F)) ++statistics_.invalid_ranges;
      range = range >= no_return ? kNoReturn : kInvalidRange;
    }
    return scan;
  }

  void Count(const Observation& observation) {
    const double stamp = Stamp(observation);
    if (!has_first_stamp_) statistics_.first_stamp = stamp;
    has_first_stamp_ = true;
    statistics_.last_stamp = stamp;
    if (std::holds_alternative<OdometryReading>(observation)) ++statistics_.odometry;
    if (std::holds_alternative<PressureReading>(observation)) ++statistics_.pressure;
    if (std::holds_alternative<AccelerationReading>(observation)) ++statistics_.acceleration;
    const auto* scan = std::get_if<LaserScan>(&observation);
    if (scan == nullptr) return;
    ++statistics_.scans;
    const auto is_hit = [scan](float range) { return range < scan->max_range; };
    if (options_.read_ranges && std::none_of(scan->ranges.begin(), scan->ranges.end(), is_hit)) {
      ++statistics_.empty_scans;
    }
  }

  void CountOther(const BagConnection& connection) {
    auto& others = statistics_.other_messages;
    const std::string name = connection.topic + " (" + connection.type + ")";
    const bool has_room = others.size() < kMostOtherTopics || others.count(name) > 0;
    ++others[has_room ? name : "(others)"];
  }

  const LogOptions& options_;
  const BagPlan& plan_;
  const RosBag& bag_;
  Streams streams_;
  StampMender mender_;
  OdometryAtScans at_scans_;
  InOrder in_order_;
  LogStatistics statistics_;
  bool has_first_stamp_ = false;
  bool finished_ = false;
};

std::unique_ptr<RosBag> OpenBag(const std::string& path) {
  if (Ros2BagFile::IsBag(path)) return std::make_unique<Ros2BagFile>(path);
  return std::make_unique<BagFile>(path);
}

void ReadBag(const std::string& path, const LogOptions& options, const BagPlan& plan,
             const ReadAhead::Sink& sink) {
  const std::unique_ptr<RosBag> bag = OpenBag(path);
  MessageReader reader(options, plan, *bag);
  ObservationBatch batch;
  std::size_t messages = 0;
  bool more = true;
  while (more) {
    const std::optional<BagMessage> message = bag->Next();
    more = message.has_value();
    if (message) reader.Add(*message);
    if (!more) reader.Finish();
    while (std::optional<Observation> observation = reader.Next()) {
      batch.observations.push_back(std::move(*observation));
    }
    const bool full = batch.observations.size() >= ObservationBatch::kSize ||
                      ++messages % (8 * ObservationBatch::kSize) == 0;
    if (!full && more) continue;
    batch.statistics = reader.Statistics();
    batch.progress = bag->Progress();
    if (!sink(std::exchange(batch, {}))) return;
  }
}

}  // namespace

std::unique_ptr<LogReader> OpenRosBag(const std::string& path, const LogOptions& options) {
  const std::unique_ptr<RosBag> bag = OpenBag(path);
  if (!bag->IsIndexed()) {
    while (bag->Next()) {
    }  // the connections are wherever they are
    bag->Rewind();
  }
  BagPlan plan = TopicChoice(path, bag->Connections()).Choose(options);
  plan = BagLook(options, std::move(plan)).Run(path, bag.get());
  LogStatistics statistics;
  statistics.max_range = plan.max_range;
  return std::make_unique<ReadAhead>(
      statistics,
      [path, options, plan](const ReadAhead::Sink& sink) { ReadBag(path, options, plan, sink); });
}

}  // namespace masked_mapper
