// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// Two poses a metre apart on the second of two floors, the later turned to the left; one between.
BuildingMap Map() {
  BuildingMap map;
  Floor floor;
  floor.label = "0";
  map.graph.AddFloor(floor);
  floor.label = "1";
  floor.elevation = 3.5;
  const FloorId upper = map.graph.AddFloor(floor);
  const auto add = [&](double stamp, const Pose2& pose, bool in_transit) {
    TrajectoryPose added;
    added.stamp = added.log_stamp = stamp;
    added.floor = upper;
    added.in_transit = in_transit;
    added.T_world_robot = pose;
    map.trajectory.push_back(added);
  };
  add(10.0, {0.0, 0.0, 0.0}, false);
  add(10.5, {0.5, 0.0, 0.0}, true);
  add(11.0, {1.0, 0.0, kPi / 2.0}, false);
  return map;
}

LevelledCloud CloudAt(double stamp) {
  LevelledCloud cloud;
  cloud.log_stamp = stamp;
  CloudPoint point;
  point.position = {2.02F, 0.02F, 0.52F};
  point.intensity = 7.0F;
  cloud.points.assign(3, point);
  point.position = {500.0F, 0.0F, 0.0F};
  cloud.points.push_back(point);
  return cloud;
}

std::string Ply(const SpaceExport& space, const SpaceOccupancy* seen_through = nullptr) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("masked_mapper_space_" + std::to_string(::getpid()) + ".ply");
  space.Write(SpaceFormat::kPly, path, seen_through);
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  std::filesystem::remove(path);
  return bytes.str();
}

TEST(SpaceExportTest, CloudsStandAtTheirPosesAndElevations) {
  const BuildingMap map = Map();
  SpaceExport space(map, {});
  for (const double stamp : {10.0, 10.5, 11.0, 12.0}) space.Add(CloudAt(stamp));
  EXPECT_EQ(space.clouds().taken, 2U);    // not the one between floors
  EXPECT_EQ(space.clouds().unknown, 1U);  // of a stamp that the map has not
  EXPECT_EQ(space.voxels(), 2U);          // what is too far is left out
  const std::string ply = Ply(space);
  EXPECT_NE(ply.find("element vertex 2\n"), std::string::npos);
  const std::size_t begin = ply.find("end_header\n") + 11;
  constexpr std::size_t kPoint = 12 + 3 + 4 + 4;
  ASSERT_EQ(ply.size(), begin + 2 * kPoint);
  std::array<float, 3> p{};
  std::memcpy(p.data(), ply.data() + begin, sizeof(p));
  EXPECT_NEAR(p[0], 2.02, 1e-4);
  EXPECT_NEAR(p[1], 0.02, 1e-4);
  EXPECT_NEAR(p[2], 3.5 + 0.52, 1e-4);
  std::memcpy(p.data(), ply.data() + begin + kPoint, sizeof(p));
  EXPECT_NEAR(p[0], 1.0 - 0.02, 1e-4);
  EXPECT_NEAR(p[1], 2.02, 1e-4);
}

TEST(SpaceExportTest, WhoWalkedByIsCarvedAwayByTheRaysToTheWallBehind) {
  BuildingMap map;
  map.graph.AddFloor({});
  for (int i = 0; i < 12; ++i) {
    TrajectoryPose pose;
    pose.stamp = pose.log_stamp = 1.0 + i;
    pose.T_world_robot = {0.4 * i, 0.0, 0.0};
    map.trajectory.push_back(pose);
  }
  SpaceExport points(map, {});
  SpaceOccupancyOptions options;
  options.votes.resolution_m = 0.1;
  SpaceOccupancy rays(map, options);
  // A wall at y = 3; while the robot is at its first place somebody stands before it at y = 1.5.
  for (int i = 0; i < 12; ++i) {
    LevelledCloud cloud;
    cloud.log_stamp = 1.0 + i;
    cloud.lidar = {0.0, 0.0, 1.0};
    for (float x = -4.0F; x <= 6.0F; x += 0.02F) {
      for (float z = 0.5F; z <= 1.6F; z += 0.05F) {
        CloudPoint point;
        point.position = {x - 0.4F * static_cast<float>(i), 3.0F, z};
        const float half_way = 0.5F * point.position.x();
        const bool is_hidden = i == 0 && std::abs(half_way) < 0.2F;
        if (is_hidden) point.position = {half_way, 1.5F, 1.0F + 0.5F * (z - 1.0F)};
        cloud.points.push_back(point);
      }
    }
    points.Add(cloud);
    rays.Add(cloud);
  }
  EXPECT_FALSE(rays.Finish());
  EXPECT_EQ(rays.At(0, {0.05, 1.52, 1.05}), Cell::kFree);
  EXPECT_EQ(rays.At(0, {0.05, 3.02, 1.05}), Cell::kOccupied);
  EXPECT_EQ(rays.At(0, {0.05, 1e9, 1.05}), Cell::kUnknown);
  const auto count_at = [](const std::string& ply, bool is_wall) {
    std::size_t count = 0;
    for (std::size_t at = ply.find("end_header\n") + 11; at < ply.size(); at += 12 + 3 + 4 + 4) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), ply.data() + at, sizeof(p));
      count += is_wall == (p[1] > 2.5F) ? 1 : 0;
    }
    return count;
  };
  const std::string all = Ply(points);
  const std::string carved = Ply(points, &rays);
  EXPECT_GT(count_at(all, false), 20U);
  EXPECT_EQ(count_at(carved, false), 0U);
  EXPECT_EQ(count_at(carved, true), count_at(all, true));
}

TEST(SpaceExportTest, TakesNoCloudWhereTheRobotStands) {
  BuildingMap map = Map();
  for (int i = 0; i < 10; ++i) {
    TrajectoryPose pose = map.trajectory.back();
    pose.log_stamp = pose.stamp += 0.1;
    map.trajectory.push_back(pose);
  }
  SpaceExport space(map, {});
  for (const TrajectoryPose& pose : map.trajectory) space.Add(CloudAt(pose.log_stamp));
  EXPECT_EQ(space.clouds().taken, 2U);
}

TEST(SpaceExportTest, OtherFloorsAndHeightsAreLeftOut) {
  const BuildingMap map = Map();
  SpaceExportOptions options;
  options.floor = 0;
  SpaceExport ground(map, options);
  ground.Add(CloudAt(10.0));
  EXPECT_EQ(ground.clouds().taken, 0U);
  options.floor.reset();
  options.heights.high_m = 4.0;
  SpaceExport low(map, options);
  low.Add(CloudAt(10.0));
  EXPECT_EQ(low.voxels(), 0U);
}

}  // namespace
}  // namespace masked_mapper
