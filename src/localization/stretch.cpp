// SPDX-License-Identifier: BSD-3-Clause
#include "stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {
namespace {

constexpr double kViewEvery = 0.5;  // m
constexpr double kViewEveryDeg = 20.0;
constexpr double kKept = 30.0;        // m of the way
constexpr double kCell = 0.3;         // m, of the lattice on which each thing seen counts once
constexpr double kPatch = 1.0;        // m
constexpr double kFarthest = 15.0;    // m; beyond it a small turn is a long way
constexpr double kBeamEvery = 0.035;  // rad, of those that tell of free space
constexpr std::size_t kMostCells = 2'000'000;

std::int64_t Key(double x, double y, double cell_m) {
  const auto column = static_cast<std::int64_t>(std::floor(x / cell_m));
  const auto row = static_cast<std::int64_t>(std::floor(y / cell_m));
  return column * (std::int64_t{1} << 32) + row;
}

std::int64_t Key(const Eigen::Vector2d& point, double cell_m) {
  return Key(point.x(), point.y(), cell_m);
}

constexpr std::size_t kLeastHits = 3;  // of a patch
constexpr std::size_t kLeastFree = 6;

}  // namespace

std::vector<Patch> HitsOf(const LaserScan& scan, const Pose2& T_odom_robot) {
  std::unordered_set<std::int64_t> cells;
  std::map<std::int64_t, Patch> patches;
  const ScanPoints::ConstPtr points_in_robot = PointsInRobot(scan);
  const PointTransform to_odom(T_odom_robot);
  for (const pcl::PointXY& point : *points_in_robot) {
    if (std::hypot(point.x, point.y) > kFarthest) continue;
    const Eigen::Vector2d in_odom = to_odom * Eigen::Vector2d(point.x, point.y);
    if (!cells.insert(Key(in_odom, kCell)).second) continue;
    patches[Key(in_odom, kPatch)].points_in_odom.push_back(in_odom);
  }
  std::vector<Patch> hits;
  for (auto& [key, patch] : patches) {
    if (patch.points_in_odom.size() >= kLeastHits) hits.push_back(std::move(patch));
  }
  return hits;
}

void Stretch::Restart() { *this = Stretch(); }

void Stretch::Add(const LaserScan& scan, const Pose2& T_odom_robot) {
  if (!views_.empty()) {
    length_m_ += Distance(T_odom_last_, T_odom_robot);
    T_odom_last_ = T_odom_robot;
    const Pose2& before = views_.back().T_odom_robot;
    if (Distance(before, T_odom_robot) < kViewEvery &&
        std::abs(WrapAngle(before.theta - T_odom_robot.theta)) < DegToRad(kViewEveryDeg)) {
      return;
    }
  }
  T_odom_last_ = T_odom_robot_ = T_odom_robot;
  views_.push_back({T_odom_robot, length_m_, PointsInRobot(scan)});
  while (views_.front().at_m < length_m_ - kKept) views_.pop_front();
  if (hit_cells_.size() + free_cells_.size() > kMostCells) {
    hit_cells_.clear();
    free_cells_.clear();
  }
  const PointTransform to_odom(T_odom_robot);
  for (const pcl::PointXY& point : *views_.back().points_in_robot) {
    if (std::hypot(point.x, point.y) > kFarthest) continue;
    const Eigen::Vector2d in_odom = to_odom * Eigen::Vector2d(point.x, point.y);
    if (hit_cells_.insert(Key(in_odom, kCell)).second) new_hits_in_odom_.push_back(in_odom);
  }
  SeeFree(scan, T_odom_robot);
}

// A beam went through, well before where it ended.
void Stretch::SeeFree(const LaserScan& scan, const Pose2& T_odom_robot) {
  constexpr double kBeforeTheEnd = 0.5;  // m
  const PointTransform to_odom(T_odom_robot * scan.T_robot_laser);
  const auto step = std::max<std::size_t>(
      1, static_cast<std::size_t>(kBeamEvery / std::max(1e-6, std::abs(scan.angle_step))));
  for (std::size_t beam = 0; beam < scan.size(); beam += step) {
    if (!scan.IsHit(beam)) continue;
    const double end = std::min<double>(scan.ranges[beam] - kBeforeTheEnd, kFarthest);
    const double angle = scan.Angle(beam);
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    for (double range = kCell; range < end; range += kCell) {
      const Eigen::Vector2d in_odom = to_odom * Eigen::Vector2d(range * direction);
      if (free_cells_.insert(Key(in_odom, kCell)).second) new_free_in_odom_.push_back(in_odom);
    }
  }
}

bool Stretch::IsAtSomething(const Eigen::Vector2d& point_in_odom) const {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const Eigen::Vector2d near = point_in_odom + kCell * Eigen::Vector2d(column, row);
      if (hit_cells_.count(Key(near, kCell)) != 0) return true;
    }
  }
  return false;
}

// What is too little for a patch waits for more of the same square metre.
std::vector<Patch> Stretch::TakePatches() {
  std::vector<Patch> taken;
  for (const bool is_free : {false, true}) {
    std::vector<Eigen::Vector2d>& points = is_free ? new_free_in_odom_ : new_hits_in_odom_;
    std::map<std::int64_t, Patch> patches;
    for (const Eigen::Vector2d& point : points) {
      // A pose a little off must not make a wall of free space beside one.
      if (is_free && IsAtSomething(point)) continue;
      patches[Key(point, kPatch)].points_in_odom.push_back(point);
    }
    points.clear();
    for (auto& [key, patch] : patches) {
      patch.is_free = is_free;
      if (patch.points_in_odom.size() >= (is_free ? kLeastFree : kLeastHits)) {
        taken.push_back(std::move(patch));
      } else {
        points.insert(points.end(), patch.points_in_odom.begin(), patch.points_in_odom.end());
      }
    }
  }
  return taken;
}

ScanPoints::Ptr Stretch::Points(double travel_m) const {
  ScanPoints::Ptr points(new ScanPoints);
  for (const View& view : views_) {
    if (view.at_m < length_m_ - travel_m) continue;
    AppendTransformed(*view.points_in_robot, Between(T_odom_robot_, view.T_odom_robot),
                      std::numeric_limits<double>::infinity(), *points);
  }
  return points;
}

}  // namespace masked_mapper
