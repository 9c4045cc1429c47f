// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/glass_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

TEST(GlassWalls, BeamsHaveTheAxisNearestToThem) {
  for (double angle = 0.01; angle < 2.0 * kPi; angle += 0.03) {
    double nearest = kPi;
    std::size_t axis = 0;
    for (std::size_t i = 0; i < kBeamAxes; ++i) {
      const double off = std::abs(std::remainder(angle - static_cast<double>(i) * kPi / 4.0, kPi));
      if (off < nearest) axis = i;
      nearest = std::min(nearest, off);
    }
    EXPECT_EQ(BeamAxisOf(std::lround(1e6 * std::cos(angle)), std::lround(1e6 * std::sin(angle))),
              axis)
        << angle;
  }
}

/// A corridor between y = -1 and a pane at y = 1 with a wall at y = 4 behind it, driven along x.
class BesideGlass {
 public:
  /// `turned`: the building, rad. Somebody in the pane's stead stands there while the robot passes.
  explicit BesideGlass(double turned, bool is_somebody = false)
      : turned_(turned), is_somebody_(is_somebody) {
    for (int i = 0; i <= 60; ++i) scans_.push_back(ScanAt(-6.0 + 0.2 * i));
  }

  OccupancyGrid Grid(bool glass) const {
    std::vector<PosedScan> posed;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      const double x = -6.0 + 0.2 * static_cast<double>(i);
      posed.push_back({T_world_corridor() * Pose2{x, 0.0, 0.0}, 0, &scans_[i]});
    }
    GridOptions options;
    options.glass = glass;
    return RenderGrid(posed, 0, options);
  }

  /// Share of the pane, of its middle metres, where a wall stands.
  static double Kept(const OccupancyGrid& grid, const Pose2& T_world_corridor, double from,
                     double to) {
    int kept = 0;
    int all = 0;
    for (double x = from; x < to; x += 0.02, ++all) {
      const Eigen::Vector2d at = T_world_corridor * Eigen::Vector2d(x, 1.0);
      kept += std::any_of(grid.walls.begin(), grid.walls.end(), [&](const WallPoint& wall) {
        return (Eigen::Vector2d(wall.x, wall.y) - at).norm() < 0.08;
      });
    }
    return static_cast<double>(kept) / all;
  }

  Pose2 T_world_corridor() const { return {0.013, 0.021, turned_}; }

 private:
  LaserScan ScanAt(double x) {
    LaserScan scan;
    scan.first_angle = -kPi;
    scan.angle_step = DegToRad(0.5);
    scan.max_range = 30.0F;
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (std::size_t beam = 0; beam < 720; ++beam) {
      const double s = std::sin(scan.Angle(beam));
      const double to_pane = 1.0 / std::max(s, 1e-6);
      const double met = x + to_pane * std::cos(scan.Angle(beam));
      const bool is_stopped =
          is_somebody_ ? std::abs(met) < 0.15 && std::abs(x) < 0.5 : chance(random_) < 0.45 * s * s;
      const double range =
          s > 0.0 ? (is_stopped ? to_pane : 4.0 * to_pane) : 1.0 / std::max(-s, 1e-6);
      scan.ranges.push_back(static_cast<float>(std::min(range, 31.0)));
    }
    return scan;
  }

  double turned_;
  bool is_somebody_;
  std::mt19937 random_{3};
  std::vector<LaserScan> scans_;
};

TEST(GlassWalls, StayWhereBeamsMetThemSquarely) {
  for (const double turned : {0.0, 0.3, kPi / 8.0, 0.7, 2.0}) {
    const BesideGlass drive(turned);
    const Pose2 T_world_corridor = drive.T_world_corridor();
    EXPECT_GT(BesideGlass::Kept(drive.Grid(true), T_world_corridor, -4.0, 4.0), 0.95) << turned;
    EXPECT_LT(BesideGlass::Kept(drive.Grid(false), T_world_corridor, -4.0, 4.0), 0.8) << turned;
  }
}

TEST(GlassWalls, AreWiderThanSomebody) {
  const BesideGlass drive(0.0, true);
  EXPECT_EQ(BesideGlass::Kept(drive.Grid(true), drive.T_world_corridor(), -0.2, 0.2), 0.0);
}

TEST(GlassWalls, AreInTheOrderOfCells) {
  const OccupancyGrid grid = BesideGlass(0.3).Grid(true);
  std::size_t wall = 0;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kOccupied) continue;
      ASSERT_LT(wall, grid.walls.size());
      EXPECT_NEAR(grid.walls[wall].x, grid.origin_x + (column + 0.5) * grid.resolution_m, 0.026);
      EXPECT_NEAR(grid.walls[wall].y, grid.origin_y + (row + 0.5) * grid.resolution_m, 0.026);
      ++wall;
    }
  }
  EXPECT_EQ(wall, grid.walls.size());
}

}  // namespace
}  // namespace masked_mapper
