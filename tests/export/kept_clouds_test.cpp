// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "export/sample_map.hpp"
#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "sensor/room_cloud.hpp"

namespace masked_mapper {
namespace {

LevelledCloud Room() {
  LevelledCloud cloud;
  cloud.points = RoomCloud().Seen();
  for (CloudPoint& point : cloud.points) point.position.z() += 0.6F;
  cloud.lidar = {0.0, 0.0, 0.6};
  cloud.ceiling_m = 2.7;
  return cloud;
}

TEST(KeptCloudsTest, ComeInOrderWithTheStampsOfTheirPoses) {
  BuildingMap map = SampleMap();
  for (const std::size_t index : {0U, 2U, 7U}) {
    map.kept_clouds.push_back({index, std::make_shared<const std::string>(PackCloud(Room()))});
  }
  std::vector<std::size_t> seen;
  ForEachKeptCloud(map, 1, [&](const LevelledCloud& cloud, std::size_t index) {
    seen.push_back(index);
    EXPECT_EQ(cloud.log_stamp, map.trajectory[index].log_stamp);
    EXPECT_GT(cloud.points.size(), 1000U);
  });
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 2, 7}));
  std::size_t taken = 0;
  ForEachKeptCloud(map, 2, [&](const LevelledCloud&, std::size_t) { ++taken; });
  EXPECT_EQ(taken, 2U);
  map.kept_clouds.push_back({7, std::make_shared<const std::string>("no cloud")});
  EXPECT_THROW(ForEachKeptCloud(map, 1, [](const LevelledCloud&, std::size_t) {}), InputError);
}

TEST(KeptCloudsTest, TellTheSameOfSpaceAsTheCloudsOfTheLog) {
  BuildingMap map;
  map.graph.AddFloor({});
  SpaceOccupancyOptions options;
  options.votes.resolution_m = 0.1;
  for (int i = 0; i < 6; ++i) {
    TrajectoryPose pose;
    pose.stamp = pose.log_stamp = 10.0 + i;
    pose.T_world_robot = {0.0, 0.0, 0.4 * i};  // on its place
    map.trajectory.push_back(pose);
    map.kept_clouds.push_back(
        {map.trajectory.size() - 1, std::make_shared<const std::string>(PackCloud(Room()))});
  }
  SpaceOccupancy of_log(map, options);
  for (const TrajectoryPose& pose : map.trajectory) {
    LevelledCloud cloud = Room();
    cloud.log_stamp = pose.log_stamp;
    of_log.Add(cloud);
  }
  of_log.Finish();
  SpaceOccupancy of_map(map, options);
  ForEachKeptCloud(map, 1,
                   [&](const LevelledCloud& cloud, std::size_t i) { of_map.Add(cloud, i); });
  of_map.Finish();
  int same = 0;
  int all = 0;
  for (double x = -3.95; x < 4.0; x += 0.1) {
    for (double y = -3.95; y < 4.0; y += 0.1) {
      for (double z = 0.05; z < 2.7; z += 0.1) {
        ++all;
        same += of_log.At(0, {x, y, z}) == of_map.At(0, {x, y, z}) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(same, 0.98 * all);
}

}  // namespace
}  // namespace masked_mapper
