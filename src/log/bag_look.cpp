// SPDX-License-Identifier: BSD-3-Clause
#include "bag_look.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "masked_mapper/geometry/angle.hpp"
#include "masked_mapper/log/range_limit.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongestLook = 60.0;  // s of the bag, for frames that come late
constexpr std::size_t kScansForLimit = 300;

/// Reads the beginning of a bag for frames, clocks and the limit of the ranges.
class BagLook {
 public:
  BagLook(const LogOptions& options, BagPlan plan)
      : options_(options), plan_(std::move(plan)), scan_frames_(plan_.scanners) {}

  BagPlan Run(const std::string& path, RosBag* bag) {
    BagStreams streams(plan_, *bag);
    std::optional<double> begin;
    while (const std::optional<BagMessage> message = bag->Next()) {
      if (!begin) begin = message->time;
      const std::optional<std::size_t> stream = streams.Find(message->connection);
      if (!stream) continue;
      Add(*stream, *message);
      const bool long_enough = message->time > *begin + kLongestLook;
      if (SawScans() && (long_enough || KnowsEverything())) break;
    }
    CheckScanners(path);
    Conclude();
    return std::move(plan_);
  }

 private:
  void CheckScanners(const std::string& path) const {
    if (scans_ == 0) throw InputError(path + ": holds no scan that can be read");
    for (std::size_t i = 0; i < plan_.scanners; ++i) {
      if (scan_frames_[i]) continue;
      throw InputError(path + ": log.scan_topic: `" + plan_.topics[i].name +
                       "` holds no scan that can be read");
    }
  }

  void Add(std::size_t stream, const BagMessage& message) {
    const BagTopic& topic = plan_.topics[stream];
    switch (topic.kind) {
      case TopicKind::kScan:
      case TopicKind::kMultiEcho:
        if (const auto scan = ParseScan(topic.kind, message, options_)) {
          NoteHeader(stream, message, scan->header);
          AddScan(topic.scanner, *scan);
        }
        break;
      case TopicKind::kOdometry:
        if (const auto odometry = ParseOdometry(message.data, message.size, message.encoding)) {
          NoteHeader(stream, message, odometry->header);
          if (!child_frame_) child_frame_ = odometry->child_frame_id;
        }
        break;
      case TopicKind::kTransforms:
        if (const auto transforms = ParseTransforms(message.data, message.size, message.encoding)) {
          for (const RosTransform& transform : *transforms) {
            frames_.Add(transform.header.frame_id, transform.child_frame_id,
                        transform.T_frame_child);
          }
        }
        break;
      case TopicKind::kImu:
        if (const auto imu = ParseImu(message.data, message.size, message.encoding)) {
          NoteHeader(stream, message, imu->header);
          imu_frame_ = imu->header.frame_id;
        }
        break;
      case TopicKind::kPressure:
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
    plan_.max_range =
        std::max(plan_.max_range, IsRangeLimit(scan.range_max) ? scan.range_max : 0.0);
    limit_is_stated_ = limit_is_stated_ && IsRangeLimit(scan.range_max);
    if (!limit_is_stated_) ranges_.Add(scan.ranges, scan.angle_increment, {});
  }

  bool SawScans() const {
    return std::all_of(scan_frames_.begin(), scan_frames_.end(),
                       [](const auto& frame) { return frame.has_value(); });
  }

  bool KnowsEverything() const {
    const bool has_tf =
        std::any_of(plan_.topics.begin(), plan_.topics.end(),
                    [](const BagTopic& topic) { return topic.kind == TopicKind::kTransforms; });
    if (plan_.has_odometry_topic && !child_frame_) return false;
    if (!limit_is_stated_ && scans_ < kScansForLimit) return false;
    for (std::size_t i = 0; i < plan_.topics.size(); ++i) {
      const TopicKind kind = plan_.topics[i].kind;
      if ((kind == TopicKind::kImu || kind == TopicKind::kPressure) && !plan_.clock_offsets[i])
        return false;
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
      plan_.max_range = finding && IsRangeLimit(finding->far_value)
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

}  // namespace

BagPlan LookAtBag(const std::string& path, const LogOptions& options, BagPlan plan, RosBag* bag) {
  return BagLook(options, std::move(plan)).Run(path, bag);
}

}  // namespace masked_mapper
