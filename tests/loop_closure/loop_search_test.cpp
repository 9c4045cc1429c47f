// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_search.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace masked_mapper {
namespace {

struct Scene {
  PoseGraph graph;
  std::vector<Closure> closures;
  LoopSearch search;
};

UncertainPose2 RandomTransform(std::mt19937& random, double sigma_theta) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = normal(random);
  root.row(2) *= sigma_theta;
  return {{normal(random), normal(random), normal(random)}, root * root.transpose()};
}

Scene RandomScene(std::mt19937& random, int nodes, int edges, int closures, double sigma_theta) {
  Scene scene;
  scene.graph.AddFloor({});
  for (int i = 0; i < nodes; ++i) scene.graph.AddNode({});
  std::uniform_int_distribution<NodeId> any(0, nodes - 1);
  for (int i = 0; i < edges + closures; ++i) {
    const NodeId a = any(random);
    NodeId b = any(random);
    while (b == a) b = any(random);
    const UncertainPose2 T_a_b = RandomTransform(random, sigma_theta);
    if (i < edges) {
      scene.graph.AddEdge({a, b, T_a_b, EdgeKind::kOdometry});
    } else {
      Closure closure;
      closure.older = a;
      closure.newer = b;
      closure.T_older_newer = T_a_b;
      closure.state = i % 4 == 0 ? ClosureState::kValidated : ClosureState::kHypothesis;
      scene.closures.push_back(closure);
      const auto id = static_cast<ClosureId>(scene.closures.size() - 1);
      scene.search.Add(id, scene.closures.back());
    }
  }
  return scene;
}

struct Link {
  NodeId from, to;
  UncertainPose2 T_from_to;
  int unvalidated;
};

// Every edge of the search in both directions.
std::vector<Link> Links(const Scene& scene) {
  std::vector<Link> links;
  const auto add = [&](NodeId a, NodeId b, const UncertainPose2& T_a_b, int unvalidated) {
    links.push_back({a, b, T_a_b, unvalidated});
    links.push_back({b, a, Inverse(T_a_b), unvalidated});
  };
  for (const Edge& edge : scene.graph.edges()) add(edge.from, edge.to, edge.T_from_to, 0);
  for (const Closure& closure : scene.closures) {
    add(closure.older, closure.newer, closure.T_older_newer,
        closure.state == ClosureState::kValidated ? 0 : 1);
  }
  return links;
}

TEST(LoopSearch, FindsTheLeastOfAllPathsWhereTheTraceIsAdditive) {
  std::mt19937 random(1);
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene = RandomScene(random, 6, 5, 5, 0.0);
    const std::vector<Link> links = Links(scene);
    using Cost = std::pair<int, double>;
    std::optional<Cost> least;
    std::vector<bool> on_path(6, false);
    const std::function<void(NodeId, Cost)> walk = [&](NodeId node, Cost cost) {
      if (node == 5) {
        if (!least || cost < *least) least = cost;
        return;
      }
      on_path[static_cast<std::size_t>(node)] = true;
      for (const Link& link : links) {
        if (link.from != node || on_path[static_cast<std::size_t>(link.to)]) continue;
        walk(link.to,
             {cost.first + link.unvalidated, cost.second + link.T_from_to.covariance.trace()});
      }
      on_path[static_cast<std::size_t>(node)] = false;
    };
    walk(0, {0, 0.0});
    const auto path = scene.search.Find(scene.graph, scene.closures, 0, 5, RemovedSteps());
    ASSERT_EQ(path.has_value(), least.has_value());
    if (!path) continue;
    ++found;
    EXPECT_EQ(path->unvalidated, least->first);
    EXPECT_NEAR(path->T_from_to.covariance.trace(), least->second, 1e-9 * (1.0 + least->second));
  }
  EXPECT_GT(found, 100);
}

TEST(LoopSearch, ThePathIsWhatItsStepsCompose) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    Scene scene = RandomScene(random, 8, 7, 6, 0.3);
    const auto path = scene.search.Find(scene.graph, scene.closures, 0, 7, RemovedSteps());
    if (!path) continue;
    UncertainPose2 T;
    NodeId at = 0;
    int unvalidated = 0;
    for (const PathStep& step : path->steps) {
      ASSERT_NE(step.edge >= 0, step.closure >= 0);
      Link link{};
      if (step.edge >= 0) {
        const Edge& edge = scene.graph.edges()[static_cast<std::size_t>(step.edge)];
        link = {edge.from, edge.to, edge.T_from_to, 0};
      } else {
        const Closure& closure = scene.closures[static_cast<std::size_t>(step.closure)];
        link = {closure.older, closure.newer, closure.T_older_newer,
                closure.state == ClosureState::kValidated ? 0 : 1};
      }
      T = T * (link.from == at ? link.T_from_to : Inverse(link.T_from_to));
      at = link.from == at ? link.to : link.from;
      EXPECT_EQ(at, step.to);
      EXPECT_GE(step.ways, 1);
      unvalidated += link.unvalidated;
    }
    EXPECT_EQ(at, 7);
    EXPECT_EQ(unvalidated, path->unvalidated);
    EXPECT_LT((T.covariance - path->T_from_to.covariance).norm(),
              1e-9 * (1.0 + T.covariance.norm()));
    EXPECT_LT(Distance(T.mean, path->T_from_to.mean), 1e-9) << "m";
  }
}

TEST(LoopSearch, ALongValidatedWayGoesBeforeAShortUnvalidatedOne) {
  Scene scene;
  scene.graph.AddFloor({});
  for (int i = 0; i < 3; ++i) scene.graph.AddNode({});
  const UncertainPose2 unsure{{1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()};
  scene.graph.AddEdge({0, 1, unsure, EdgeKind::kOdometry});
  scene.graph.AddEdge({1, 2, unsure, EdgeKind::kOdometry});
  Closure closure;
  closure.older = 2;
  closure.newer = 0;
  closure.T_older_newer = {{-2.0, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()};
  scene.closures.push_back(closure);
  scene.search.Add(0, scene.closures[0]);
  RemovedSteps removed;
  auto path = scene.search.Find(scene.graph, scene.closures, 0, 2, removed);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->unvalidated, 0);
  // Taken away, it leaves the way to the other.
  removed.Add({0, -1, 1, 1});
  path = scene.search.Find(scene.graph, scene.closures, 0, 2, removed);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->unvalidated, 1);
  EXPECT_NEAR(path->T_from_to.mean.x, 2.0, 1e-12) << "m";
  removed.Add(path->steps[0]);
  EXPECT_FALSE(scene.search.Find(scene.graph, scene.closures, 0, 2, removed));
  RemovedSteps odometry;
  odometry.Add({0, -1, 1, 1});
  EXPECT_TRUE(scene.search.Find(scene.graph, scene.closures, 0, 2, odometry));
  scene.search.Drop(0, scene.closures[0]);
  EXPECT_FALSE(scene.search.Find(scene.graph, scene.closures, 0, 2, odometry));
}

TEST(LoopSearch, TheMostRedundantStepIsWhereMostWaysMeet) {
  // 0 - 1 - 4 - 5, with two more ways from 0 to 4: over 2 and over 3.
  Scene scene;
  scene.graph.AddFloor({});
  for (int i = 0; i < 6; ++i) scene.graph.AddNode({});
  const auto add = [&](NodeId a, NodeId b, double variance) {
    scene.graph.AddEdge(
        {a, b, {{1.0, 0.0, 0.0}, variance * Eigen::Matrix3d::Identity()}, EdgeKind::kOdometry});
  };
  add(0, 1, 0.10);
  add(1, 4, 0.30);
  add(0, 2, 0.11);
  add(2, 4, 0.40);
  add(0, 3, 0.12);
  add(3, 4, 0.50);
  add(4, 5, 0.10);
  const auto path = scene.search.Find(scene.graph, scene.closures, 0, 5, RemovedSteps());
  ASSERT_TRUE(path);
  ASSERT_EQ(path->steps.size(), 3u);
  EXPECT_EQ(path->steps[0].ways, 1);
  EXPECT_EQ(path->steps[1].ways, 3);
  EXPECT_EQ(path->steps[2].ways, 1);
  EXPECT_EQ(MostRedundantStep(*path).edge, 1);
}

TEST(LoopSearch, AmongEquallyRedundantStepsTheMiddleOneGoes) {
  LeastErrorPath path;
  for (EdgeId i = 0; i < 5; ++i) path.steps.push_back({i, -1, i + 1, 1});
  EXPECT_EQ(MostRedundantStep(path).edge, 2);
  path.steps.pop_back();
  EXPECT_EQ(MostRedundantStep(path).edge, 1);
  path.steps[3].ways = 2;
  EXPECT_EQ(MostRedundantStep(path).edge, 3);
}

}  // namespace
}  // namespace masked_mapper
