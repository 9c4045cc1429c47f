// SPDX-License-Identifier: BSD-3-Clause
#include "g2o_file.hpp"

#include <Eigen/Dense>
#include <array>
#include <charconv>
#include <numeric>
#include <string>
#include <vector>

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

// A direction cannot be known better than this; it keeps the inverse of a singular covariance
// finite.
constexpr double kLeastVariance = 1e-12;  // m^2, rad^2

// g2o's residual of an edge is the pose left over in the frame of the measured far end, ours has
// the translation in the frame of the near end.
Eigen::Matrix3d InformationInFarEnd(const UncertainPose2& T_from_to) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(T_from_to.covariance);
  const Eigen::Vector3d inverse = eigen.eigenvalues().cwiseMax(kLeastVariance).cwiseInverse();
  const Eigen::Matrix3d information =
      eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  Eigen::Matrix3d to_from = Eigen::Matrix3d::Identity();
  const double c = std::cos(T_from_to.mean.theta);
  const double s = std::sin(T_from_to.mean.theta);
  to_from.topLeftCorner<2, 2>() << c, s, -s, c;
  return to_from * information * to_from.transpose();
}

std::string SignificantText(double value) {
  std::array<char, 40> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::general, 10);
  return {digits.data(), end.ptr};
}

std::string PoseText(const Pose2& pose) {
  return FixedText(pose.x, 9) + " " + FixedText(pose.y, 9) + " " + FixedText(pose.theta, 9);
}

std::string VertexLine(NodeId id, const Node& node) {
  return "VERTEX_SE2 " + std::to_string(id) + " " + PoseText(node.T_world_robot) + "\n";
}

std::string EdgeLine(const Edge& edge) {
  std::string line = "EDGE_SE2 " + std::to_string(edge.from) + " " + std::to_string(edge.to) + " " +
                     PoseText(edge.T_from_to.mean);
  const Eigen::Matrix3d information = InformationInFarEnd(edge.T_from_to);
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      line += " " + SignificantText(information(row, column));
    }
  }
  return line + "\n";
}

void WriteGraph(const PoseGraph& graph, const std::vector<NodeId>& nodes,
                const std::vector<EdgeId>& edges, const std::filesystem::path& path) {
  std::string text;
  for (const NodeId id : nodes) text += VertexLine(id, graph.nodes()[static_cast<std::size_t>(id)]);
  for (const EdgeId id : edges) {
    const Edge& edge = graph.edge(id);
    // Who reads the file takes every edge for a way, of its length.
    if (edge.kind != EdgeKind::kHeading) text += EdgeLine(edge);
  }
  WriteFile(path, text);
}

}  // namespace

void WriteG2o(const PoseGraph& graph, const std::filesystem::path& path) {
  std::vector<NodeId> nodes(graph.nodes().size());
  std::vector<EdgeId> edges(graph.edges().size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::iota(edges.begin(), edges.end(), 0);
  WriteGraph(graph, nodes, edges, path);
}

void WriteG2o(const PoseGraph& graph, FloorId floor, const std::filesystem::path& path) {
  const FloorGraph view = FloorView(graph, floor);
  WriteGraph(graph, view.nodes, view.edges, path);
}

}  // namespace masked_mapper
