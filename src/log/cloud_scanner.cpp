// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_scanner.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/log/packed_cloud.hpp"
#include "virtual_scan.hpp"

namespace masked_mapper {
namespace {

constexpr double kRemembered = 3.0;      // s
constexpr double kSilent = 1.0;          // s without odometry: nobody knows how the robot went on
constexpr double kGravitySettles = 2.0;  // s; a robot brakes in less

// From one cloud that is kept to the next: as far as an octree takes them.
constexpr double kTravelToNext = 0.3;     // m
constexpr double kTurnToNext_deg = 20.0;  // or so much of a turn
constexpr double kTimeToNext = 0.5;       // s, or, where no wheels tell either, so long

}  // namespace

void RobotMotion::Add(const OdometryReading& reading) {
  // A clock that was set back begins anew.
  if (!odometry_.empty() && reading.stamp < odometry_.back().first - kRemembered) odometry_.clear();
  if (!odometry_.empty() && reading.stamp <= odometry_.back().first) return;
  odometry_.emplace_back(reading.stamp, reading.T_odom_robot);
  while (odometry_.size() > 2 && odometry_.front().first < reading.stamp - kRemembered) {
    odometry_.pop_front();
  }
}

void RobotMotion::Add(const AccelerationReading& reading) {
  const Eigen::Vector3d& force = reading.acceleration_in_robot;
  if (!(force.norm() > 1.0)) return;  // in free fall nothing is up
  const double since = gravity_ ? reading.stamp - gravity_->first : kGravitySettles;
  const double share = since > 0.0 ? std::min(1.0, since / kGravitySettles) : 0.0;
  const Eigen::Vector3d before = gravity_ ? gravity_->second : force;
  gravity_ = {{reading.stamp, before + share * (force - before)}};
}

Pose2 RobotMotion::At(double stamp) const {
  const auto after = std::lower_bound(
      odometry_.begin() + 1, odometry_.end() - 1, stamp,
      [](const std::pair<double, Pose2>& reading, double t) { return reading.first < t; });
  const auto before = after - 1;
  return Interpolate(before->second, after->second,
                     (stamp - before->first) / (after->first - before->first));
}

bool RobotMotion::Tells(double from, double to) const {
  return odometry_.size() >= 2 && std::min(from, to) >= odometry_.front().first - kSilent &&
         std::max(from, to) <= odometry_.back().first + kSilent;
}

Pose2 RobotMotion::Between(double from, double to) const {
  if (!Tells(from, to)) return {};
  return masked_mapper::Between(At(from), At(to));
}

std::optional<Eigen::Vector3d> RobotMotion::Up() const {
  if (!gravity_ || !(gravity_->second.norm() > 1.0)) return std::nullopt;
  const Eigen::Vector3d up = gravity_->second.normalized();
  // Of a robot that lies on its side, or an accelerometer whose mount nobody told.
  constexpr double kUpright = 0.7;
  if (up.z() < kUpright) return std::nullopt;
  return up;
}

bool KeptPlaces::IsNext(double stamp, const RobotMotion& motion) {
  const bool is_first = !stamp_;
  const bool is_told = stamp_ && motion.Tells(*stamp_, stamp);
  if (is_told) since_kept_ = since_kept_ * motion.Between(*stamp_, stamp);
  stamp_ = stamp;
  const bool went_on = std::hypot(since_kept_.x, since_kept_.y) >= kTravelToNext ||
                       std::abs(since_kept_.theta) >= DegToRad(kTurnToNext_deg);
  const bool may_have = !is_told && std::abs(stamp - kept_at_) >= kTimeToNext;
  if (!is_first && !went_on && !may_have) return false;
  kept_at_ = stamp;
  since_kept_ = Pose2{};
  return true;
}

CloudScanner::CloudScanner(const LogOptions& options, const Eigen::Isometry3d& T_robot_lidar,
                           float max_range)
    : options_(options), T_robot_lidar_(T_robot_lidar), max_range_(max_range) {}

LevelledCloud CloudScanner::Level(RosPointCloud cloud, double stamp, const RobotMotion& motion) {
  CloudPoints& points = cloud.points;
  const auto too_near = [this](const CloudPoint& point) {
    return !(point.position.norm() >= static_cast<float>(options_.min_range));
  };
  points.erase(std::remove_if(points.begin(), points.end(), too_near), points.end());
  Move(T_robot_lidar_, &points);
  if (cloud.has_times) {
    Straighten([&](double after) { return motion.Between(stamp, stamp + after); }, &points);
  }
  const Eigen::Vector3d lidar = T_robot_lidar_.translation();
  ground_ = finder_.Find(points, lidar, motion.Up());
  const Eigen::Isometry3d T_level_robot = ground_.T_level_robot();
  Move(T_level_robot, &points);
  LevelledCloud levelled;
  levelled.log_stamp = cloud.header.stamp > 0.0 ? cloud.header.stamp : stamp;
  if (ground_.ceiling_m) levelled.ceiling_m = *ground_.ceiling_m - ground_.floor_m;
  levelled.points = std::move(points);
  levelled.lidar = T_level_robot * lidar;
  return levelled;
}

LaserScan CloudScanner::Cut(RosPointCloud cloud, double stamp, const RobotMotion& motion,
                            std::vector<StampedCloud>* keep) {
  const LevelledCloud levelled = Level(std::move(cloud), stamp, motion);
  const WallBand band = BandBetween(ground_, levelled.lidar.z(), {});
  LaserScan scan = CutToScan(levelled.points, levelled.lidar, band, max_range_);
  scan.stamp = stamp;
  scan.log_stamp = levelled.log_stamp;
  if (!options_.read_ranges) scan.ranges.clear();
  if (keep != nullptr && places_.IsNext(stamp, motion)) {
    keep->push_back({levelled.log_stamp, std::make_shared<const std::string>(PackCloud(levelled))});
  }
  return scan;
}

}  // namespace masked_mapper
