// SPDX-License-Identifier: BSD-3-Clause
// Against the rules of those who open the folders: map_server, the route server's loader, and the
// loader of rmf_traffic_editor.
#include "masked_mapper/export/map_export.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "export/png_file.hpp"
#include "export/sample_map.hpp"
#include "masked_mapper/text/yaml_tree.hpp"

namespace masked_mapper {
namespace {

constexpr double kRoomYaw = 0.3;  // of a square room of 6 m around the origin

LaserScan ScanInRoom(const Pose2& T_room_robot) {
  LaserScan scan;
  scan.first_angle = -kPi;
  scan.angle_step = DegToRad(0.5);
  scan.max_range = 30.0F;
  for (int beam = 0; beam < 720; ++beam) {
    const double angle = T_room_robot.theta + scan.Angle(static_cast<std::size_t>(beam));
    const auto reach = [](double direction, double at) {
      return direction == 0.0 ? 100.0 : ((direction > 0.0 ? 3.0 : -3.0) - at) / direction;
    };
    const double to_x = reach(std::cos(angle), T_room_robot.x);
    const double to_y = reach(std::sin(angle), T_room_robot.y);
    scan.ranges.push_back(static_cast<float>(std::min(to_x, to_y)));
  }
  return scan;
}

/// Two floors of that room, driven through from left to right and, a floor up, back; a ride at the
/// right.
BuildingMap RoomMap() {
  BuildingMap map;
  map.graph.AddFloor({"0", 0.0, 0.0, true, false});
  map.graph.AddFloor({"1", 3.5, 0.2, true, false});
  map.graph.AddNode({});
  map.drives.push_back({});
  const Pose2 T_world_room{0.0, 0.0, kRoomYaw};
  const auto drive = [&](FloorId floor, double x, bool in_transit) {
    TrajectoryPose pose;
    pose.stamp = pose.log_stamp = static_cast<double>(map.trajectory.size());
    pose.floor = floor;
    pose.in_transit = in_transit;
    const Pose2 T_room_robot{x, 0.2, 0.1 * x};
    pose.T_odom_robot = pose.T_world_robot = T_world_room * T_room_robot;
    map.kept_scans.push_back({map.trajectory.size(), ScanInRoom(T_room_robot)});
    map.trajectory.push_back(pose);
  };
  for (int i = 0; i <= 8; ++i) drive(0, -2.0 + 0.5 * i, false);
  drive(0, 2.0, true);
  for (int i = 8; i >= 0; --i) drive(1, -2.0 + 0.5 * i, false);
  const Eigen::Vector2d dock = T_world_room * Eigen::Vector2d(-2.0, 1.5);
  map.places.push_back({"dock", 1, dock});
  Area area;
  area.floor = 0;
  for (const auto& [x, y] : {std::pair{-2.5, -2.5}, {-1.5, -2.5}, {-1.5, -1.5}, {-2.5, -1.5}}) {
    area.corners_in_world.push_back(T_world_room * Eigen::Vector2d(x, y));
  }
  map.areas.push_back(area);
  return map;
}

const YamlTree& At(const YamlTree& tree, const std::string& key) {
  for (const YamlTree::Entry& entry : tree.entries) {
    if (entry.key == key) return entry.tree;
  }
  ADD_FAILURE() << "no " << key;
  static const YamlTree none;
  return none;
}

double Number(const YamlTree& tree) { return std::strtod(tree.value.c_str(), nullptr); }

struct Picture {
  int width = 0;
  int height = 0;
  std::string pixels;
  double resolution = 0.0;
  double x = 0.0;  ///< m, of the lower left corner
  double y = 0.0;

  int At(double at_x, double at_y) const {
    const int column = static_cast<int>(std::floor((at_x - x) / resolution));
    const int row = static_cast<int>(std::floor((at_y - y) / resolution));
    return static_cast<unsigned char>(
        pixels.at(static_cast<std::size_t>((height - 1 - row) * width + column)));
  }
};

/// As map_server reads it: the picture is named relative to the file.
Picture ReadMap(const std::filesystem::path& yaml) {
  const YamlTree tree = ParseYaml(yaml.string(), ReadBytes(yaml));
  for (const char* key :
       {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"}) {
    At(tree, key);
  }
  Picture picture;
  picture.resolution = Number(At(tree, "resolution"));
  const YamlTree& origin = At(tree, "origin");
  EXPECT_EQ(origin.list.size(), 3U);
  picture.x = Number(origin.list[0]);
  picture.y = Number(origin.list[1]);
  EXPECT_EQ(Number(origin.list[2]), 0.0) << "costmaps know of no yaw";
  const std::string bytes = ReadBytes(yaml.parent_path() / At(tree, "image").value);
  int most = 0;
  int header = 0;
  EXPECT_EQ(std::sscanf(bytes.c_str(), "P5\n%d %d\n%d\n%n", &picture.width, &picture.height, &most,
                        &header),
            3);
  EXPECT_EQ(most, 255);
  picture.pixels = bytes.substr(static_cast<std::size_t>(header));
  EXPECT_EQ(picture.pixels.size(), static_cast<std::size_t>(picture.width * picture.height));
  return picture;
}

TEST(Handover, Nav2MapsAreSquareAndOfOneOriginAndSize) {
  const TestFolder folder;
  WriteNav2(RoomMap(), {}, folder.path());
  const Picture ground = ReadMap(folder / "floors/0/map.yaml");
  const Picture up = ReadMap(folder / "floors/1/map.yaml");
  EXPECT_EQ(ground.width, up.width);
  EXPECT_EQ(ground.height, up.height);
  EXPECT_EQ(ground.x, up.x);
  EXPECT_EQ(ground.y, up.y);
  // The walls stand along the axes: a whole wall lies within two columns.
  for (const double at : {-2.5, -1.0, 0.0, 1.0, 2.5}) {
    const auto is_wall = [&](double x, double y) {
      for (const double off : {-0.05, 0.0, 0.05}) {
        if (up.At(x + (std::abs(x) > 2.9 ? off : 0.0), y + (std::abs(y) > 2.9 ? off : 0.0)) == 0)
          return true;
      }
      return false;
    };
    EXPECT_TRUE(is_wall(3.0, at) && is_wall(-3.0, at) && is_wall(at, 3.0) && is_wall(at, -3.0));
  }
  EXPECT_EQ(up.At(0.0, 0.0), 254);
  const YamlTree frame = ParseYaml("frame.yaml", ReadBytes(folder / "frame.yaml"));
  EXPECT_NEAR(Number(At(frame, "yaw_deg")), -RadToDeg(kRoomYaw), 0.05);
  EXPECT_EQ(At(frame, "floors").list.size(), 2U);
  EXPECT_EQ(At(frame, "crossings").list.size(), 1U);
}

TEST(Handover, Nav2KeepsOutOfWhatWasDrawn) {
  const TestFolder folder;
  WriteNav2(RoomMap(), {}, folder.path());
  const Picture mask = ReadMap(folder / "floors/0/keepout.yaml");
  EXPECT_EQ(mask.At(-2.0, -2.0), 0);
  EXPECT_EQ(mask.At(-1.0, -2.0), 254);
  const Picture map = ReadMap(folder / "floors/0/map.yaml");
  EXPECT_EQ(map.width, mask.width);
  EXPECT_EQ(map.At(-2.0, -2.0), 205) << "nothing in it counts as free";
  EXPECT_EQ(ReadMap(folder / "floors/1/keepout.yaml").pixels.find('\0'), std::string::npos);
}

TEST(Handover, Nav2GraphIsWhatTheRouteServerLoads) {
  const TestFolder folder;
  WriteNav2(RoomMap(), {}, folder.path());
  std::set<unsigned> ids;
  for (const char* label : {"0", "1"}) {
    const auto graph = nlohmann::json::parse(
        ReadBytes(folder / (std::string("floors/") + label + "/graph.geojson")));
    std::set<unsigned> nodes;
    std::set<std::pair<unsigned, unsigned>> edges;
    std::map<unsigned, std::pair<double, double>> at;
    bool has_lift = false;
    for (const auto& feature : graph.at("features")) {
      const auto& properties = feature.at("properties");
      const auto id = properties.at("id").get<unsigned>();
      EXPECT_TRUE(ids.insert(id).second) << id;
      if (feature.at("geometry").at("type") == "Point") {
        EXPECT_EQ(properties.at("frame"), "map");
        nodes.insert(id);
        at[id] = {feature["geometry"]["coordinates"][0], feature["geometry"]["coordinates"][1]};
        has_lift = has_lift || properties.at("metadata").contains("elevator");
        for (const auto& entry : properties.at("metadata")) {
          EXPECT_TRUE(entry.is_primitive() || entry.is_array());
        }
        continue;
      }
      EXPECT_EQ(feature.at("geometry").at("type"), "MultiLineString");
      const auto start = properties.at("startid").get<unsigned>();
      const auto end = properties.at("endid").get<unsigned>();
      EXPECT_TRUE(nodes.count(start) && nodes.count(end)) << "nodes come first";
      edges.insert({start, end});
      const auto& line = feature["geometry"]["coordinates"][0];
      EXPECT_EQ(line.size(), 2U);
      EXPECT_EQ(line[0][0].get<double>(), at[start].first);
      EXPECT_EQ(line[1][1].get<double>(), at[end].second);
    }
    EXPECT_TRUE(has_lift);
    EXPECT_FALSE(edges.empty());
    for (const auto& [start, end] : edges) EXPECT_TRUE(edges.count({end, start}));
  }
}

/// A parameter is the number of its type and its value.
void ExpectParameters(const YamlTree& tree) {
  for (const YamlTree::Entry& entry : tree.entries) {
    ASSERT_EQ(entry.tree.list.size(), 2U) << entry.key;
    EXPECT_GE(Number(entry.tree.list[0]), 1.0);
    EXPECT_LE(Number(entry.tree.list[0]), 4.0);
  }
}

TEST(Handover, RmfLoadsItsBuilding) {
  const TestFolder folder;
  HandoverOptions options;
  options.name = "room";
  WriteRmf(RoomMap(), options, folder.path());
  const YamlTree building = ParseYaml("building.yaml", ReadBytes(folder / "room.building.yaml"));
  EXPECT_EQ(At(building, "name").value, "room");
  EXPECT_EQ(At(building, "coordinate_system").value, "reference_image");
  const YamlTree& levels = At(building, "levels");
  ASSERT_EQ(levels.entries.size(), 2U);
  for (const YamlTree::Entry& level : levels.entries) {
    EXPECT_TRUE(std::filesystem::exists(folder / At(At(level.tree, "drawing"), "filename").value));
    EXPECT_EQ(At(level.tree, "fiducials").list.size(), 2U);
    const auto& vertices = At(level.tree, "vertices").list;
    for (const YamlTree& vertex : vertices) {
      ASSERT_EQ(vertex.list.size(), 5U);
      ExpectParameters(vertex.list[4]);
    }
    for (const char* edges : {"lanes", "walls", "measurements"}) {
      EXPECT_FALSE(At(level.tree, edges).list.empty()) << edges;
      for (const YamlTree& edge : At(level.tree, edges).list) {
        ASSERT_EQ(edge.list.size(), 3U);
        EXPECT_LT(Number(edge.list[0]), static_cast<double>(vertices.size()));
        EXPECT_LT(Number(edge.list[1]), static_cast<double>(vertices.size()));
        ExpectParameters(edge.list[2]);
      }
    }
    for (const YamlTree& lane : At(level.tree, "lanes").list) {
      EXPECT_EQ(At(lane.list[2], "bidirectional").list[1].value, "true");
      At(lane.list[2], "graph_idx");
    }
    // The measured distance and its pixels give the scale of the picture.
    const YamlTree& measured = At(level.tree, "measurements").list[0];
    const auto x = [&](int end) {
      return Number(
          vertices[static_cast<std::size_t>(Number(measured.list[static_cast<std::size_t>(end)]))]
              .list[0]);
    };
    EXPECT_NEAR(Number(At(measured.list[2], "distance").list[1]) / std::abs(x(1) - x(0)), 0.05,
                1e-9);
  }
  EXPECT_EQ(At(levels.entries[1].tree, "elevation").value, "3.500");
  const YamlTree& lifts = At(building, "lifts");
  ASSERT_EQ(lifts.entries.size(), 1U);
  const YamlTree& lift = lifts.entries[0].tree;
  for (const char* key : {"x", "y", "yaw", "width", "depth"}) At(lift, key);
  EXPECT_EQ(At(lift, "reference_floor_name").value, "0");
  EXPECT_EQ(At(lift, "highest_floor").value, "1");
  ASSERT_EQ(At(lift, "level_doors").entries.size(), 2U);
  const YamlTree& doors = At(lift, "doors");
  for (const YamlTree::Entry& served : At(lift, "level_doors").entries) {
    ASSERT_EQ(served.tree.list.size(), 1U);
    const YamlTree& door = At(doors, served.tree.list[0].value);
    for (const char* key : {"door_type", "x", "y", "width", "motion_axis_orientation"}) {
      At(door, key);
    }
  }
}

TEST(Handover, RmfNavGraphIsInMetresFromThePicturesCorner) {
  const TestFolder folder;
  WriteRmf(RoomMap(), {}, folder.path());
  const YamlTree graph = ParseYaml("0.yaml", ReadBytes(folder / "nav_graphs/0.yaml"));
  const YamlTree frame = ParseYaml("frame.yaml", ReadBytes(folder / "frame.yaml"));
  const double yaw = DegToRad(Number(At(frame, "yaw_deg")));
  const Pose2 T_rmf_map{Number(At(frame, "shift_m").list[0]), Number(At(frame, "shift_m").list[1]),
                        yaw};
  const Eigen::Vector2d dock = T_rmf_map * RoomMap().places[0].at_in_world;
  const YamlTree& level = At(At(graph, "levels"), "1");
  bool has_dock = false;
  bool has_lift = false;
  for (const YamlTree& vertex : At(level, "vertices").list) {
    ASSERT_EQ(vertex.list.size(), 3U);
    EXPECT_GT(Number(vertex.list[0]), 0.0);
    EXPECT_LT(Number(vertex.list[1]), 0.0);
    if (At(vertex.list[2], "name").value == "dock") {
      has_dock = true;
      EXPECT_NEAR(Number(vertex.list[0]), dock.x(), 1e-3);
      EXPECT_NEAR(Number(vertex.list[1]), dock.y(), 1e-3);
    }
    for (const YamlTree::Entry& entry : vertex.list[2].entries) {
      has_lift = has_lift || entry.key == "lift";
    }
  }
  EXPECT_TRUE(has_dock);
  EXPECT_TRUE(has_lift);
  for (const YamlTree& lane : At(level, "lanes").list) {
    EXPECT_LT(Number(lane.list[0]), static_cast<double>(At(level, "vertices").list.size()));
  }
}

TEST(Handover, AMapOfNothingIsHandedOver) {
  const TestFolder folder;
  BuildingMap map;
  map.graph.AddFloor({"0", 0.0, 0.0, true, false});
  std::filesystem::create_directory(folder / "nav2");
  std::filesystem::create_directory(folder / "rmf");
  WriteNav2(map, {}, folder / "nav2");
  EXPECT_FALSE(std::filesystem::exists(folder / "nav2/floors/0/graph.geojson"));
  WriteRmf(map, {}, folder / "rmf");
  ParseYaml("building.yaml", ReadBytes(folder / "rmf/building.building.yaml"));
}

TEST(PngFile, UnpacksToItsPixels) {
  const TestFolder folder;
  const std::string pixels("\x00\xff\x7f\x01\xcd\xfe", 6);
  WriteGreyPng(pixels, 3, folder / "a.png");
  const std::string png = ReadBytes(folder / "a.png");
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\3\0\0\0\2", 8));
  const std::size_t packed = png.find("IDAT") + 4;
  std::string lines(8, '\0');
  uLongf size = lines.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(lines.data()), &size,
                       reinterpret_cast<const Bytef*>(png.data() + packed), png.size() - packed),
            Z_OK);
  EXPECT_EQ(lines, std::string(1, '\0') + pixels.substr(0, 3) + '\0' + pixels.substr(3));
}

}  // namespace
}  // namespace masked_mapper
