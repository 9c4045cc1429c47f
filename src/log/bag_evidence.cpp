// SPDX-License-Identifier: BSD-3-Clause
#include "bag_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "bag_findings.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kScansForLimit = 300;
constexpr std::size_t kScansForClock = 50;
constexpr std::size_t kMostFrames = 16;  // of one topic
constexpr double kOutOfOrder = 5.0;      // s; what comes less late is put in order in passing
constexpr double kLeastReach = 10.0;     // m, of a 3D lidar that stands in a closet
constexpr double kBeyondFarthest = 1.1;  // how far it sees at most, of what it saw at first
constexpr double kTravels = 0.3;         // m, of a link that odometry moves

/// Frames above odometry's: what moves in them is put right by a map, and jumps.
bool IsGlobalFrame(const std::string& frame) {
  static const std::set<std::string> global = {"map", "world", "earth"};
  return global.count(LastPartOfFrame(frame)) > 0;
}

}  // namespace

BagEvidence::BagEvidence(const LogOptions& options, const BagPlan& topics)
    : options_(options),
      topics_(topics),
      clocks_(topics.topics.size()),
      scanners_(topics.scanners),
      scan_clocks_(topics.scanners) {}

void BagEvidence::Note(std::size_t stream, double time, double header) {
  clocks_[stream].Add(header, time);
  if (!has_time_) first_time_ = newest_time_ = time;
  has_time_ = true;
  is_disordered_ = is_disordered_ || time < newest_time_ - kOutOfOrder;
  newest_time_ = std::max(newest_time_, time);
  first_time_ = std::min(first_time_, time);
}

ScannerEvidence* BagEvidence::NoteScanner(std::size_t stream, double time,
                                          const RosHeader& header) {
  Note(stream, time, header.stamp);
  ++scans_;
  const std::size_t scanner = topics_.topics[stream].scanner;
  auto& frames = scanners_[scanner];
  if (frames.size() >= kMostFrames && frames.count(header.frame_id) == 0) return nullptr;
  scan_clocks_[scanner][header.frame_id].Add(header.stamp, time);
  return &frames[header.frame_id];
}

void BagEvidence::Add(std::size_t stream, double time, const RosLaserScan& scan) {
  if (ScannerEvidence* const frame = NoteScanner(stream, time, scan.header)) {
    frame->Add(scan, options_.min_range);
  }
  if (IsRangeLimit(scan.range_max)) {
    max_range_ = std::max(max_range_, scan.range_max);
  } else {
    limit_is_stated_ = false;
  }
  if (!limit_is_stated_) ranges_.Add(scan.ranges, scan.angle_increment, {});
}

void BagEvidence::Add(std::size_t stream, double time, const RosPointCloud& cloud) {
  float least = std::numeric_limits<float>::infinity();  // m^2
  float most = 0.0F;
  for (const CloudPoint& point : cloud.points) {
    const float square = point.position.squaredNorm();
    least = std::min(least, square);
    most = std::max(most, square);
  }
  const double nearest = std::sqrt(least);
  const double farthest = std::max<double>(kLeastReach, std::sqrt(most));
  if (ScannerEvidence* const frame = NoteScanner(stream, time, cloud.header)) {
    frame->AddCloud(cloud.points.size(), nearest);
  }
  max_range_ = std::max(max_range_, kBeyondFarthest * farthest);
}

void BagEvidence::Add(std::size_t stream, double time, const RosOdometry& odometry) {
  Note(stream, time, odometry.header.stamp);
  if (!child_frame_) child_frame_ = odometry.child_frame_id;
}

void BagEvidence::Add(std::size_t stream, double time,
                      const std::vector<RosTransform>& transforms) {
  // One topic holds the transforms of many sources, each with a clock of its own.
  Note(stream, time, 0.0);
  for (const RosTransform& transform : transforms) {
    frames_.Add(transform.header.frame_id, transform.child_frame_id, transform.T_frame_child);
  }
}

void BagEvidence::Add(std::size_t stream, double time, const RosImu& imu) {
  Note(stream, time, imu.header.stamp);
  imu_frame_ = imu.header.frame_id;
}

void BagEvidence::Add(std::size_t stream, double time, const RosFluidPressure& pressure) {
  Note(stream, time, pressure.header.stamp);
}

std::optional<std::size_t> BagEvidence::SilentScanner() const {
  for (std::size_t scanner = 0; scanner < scanners_.size(); ++scanner) {
    if (scanners_[scanner].empty()) return scanner;
  }
  return std::nullopt;
}

bool BagEvidence::IsEnough() const {
  if (SilentScanner()) return false;
  if (topics_.has_odometry_topic && !child_frame_) return false;
  if (scans_ < (limit_is_stated_ ? kScansForClock : kScansForLimit)) return false;
  bool has_tf = false;
  for (std::size_t i = 0; i < topics_.topics.size(); ++i) {
    const TopicKind kind = topics_.topics[i].kind;
    has_tf = has_tf || kind == TopicKind::kTransforms;
    if ((kind == TopicKind::kImu || kind == TopicKind::kPressure) && clocks_[i].IsEmpty()) {
      return false;
    }
  }
  if (!has_tf) return true;
  for (std::size_t scanner = 0; scanner < scanners_.size(); ++scanner) {
    const std::string frame = FrameOf(scanner);
    const bool hangs = topics_.has_odometry_topic ? frames_.Find(*child_frame_, frame).has_value()
                                                  : OdometryLink(frame).has_value();
    if (!hangs) return false;
  }
  return true;
}

std::string BagEvidence::FrameOf(std::size_t scanner) const {
  const auto& frames = scanners_[scanner];
  const auto better = [](const auto& a, const auto& b) {
    return std::make_pair(a.second.HasReturns(), a.second.scans()) <
           std::make_pair(b.second.HasReturns(), b.second.scans());
  };
  return std::max_element(frames.begin(), frames.end(), better)->first;
}

const ScannerEvidence& BagEvidence::EvidenceOf(std::size_t scanner) const {
  return scanners_[scanner].at(FrameOf(scanner));
}

const ClockEvidence& BagEvidence::ClockOf(std::size_t stream) const {
  return stream < scanners_.size() ? scan_clocks_[stream].at(FrameOf(stream)) : clocks_[stream];
}

/// Parent and child of the link above a frame that odometry moves: the one that the user names,
/// else the one of that name, else the lowest that travels.
std::optional<std::pair<std::string, std::string>> BagEvidence::OdometryLink(
    const std::string& frame) const {
  const std::vector<std::string> chain = frames_.Ancestors(frame);
  if (const std::string& given = options_.odom_frame; !given.empty()) {
    for (std::size_t i = 1; i < chain.size(); ++i) {
      if (chain[i] == given || LastPartOfFrame(chain[i]) == given) {
        return std::make_pair(chain[i], chain[i - 1]);
      }
    }
    return std::nullopt;
  }
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (LastPartOfFrame(chain[i]) == "odom") return std::make_pair(chain[i], chain[i - 1]);
  }
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (frames_.Travel(chain[i - 1]) < kTravels) continue;
    if (IsGlobalFrame(chain[i])) return std::nullopt;
    return std::make_pair(chain[i], chain[i - 1]);
  }
  return std::nullopt;
}

std::string BagEvidence::MissingOdometryFrame() const {
  const std::string frame = FrameOf(0);
  if (options_.odom_frame.empty() || topics_.has_odometry_topic || OdometryLink(frame)) return "";
  std::string above;
  for (const std::string& ancestor : frames_.Ancestors(frame)) {
    if (ancestor != frame) above += (above.empty() ? "" : ", ") + ancestor;
  }
  return "log.odom_frame: tf has no frame `" + options_.odom_frame + "` above `" + frame +
         "`; it has " + (above.empty() ? "none" : above);
}

std::string BagEvidence::RobotFrame(const std::string& scan_frame, BagPlan* plan) const {
  if (plan->has_odometry_topic) {
    if (child_frame_ && frames_.Find(*child_frame_, scan_frame)) return *child_frame_;
  } else if (const auto link = OdometryLink(scan_frame);
             link && options_.odometry_topic != "none") {
    plan->odometry_frame = link->first;
    return link->second;
  }
  const std::vector<std::string> chain = frames_.Ancestors(scan_frame);
  for (const char* usual : {"base_link", "base_footprint"}) {
    for (const std::string& frame : chain) {
      if (LastPartOfFrame(frame) == usual) return frame;
    }
  }
  return scan_frame;
}

BagPlan BagEvidence::Conclude() const {
  BagPlan plan = topics_;
  for (std::size_t i = 0; i < clocks_.size(); ++i) plan.clocks[i] = ClockOf(i).Find();
  plan.clock_offset = plan.clocks.front().offset.value_or(0.0);
  for (std::size_t scanner = 0; scanner < plan.scanners; ++scanner) {
    if (scanners_[scanner].size() > 1) plan.topics[scanner].frame = FrameOf(scanner);
    plan.ranges[scanner] = EvidenceOf(scanner).Find();
  }
  plan.is_disordered = is_disordered_;
  plan.robot_frame = RobotFrame(FrameOf(0), &plan);
  SetMounts(&plan);
  SetLimit(&plan);
  return plan;
}

void BagEvidence::SetMounts(BagPlan* plan) const {
  for (std::size_t scanner = 0; scanner < plan->scanners; ++scanner) {
    const auto T_robot_laser = frames_.Find(plan->robot_frame, FrameOf(scanner));
    if (!T_robot_laser) continue;
    plan->mounts[scanner] = SeenFromAbove(*T_robot_laser);
    plan->T_robot_lidar[scanner] = *T_robot_laser;
  }
  const bool given =
      options_.laser_x != 0.0 || options_.laser_y != 0.0 || options_.laser_theta_deg != 0.0;
  if (given && plan->scanners == 1) {
    plan->mounts[0].T_robot_laser = {options_.laser_x, options_.laser_y,
                                     WrapAngle(DegToRad(options_.laser_theta_deg))};
    Eigen::Isometry3d& T_robot_lidar = plan->T_robot_lidar[0];
    const double turn =
        plan->mounts[0].T_robot_laser.theta - SeenFromAbove(T_robot_lidar).T_robot_laser.theta;
    T_robot_lidar.linear() =
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * T_robot_lidar.linear();
    T_robot_lidar.translation().head<2>() = plan->mounts[0].T_robot_laser.Translation();
  }
  if (options_.upside_down) {
    for (Eigen::Isometry3d& T_robot_lidar : plan->T_robot_lidar) {
      T_robot_lidar.rotate(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
    }
  }
  if (const auto T_robot_imu = frames_.Find(plan->robot_frame, imu_frame_)) {
    plan->R_robot_imu = T_robot_imu->linear();
  }
}

void BagEvidence::SetLimit(BagPlan* plan) const {
  plan->max_range = max_range_;
  if (options_.max_range > 0.0) {
    plan->max_range = options_.max_range;
    plan->no_return = static_cast<float>(options_.max_range);
  } else if (!limit_is_stated_) {
    // Only the beginning was looked at: what is farther later is still a return.
    const std::optional<RangeLimitFinder::Finding> finding = ranges_.Find();
    constexpr double kFarEnough = 100.0;  // m
    plan->max_range = finding && IsRangeLimit(finding->far_value)
                          ? finding->far_value
                          : std::max<double>(kFarEnough, ranges_.Farthest());
    plan->no_return = finding ? finding->no_return : static_cast<float>(plan->max_range);
    const double scale = plan->ranges.front().scale;
    if (scale == 1.0) return;
    plan->max_range = kFarEnough;
    plan->no_return = static_cast<float>(kFarEnough);
  }
}

std::vector<SensorFinding> BagEvidence::Findings(const BagPlan& plan) const {
  BagFindings findings(plan, first_time_, newest_time_);
  for (std::size_t i = 0; i < plan.topics.size(); ++i) findings.AddClock(i, ClockOf(i));
  for (std::size_t scanner = 0; scanner < plan.scanners; ++scanner) {
    findings.AddScanner(scanner, FrameOf(scanner), scanners_[scanner]);
  }
  return findings.Take();
}

}  // namespace masked_mapper
