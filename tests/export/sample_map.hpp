// SPDX-License-Identifier: BSD-3-Clause
// A small finished map of two floors, a folder to write it into, and the plainest of readers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// A folder of its own for one test, gone with it.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "masked_mapper_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string ReadBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

inline std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Files below a folder, as relative paths.
inline std::vector<std::string> FilesBelow(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A full sweep in a square room of 6 m, from its middle.
inline LaserScan ScanOfRoom(double stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.first_angle = -kPi;
  scan.angle_step = DegToRad(1.0);
  scan.max_range = 30.0F;
  for (int beam = 0; beam < 360; ++beam) {
    const double angle = scan.Angle(static_cast<std::size_t>(beam));
    const double across = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    scan.ranges.push_back(static_cast<float>(2.98 / across));
  }
  return scan;
}

/// Ground floor "0", then floor "-1" below it; one ride between them, one closure above.
inline BuildingMap SampleMap() {
  BuildingMap map;
  map.graph.AddFloor({"0", 0.0, 0.0, true});
  map.graph.AddFloor({"-1", -3.5, 0.2, false});
  const Pose2 poses[] = {{0.0, 0.0, 0.0}, {2.0, 0.1, 3.0}, {0.5, 0.5, -3.0}, {0.5, 0.5, 1.0}};
  for (int i = 0; i < 4; ++i) {
    Node node;
    node.stamp = 1000000000.25 + 10.0 * i;
    node.floor = i == 3 ? 1 : 0;
    node.T_odom_robot = poses[i];
    node.T_world_robot = poses[i];
    if (i != 2) node.scan = 2 * i;
    map.graph.AddNode(node);
  }
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  covariance(0, 2) = covariance(2, 0) = 0.002;
  for (int i = 0; i < 3; ++i) {
    map.graph.AddEdge({i,
                       i + 1,
                       {Between(poses[i], poses[i + 1]), covariance},
                       i == 2 ? EdgeKind::kFloorChange : EdgeKind::kOdometry});
  }
  map.graph.AddEdge({0, 1, {Between(poses[0], poses[1]), covariance}, EdgeKind::kClosure, 0});

  for (int i = 0; i < 8; ++i) {
    TrajectoryPose pose;
    pose.stamp = 1000000000.25 + 5.0 * i;
    pose.floor = i >= 6 ? 1 : 0;
    pose.in_transit = i == 5;
    pose.node_before = i / 2;
    pose.T_world_robot = poses[i / 2];
    pose.T_odom_robot = poses[i / 2];
    pose.log_stamp = pose.stamp;
    map.trajectory.push_back(pose);
    map.kept_scans.push_back({static_cast<std::size_t>(i), ScanOfRoom(pose.stamp)});
  }
  const auto closure = [&](ClosureState state, ClosureReason reason) {
    map.closures.push_back(
        {0, 1, {Between(poses[0], poses[1]), covariance}, state, reason, 0.625, 1.5, 0.0, 6});
  };
  closure(ClosureState::kValidated, ClosureReason::kEnoughVotes);
  closure(ClosureState::kHypothesis, ClosureReason::kTooFewVotes);
  closure(ClosureState::kRejectedScore, ClosureReason::kBelowMinScore);
  closure(ClosureState::kRejectedScore, ClosureReason::kBelowMinScore);
  closure(ClosureState::kAuditedOut, ClosureReason::kDisagreesWithTheMap);
  map.log.scans = 8;
  map.log.odometry = 20;
  map.log.pressure = 3;
  map.seconds.read = 0.5;
  map.seconds.total = 1.25;
  map.warnings = {"2 lines were skipped"};
  return map;
}

}  // namespace masked_mapper
