// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_file.hpp"

#include <cmath>
#include <string>

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

double ElevationOf(const std::vector<Floor>& floors, FloorId floor) {
  return floors.at(static_cast<std::size_t>(floor)).elevation;
}

}  // namespace

std::string TumLine(double stamp, const Pose2& T_world_robot, double elevation) {
  const double half = 0.5 * WrapAngle(T_world_robot.theta);
  return ExactText(stamp) + " " + FixedText(T_world_robot.x, 6) + " " +
         FixedText(T_world_robot.y, 6) + " " + FixedText(elevation, 6) + " 0 0 " +
         FixedText(std::sin(half), 9) + " " + FixedText(std::cos(half), 9) + "\n";
}

void WriteTrajectory(const std::vector<TrajectoryPose>& trajectory,
                     const std::vector<Floor>& floors, const std::filesystem::path& path) {
  std::string text;
  for (const TrajectoryPose& pose : trajectory) {
    text += TumLine(pose.log_stamp, pose.T_world_robot, ElevationOf(floors, pose.floor));
  }
  WriteFile(path, text);
}

void WriteNodes(const PoseGraph& graph, const std::filesystem::path& path) {
  std::string text;
  for (const Node& node : graph.nodes()) {
    text += TumLine(node.stamp, node.T_world_robot, ElevationOf(graph.floors(), node.floor));
  }
  WriteFile(path, text);
}

}  // namespace masked_mapper
