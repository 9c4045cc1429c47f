// SPDX-License-Identifier: BSD-3-Clause
// Drives through one building as logs of their own, mapped each by itself.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/ring_drive.hpp"
#include "masked_mapper/log/log_writer.hpp"
#include "masked_mapper/mapping/map_log.hpp"

namespace masked_mapper {

/// Scans `begin` to `end` of a drive, as a log of their own that begins at its first pose.
struct Cut {
  std::vector<LaserScan> scans;
  std::vector<Pose2> truth;  ///< in the frame of the whole drive

  Cut(const RingDrive& drive, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < std::min(end, drive.scans.size()); ++i) {
      LaserScan scan = drive.scans[i];
      scan.stamp -= drive.scans[begin].stamp - 1.0;
      scan.T_odom_robot = Between(*drive.scans[begin].T_odom_robot, *scan.T_odom_robot);
      scans.push_back(scan);
      truth.push_back(drive.truth[i]);
    }
  }
};

/// In a file of this test's own: tests run side by side.
inline BuildingMap MapOf(const Cut& cut, const std::string& name,
                         const std::vector<std::pair<std::size_t, std::string>>& labels = {}) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string file = std::string(test->test_suite_name()) + "." + test->name() + "." + name;
  const std::string path = (std::filesystem::path(testing::TempDir()) / file).string();
  LogWriter writer(path);
  for (std::size_t i = 0; i < cut.scans.size(); ++i) {
    for (const auto& [scan, label] : labels) {
      if (scan == i) writer.Write(FloorLabel{cut.scans[i].stamp - 0.01, label});
    }
    writer.Write(cut.scans[i]);
  }
  writer.Close();
  ProgressSink silent;
  return MapLog(path, "openings", {}, silent);
}

/// The same map with other floors.
inline BuildingMap WithFloors(BuildingMap map, const std::function<void(Floor&)>& change) {
  PoseGraph graph;
  for (Floor floor : map.graph.floors()) {
    change(floor);
    graph.AddFloor(floor);
  }
  for (const Node& node : map.graph.nodes()) graph.AddNode(node);
  for (const Edge& edge : map.graph.edges()) graph.AddEdge(edge);
  map.graph = std::move(graph);
  return map;
}

inline const Cut& First() {
  static const Cut cut(RingDrive(1.3, 0.2, 1), 0, 10000);
  return cut;
}

// From another corner, another seed.
inline const Cut& Second() {
  static const Cut cut(RingDrive(2.0, -0.3, 2), 230, 720);
  return cut;
}

}  // namespace masked_mapper
