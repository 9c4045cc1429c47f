// SPDX-License-Identifier: BSD-3-Clause
#include "export/g2o_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <map>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

struct G2oEdge {
  int from = 0;
  int to = 0;
  Pose2 measurement;
  Eigen::Matrix3d information;
};

struct G2oGraph {
  std::map<int, Pose2> vertices;
  std::vector<G2oEdge> edges;
};

G2oGraph ReadG2o(const std::filesystem::path& path) {
  G2oGraph graph;
  for (const std::string& line : Split(ReadBytes(path), '\n')) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag == "VERTEX_SE2") {
      int id = -1;
      Pose2 pose;
      words >> id >> pose.x >> pose.y >> pose.theta;
      graph.vertices[id] = pose;
    } else if (tag == "EDGE_SE2") {
      G2oEdge edge;
      words >> edge.from >> edge.to >> edge.measurement.x >> edge.measurement.y >>
          edge.measurement.theta;
      for (int row = 0; row < 3; ++row) {
        for (int column = row; column < 3; ++column) {
          words >> edge.information(row, column);
          edge.information(column, row) = edge.information(row, column);
        }
      }
      graph.edges.push_back(edge);
    } else {
      ADD_FAILURE() << "unexpected line: " << line;
    }
    EXPECT_TRUE(words) << line;
  }
  return graph;
}

TEST(G2oFile, WhatTellsATurnAloneIsNoWay) {
  BuildingMap map = SampleMap();
  const std::size_t ways = map.graph.edges().size();
  map.graph.AddEdge({0, 1, {{0.0, 0.0, 0.25}, Eigen::Matrix3d::Identity()}, EdgeKind::kHeading});
  const TestFolder folder;
  WriteG2o(map.graph, folder / "g.g2o");
  EXPECT_EQ(ReadG2o(folder / "g.g2o").edges.size(), ways);
}

TEST(G2oFile, HoldsAllNodesAndEdges) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteG2o(map.graph, folder / "g.g2o");
  const G2oGraph read = ReadG2o(folder / "g.g2o");
  ASSERT_EQ(read.vertices.size(), 4U);
  ASSERT_EQ(read.edges.size(), 4U);
  for (const auto& [id, pose] : read.vertices) {
    const Pose2& expected = map.graph.nodes()[static_cast<std::size_t>(id)].T_world_robot;
    EXPECT_LT((pose.AsVector() - expected.AsVector()).norm(), 1e-8);
  }
  EXPECT_EQ(read.edges[3].from, 0);
  EXPECT_EQ(read.edges[3].to, 1);
}

// The same error counts as much in g2o's terms as in ours.
TEST(G2oFile, InformationIsInTheFrameOfTheFarEnd) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteG2o(map.graph, folder / "g.g2o");
  const G2oGraph read = ReadG2o(folder / "g.g2o");
  for (std::size_t i = 0; i < read.edges.size(); ++i) {
    const UncertainPose2& T_from_to = map.graph.edges()[i].T_from_to;
    const Eigen::Vector3d off(0.02, -0.03, 0.01);
    const Pose2 actual{T_from_to.mean.x + off.x(), T_from_to.mean.y + off.y(),
                       WrapAngle(T_from_to.mean.theta + off.z())};
    const double ours = off.dot(T_from_to.covariance.inverse() * off);
    const Eigen::Vector3d residual = Between(read.edges[i].measurement, actual).AsVector();
    EXPECT_NEAR(residual.dot(read.edges[i].information * residual), ours, 1e-6 * ours);
  }
}

TEST(G2oFile, OneFloorKeepsItsIds) {
  const BuildingMap map = SampleMap();
  const TestFolder folder;
  WriteG2o(map.graph, 0, folder / "0.g2o");
  WriteG2o(map.graph, 1, folder / "1.g2o");
  const G2oGraph ground = ReadG2o(folder / "0.g2o");
  EXPECT_EQ(ground.vertices.size(), 3U);
  EXPECT_EQ(ground.edges.size(), 3U);
  const G2oGraph below = ReadG2o(folder / "1.g2o");
  ASSERT_EQ(below.vertices.size(), 1U);
  EXPECT_EQ(below.vertices.begin()->first, 3);
  EXPECT_TRUE(below.edges.empty());
}

TEST(G2oFile, SingularCovarianceStaysFinite) {
  BuildingMap map = SampleMap();
  map.graph.AddEdge({0, 2, {{1.0, 2.0, 0.5}, Eigen::Matrix3d::Zero()}, EdgeKind::kOdometry});
  const TestFolder folder;
  WriteG2o(map.graph, folder / "g.g2o");
  EXPECT_TRUE(ReadG2o(folder / "g.g2o").edges.back().information.allFinite());
}

}  // namespace
}  // namespace masked_mapper
