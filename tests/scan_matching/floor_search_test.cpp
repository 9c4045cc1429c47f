// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/floor_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scan_matching/box_scene.hpp"

namespace masked_mapper {
namespace {

ScanPoints SeenFrom(const BoxScene& scene, const Pose2& T_world_robot, bool in_world) {
  ScanPoints points;
  const ScanPoints::ConstPtr scan = PointsInRobot(scene.Scan(T_world_robot, 361, 360.0));
  for (const pcl::PointXY& point : *scan) {
    const Eigen::Vector2d moved = in_world ? T_world_robot * Eigen::Vector2d(point.x, point.y)
                                           : Eigen::Vector2d(point.x, point.y);
    pcl::PointXY plain;
    plain.x = static_cast<float>(moved.x());
    plain.y = static_cast<float>(moved.y());
    points.push_back(plain);
  }
  return points;
}

FloorSearchOptions Small() {
  FloorSearchOptions options;
  options.point_spacing_m = 0.3;
  return options;
}

TEST(FloorSearch, FindsAPlaceAtAnyHeading) {
  const BoxScene room = FurnishedRoom();
  const FloorSearch search(SeenFrom(room, {1.0, 0.5, 0.3}, true), Small());
  for (int heading_deg = -180; heading_deg < 180; heading_deg += 37) {
    const Pose2 truth{0.6, 0.8, DegToRad(heading_deg)};
    const auto fit = search.Find(search.Thinned(SeenFrom(room, truth, false)));
    ASSERT_TRUE(fit) << heading_deg << " deg";
    EXPECT_LT(Distance(fit->T_world_place, truth), 0.4) << "m, at " << heading_deg << " deg";
    EXPECT_LT(std::abs(WrapAngle(fit->T_world_place.theta - truth.theta)), DegToRad(4.0));
  }
}

// No pose of a lattice as fine as the search's own fits better than what the search gives.
TEST(FloorSearch, NoPlaceByBruteForceFitsBetter) {
  const BoxScene room = FurnishedRoom();
  const FloorSearchOptions options = Small();
  const FloorSearch search(SeenFrom(room, {1.0, 0.5, 0.3}, true), options);
  const auto points = search.Thinned(SeenFrom(room, {0.2, 1.0, 2.0}, false));
  const auto fit = search.Find(points);
  ASSERT_TRUE(fit);
  const auto score_at = [&](const Pose2& T_world_place) {
    double sum = 0.0;
    for (const Eigen::Vector2d& point : points) sum += search.ValueAt(T_world_place * point);
    return sum / static_cast<double>(points.size());
  };
  EXPECT_NEAR(score_at(fit->T_world_place), fit->score, 0.02);
  for (double x = -6.0; x <= 6.0; x += options.resolution_m) {
    for (double y = -6.0; y <= 6.0; y += options.resolution_m) {
      for (double deg = -180.0; deg < 180.0; deg += options.angle_step_deg) {
        // Another lattice rounds otherwise, by a part of a cell.
        ASSERT_LT(score_at({x, y, DegToRad(deg)}), fit->score + 0.05)
            << x << " " << y << " " << deg;
      }
    }
  }
}

// All that fits is found, or something better no farther away than a box of poses and what counts
// as one place with it.
TEST(FloorSearch, AllThatFitsIsFoundOrSomethingBetterNearby) {
  const BoxScene room = FurnishedRoom();
  const FloorSearchOptions options = Small();
  const FloorSearch search(SeenFrom(room, {1.0, 0.5, 0.3}, true), options);
  const auto points = search.Thinned(SeenFrom(room, {0.2, 1.0, 2.0}, false));
  constexpr double kLeast = 0.4;
  constexpr double kApart = 0.5;  // m
  constexpr double kApartDeg = 8.0;
  const auto all = search.FindAll(points, kLeast, kApart, kApartDeg);
  const auto best = search.Find(points);
  ASSERT_TRUE(best);
  ASSERT_GT(all.size(), 1U);
  EXPECT_NEAR(all.front().score, best->score, 1e-3);
  const auto turned = [](const Pose2& a, const Pose2& b) {
    return std::abs(WrapAngle(a.theta - b.theta));
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_GE(all[i].score, kLeast);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_LE(all[i].score, all[k].score);
      EXPECT_TRUE(Distance(all[i].T_world_place, all[k].T_world_place) >= kApart ||
                  turned(all[i].T_world_place, all[k].T_world_place) >= DegToRad(kApartDeg));
    }
  }
  const double box_m = std::hypot(3.2, 3.2) + kApart;  // eight cells, and twice the distance
  int fitting = 0;
  for (double x = -6.0; x <= 6.0; x += options.resolution_m) {
    for (double y = -6.0; y <= 6.0; y += options.resolution_m) {
      for (double deg = -180.0; deg < 180.0; deg += options.angle_step_deg) {
        const Pose2 pose{x, y, DegToRad(deg)};
        double sum = 0.0;
        for (const Eigen::Vector2d& point : points) sum += search.ValueAt(pose * point);
        const double score = sum / static_cast<double>(points.size());
        if (score < kLeast + 0.05) continue;  // another lattice rounds otherwise
        ++fitting;
        EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                                [&](const PlaceFit& fit) {
                                  return fit.score > score - 0.05 &&
                                         Distance(fit.T_world_place, pose) <= box_m &&
                                         turned(fit.T_world_place, pose) <=
                                             DegToRad(45.0 + kApartDeg);
                                }))
            << x << " " << y << " " << deg;
      }
    }
  }
  EXPECT_GT(fitting, 1);
}

TEST(FloorSearch, NearAGuessOnlyThereIsLooked) {
  const BoxScene room = FurnishedRoom();
  const FloorSearch search(SeenFrom(room, {1.0, 0.5, 0.3}, true), Small());
  const Pose2 truth{0.6, 0.8, 0.2};
  const auto points = search.Thinned(SeenFrom(room, truth, false));
  const PlaceFit near = search.FindNear(points, {1.1, 0.4, 0.25}, 1.0, 6.0);
  EXPECT_LT(Distance(near.T_world_place, truth), 0.4) << "m";
  const PlaceFit far = search.FindNear(points, {3.0, 0.8, 0.2}, 0.8, 4.0);
  EXPECT_LE(std::abs(far.T_world_place.x - 3.0), 0.8 + 1e-9);
  EXPECT_LT(far.score, near.score);
}

TEST(FloorSearch, NothingIsFoundInNothing) {
  const FloorSearch nothing({}, {});
  EXPECT_FALSE(nothing.HasFloor());
  EXPECT_FALSE(nothing.Find({{1.0, 2.0}}));
  EXPECT_TRUE(nothing.FindAll({{1.0, 2.0}}, 0.5, 1.0, 8.0).empty());
  EXPECT_EQ(nothing.FindNear({{1.0, 2.0}}, {1.0, 1.0, 0.0}, 1.0, 1.0).score, 0.0);
  const FloorSearch search(SeenFrom(FurnishedRoom(), {}, true), {});
  EXPECT_FALSE(search.Find({}));
  ScanPoints far;
  pcl::PointXY point;
  point.x = 1e30F;
  point.y = 0.0F;
  far.push_back(point);
  EXPECT_FALSE(FloorSearch(far, {}).HasFloor()) << "no table of that size";
  far[0].x = 9000.0F;
  point.x = -9000.0F;
  point.y = 9000.0F;
  far.push_back(point);
  EXPECT_FALSE(FloorSearch(far, {}).HasFloor()) << "no table of that size";
}

}  // namespace
}  // namespace masked_mapper
