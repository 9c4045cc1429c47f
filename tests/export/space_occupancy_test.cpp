// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/space_lidar.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// A hall with a table on one side of the way and a lintel over the way.
Building Hall() {
  Building building;
  FloorPlan floor;
  floor.label = "0";
  const std::vector<Eigen::Vector2d> corners = {{-1.0, -3.0}, {9.0, -3.0}, {9.0, 3.0}, {-1.0, 3.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    floor.segments.push_back({corners[i], corners[(i + 1) % 4], Surface::kWall});
  }
  floor.overhead.push_back({{5.0, 2.0, 0.0}, 1.2, 0.8, 0.7, 0.75});   // table
  floor.overhead.push_back({{6.5, 0.0, 0.0}, 0.2, 6.0, 2.05, 10.0});  // lintel
  building.floors = {floor};
  return building;
}

/// Two floors, both as the hall, each driven along x.
class DriveTest : public ::testing::Test {
 protected:
  DriveTest() {
    for (const double elevation : {0.0, 3.4}) {
      Floor floor;
      floor.label = elevation > 0.0 ? "1" : "0";
      floor.elevation = elevation;
      map_.graph.AddFloor(floor);
    }
    const Building hall = Hall();
    SpaceLidarOptions options = OptionsOf(SpaceLidarModel::kOs132);
    SpaceLidar lidar(hall, options, LidarNoise::None(), 1);
    double time = 1.0;
    for (const FloorId floor : {0, 1}) {
      for (double x = 0.0; x < 6.0; x += 0.4, time += 1.0) {
        RobotState state;
        state.T_building_robot = {x, 0.0, 0.0};
        const CloudReading reading = lidar.Sweep(time, [&](double) { return state; });
        LevelledCloud cloud;
        cloud.log_stamp = time;
        cloud.points = reading.points;
        Move(reading.T_robot_lidar, &cloud.points);
        cloud.lidar = reading.T_robot_lidar.translation();
        cloud.ceiling_m = 2.7;
        clouds_.push_back(cloud);
        TrajectoryPose pose;
        pose.stamp = pose.log_stamp = time;
        pose.floor = floor;
        pose.T_world_robot = state.T_building_robot;
        map_.trajectory.push_back(pose);
      }
    }
    folder_ = fs::temp_directory_path() / ("masked_mapper_occupancy_" + std::to_string(::getpid()));
    fs::create_directory(folder_);
  }
  ~DriveTest() override { fs::remove_all(folder_); }

  /// How often the log is read.
  std::size_t Run(SpaceOccupancy* space) const {
    std::size_t passes = 0;
    do {
      ++passes;
      for (const LevelledCloud& cloud : clouds_) space->Add(cloud);
    } while (space->Finish());
    return passes;
  }

  std::string BytesOf(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
  }

  BuildingMap map_;
  std::vector<LevelledCloud> clouds_;
  fs::path folder_;
};

/// Grey of the map_server picture at a place, m.
int GreyAt(const std::string& pgm, const std::string& yaml, double x, double y) {
  std::istringstream header(pgm);
  std::string magic;
  int width = 0;
  int height = 0;
  int most = 0;
  header >> magic >> width >> height >> most;
  const std::size_t begin = pgm.size() - static_cast<std::size_t>(width * height);
  const std::size_t bracket = yaml.find("origin: [");
  double origin_x = 0.0;
  double origin_y = 0.0;
  std::sscanf(yaml.c_str() + bracket, "origin: [%lf, %lf", &origin_x, &origin_y);
  const int column = static_cast<int>(std::floor((x - origin_x) / 0.05));
  const int row = height - 1 - static_cast<int>(std::floor((y - origin_y) / 0.05));
  return static_cast<unsigned char>(pgm[begin + static_cast<std::size_t>(row * width + column)]);
}

TEST_F(DriveTest, TablesAreInTheWayAndLintelsAreNot) {
  SpaceOccupancy space(map_, {});
  EXPECT_EQ(Run(&space), 1U);
  space.WriteGrid(0, {}, folder_ / "low");
  space.WriteGrid(0, {0.1, 2.4}, folder_ / "high");
  const std::string low = BytesOf("low.pgm");
  const std::string low_yaml = BytesOf("low.yaml");
  const std::string high = BytesOf("high.pgm");
  const std::string high_yaml = BytesOf("high.yaml");
  EXPECT_EQ(GreyAt(low, low_yaml, 5.0, 1.62), 0);    // the table's near edge
  EXPECT_EQ(GreyAt(low, low_yaml, 6.5, 0.02), 254);  // below the lintel
  EXPECT_EQ(std::min(GreyAt(high, high_yaml, 6.38, 0.02), GreyAt(high, high_yaml, 6.42, 0.02)), 0);
  EXPECT_EQ(GreyAt(low, low_yaml, 3.0, 0.02), 254);
  EXPECT_EQ(GreyAt(low, low_yaml, 3.0, -2.99), 0);
}

TEST_F(DriveTest, OctomapReadsTheTree) {
  SpaceOccupancy space(map_, {});
  Run(&space);
  space.WriteOctree(folder_ / "hall.bt");
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary((folder_ / "hall.bt").string()));
  const auto is_occupied = [&](double x, double y, double z) {
    const octomap::OcTreeNode* node = tree.search(x, y, z);
    return node != nullptr && tree.isNodeOccupied(*node);
  };
  const auto is_free = [&](double x, double y, double z) {
    const octomap::OcTreeNode* node = tree.search(x, y, z);
    return node != nullptr && !tree.isNodeOccupied(*node);
  };
  for (const double floor : {0.0, 3.4}) {
    EXPECT_TRUE(is_free(3.0, 0.02, floor + 0.62));
    EXPECT_TRUE(is_free(5.0, 2.0, floor + 0.42));       // below the table
    EXPECT_TRUE(is_occupied(5.0, 1.62, floor + 0.72));  // its near edge
    EXPECT_TRUE(is_occupied(3.0, 0.5, floor + 0.02) || is_occupied(3.0, 0.5, floor - 0.02));
    // Rings of the lidar meet the lintel's face here and there, to this side of its voxels or that.
    bool meets_lintel = false;
    for (double z = 2.12; z < 2.65; z += 0.05) {
      meets_lintel |= is_occupied(6.38, 0.02, floor + z) || is_occupied(6.42, 0.02, floor + z);
    }
    EXPECT_TRUE(meets_lintel);
    EXPECT_FALSE(is_occupied(6.38, 0.02, floor + 1.5) || is_occupied(6.42, 0.02, floor + 1.5));
  }
}

TEST_F(DriveTest, FloorsThatDoNotFitWaitForTheNextReading) {
  SpaceOccupancy all(map_, {});
  EXPECT_EQ(Run(&all), 1U);
  all.WriteOctree(folder_ / "all.bt");
  SpaceOccupancyOptions options;
  options.memory_mib = 0.95 * all.peak_mib();
  SpaceOccupancy one_by_one(map_, options);
  EXPECT_EQ(Run(&one_by_one), 2U);
  EXPECT_LE(one_by_one.peak_mib(), all.peak_mib());
  one_by_one.WriteOctree(folder_ / "one.bt");
  EXPECT_EQ(BytesOf("all.bt"), BytesOf("one.bt"));
  options.memory_mib = 0.1;
  SpaceOccupancy none(map_, options);
  EXPECT_THROW(Run(&none), InputError);
}

}  // namespace
}  // namespace masked_mapper
