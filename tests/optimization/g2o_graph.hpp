// SPDX-License-Identifier: BSD-3-Clause
// The public benchmark graphs, for tests and benchmarks: VERTEX_SE2 and EDGE_SE2 lines of a g2o
// file that is known to be sound.
#pragma once

#include <Eigen/LU>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

inline std::optional<PoseGraph> ReadG2o(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  PoseGraph graph;
  graph.AddFloor({});
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag == "VERTEX_SE2") {
      Node node;
      NodeId id = 0;
      words >> id >> node.T_world_robot.x >> node.T_world_robot.y >> node.T_world_robot.theta;
      if (!words || id != static_cast<NodeId>(graph.nodes().size())) return std::nullopt;
      graph.AddNode(node);
    } else if (tag == "EDGE_SE2") {
      Edge edge;
      Pose2& T = edge.T_from_to.mean;
      double i[6];
      words >> edge.from >> edge.to >> T.x >> T.y >> T.theta;
      for (double& value : i) words >> value;
      if (!words) return std::nullopt;
      Eigen::Matrix3d information;
      information << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
      edge.T_from_to.covariance = information.inverse();
      edge.kind = edge.to == edge.from + 1 ? EdgeKind::kOdometry : EdgeKind::kClosure;
      graph.AddEdge(edge);
    }
  }
  return graph;
}

}  // namespace masked_mapper
