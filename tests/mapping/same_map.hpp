// SPDX-License-Identifier: BSD-3-Clause
// Whether two maps are the same to the last bit; what differs first is said.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Everything in a map as bytes, each with a word for what it is. NaN equals itself.
class MapBytes {
 public:
  explicit MapBytes(const BuildingMap& map) {
    for (const Floor& floor : map.graph.floors()) {
      Add("floor", floor.label);
      AddNumber("floor", floor.elevation);
      AddNumber("floor", floor.elevation_sigma);
      AddNumber("floor", floor.elevation_measured);
      AddNumber("floor", floor.label_given);
    }
    for (const Node& node : map.graph.nodes()) AddNode(node);
    for (const Edge& edge : map.graph.edges()) {
      AddNumber("edge", edge.from);
      AddNumber("edge", edge.to);
      AddNumber("edge", static_cast<int>(edge.kind));
      AddPose("edge", edge.T_from_to);
    }
    for (const Closure& closure : map.closures) AddClosure(closure);
    for (const TrajectoryPose& pose : map.trajectory) {
      AddNumber("trajectory", pose.stamp);
      AddNumber("trajectory", pose.log_stamp);
      AddNumber("trajectory", pose.floor);
      AddNumber("trajectory", pose.in_transit);
      AddNumber("trajectory", pose.node_before);
      AddPose("trajectory", pose.T_odom_robot);
      AddPose("trajectory", pose.T_world_robot);
    }
    for (const KeptScan& kept : map.kept_scans) {
      AddNumber("scan", kept.trajectory_index);
      AddScan(kept.scan);
    }
    for (const KeptCloud& kept : map.kept_clouds) {
      AddNumber("cloud", kept.trajectory_index);
      Add("cloud", *kept.packed);
    }
    for (const Drive& drive : map.drives) {
      Add("drive", drive.log);
      AddNumber("drive", drive.first_pose);
      AddNumber("drive", drive.first_node);
      AddNumber("drive", drive.stamp_offset_s);
      AddNumber("drive", static_cast<int>(drive.motion_source));
      Add("drive", drive.reason);
    }
    for (const NamedPlace& place : map.places) {
      Add("place", place.name);
      AddNumber("place", place.floor);
      AddNumber("place", place.at_in_world.x());
      AddNumber("place", place.at_in_world.y());
    }
    for (const Area& area : map.areas) {
      AddNumber("area", static_cast<int>(area.kind));
      AddNumber("area", area.floor);
      for (const Eigen::Vector2d& corner : area.corners_in_world) {
        AddNumber("area", corner.x());
        AddNumber("area", corner.y());
      }
    }
    AddLog(map.log);
    AddNumber("motion source", static_cast<int>(map.motion_source));
    for (const std::string& warning : map.warnings) Add("warning", warning);
  }

  const std::vector<std::pair<std::string, std::string>>& parts() const { return parts_; }

 private:
  void Add(const std::string& what, const std::string& bytes) { parts_.emplace_back(what, bytes); }

  template <typename Number>
  void AddNumber(const std::string& what, Number number) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    Add(what, bytes);
  }

  void AddPose(const std::string& what, const Pose2& pose) {
    AddNumber(what, pose.x);
    AddNumber(what, pose.y);
    AddNumber(what, pose.theta);
  }

  void AddPose(const std::string& what, const UncertainPose2& pose) {
    AddPose(what, pose.mean);
    for (int i = 0; i < 9; ++i) AddNumber(what, pose.covariance(i / 3, i % 3));
  }

  void AddNode(const Node& node) {
    AddNumber("node", node.stamp);
    AddNumber("node", node.floor);
    AddPose("node", node.T_odom_robot);
    AddPose("node", node.T_world_robot);
    AddNumber("node", node.scan);
  }

  void AddClosure(const Closure& closure) {
    AddNumber("closure", closure.older);
    AddNumber("closure", closure.newer);
    AddPose("closure", closure.T_older_newer);
    AddNumber("closure", closure.score);
    AddNumber("closure", closure.mahalanobis);
    AddNumber("closure", closure.agreement);
    AddNumber("closure", closure.votes);
    AddNumber("closure", static_cast<int>(closure.state));
    AddNumber("closure", static_cast<int>(closure.reason));
  }

  void AddScan(const LaserScan& scan) {
    AddNumber("scan", scan.stamp);
    AddPose("scan", scan.T_robot_laser);
    AddNumber("scan", scan.first_angle);
    AddNumber("scan", scan.angle_step);
    AddNumber("scan", scan.max_range);
    AddNumber("scan", scan.T_odom_robot.has_value());
    if (scan.T_odom_robot) AddPose("scan", *scan.T_odom_robot);
    for (const float range : scan.ranges) AddNumber("range", range);
  }

  void AddLog(const LogStatistics& log) {
    for (const std::uint64_t count :
         {log.lines, log.scans, log.odometry, log.pressure, log.acceleration, log.floor_labels,
          log.bad_lines, log.invalid_ranges, log.empty_scans, log.stamp_jumps, log.reordered,
          log.trailing_bytes}) {
      AddNumber("log", count);
    }
    Add("log", log.first_bad_line);
    AddNumber("log", log.truncated);
    for (const auto& [name, count] : log.other_messages) {
      Add("log", name);
      AddNumber("log", count);
    }
    AddNumber("log", log.max_range);
    AddNumber("log", log.first_stamp);
    AddNumber("log", log.last_stamp);
  }

  std::vector<std::pair<std::string, std::string>> parts_;
};

inline ::testing::AssertionResult SameMap(const BuildingMap& a, const BuildingMap& b) {
  const MapBytes bytes_a(a);
  const MapBytes bytes_b(b);
  for (std::size_t i = 0; i < std::min(bytes_a.parts().size(), bytes_b.parts().size()); ++i) {
    if (bytes_a.parts()[i] != bytes_b.parts()[i]) {
      return ::testing::AssertionFailure() << "a " << bytes_a.parts()[i].first << " differs from a "
                                           << bytes_b.parts()[i].first << ", part " << i;
    }
  }
  if (bytes_a.parts().size() != bytes_b.parts().size()) {
    return ::testing::AssertionFailure() << "one has more in it";
  }
  return ::testing::AssertionSuccess();
}

}  // namespace masked_mapper
