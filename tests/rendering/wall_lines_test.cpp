// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/wall_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

using Walls = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

/// A grid of walls, each hit every centimetre with a noise of 2 cm, and of specks.
OccupancyGrid Drawn(const Walls& walls, double noise_m, int specks = 0) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, noise_m > 0.0 ? noise_m : 1e-9);
  OccupancyGrid grid;
  grid.origin_x = grid.origin_y = -1.0;
  grid.width = grid.height = 400;
  std::map<std::size_t, std::pair<Eigen::Vector2d, int>> hits;
  const auto hit = [&](const Eigen::Vector2d& at) {
    const auto column = static_cast<std::size_t>((at.x() + 1.0) / 0.05);
    const auto row = static_cast<std::size_t>((at.y() + 1.0) / 0.05);
    auto& cell = hits[row * 400 + column];
    if (cell.second++ == 0) cell.first.setZero();
    cell.first += at;
  };
  for (const auto& [a, b] : walls) {
    const double length = (b - a).norm();
    for (double at = 0.0; at <= length; at += 0.01) {
      hit(a + (b - a) * (at / length) + Eigen::Vector2d(noise(random), noise(random)));
    }
  }
  for (int i = 0; i < specks; ++i) {
    const auto any = [&] { return 0.03 * static_cast<double>(random() % 500); };
    const Eigen::Vector2d at(any(), any());
    for (int j = 0; j < 3; ++j) hit(at);
  }
  grid.cells.resize(400 * 400, Cell::kFree);
  for (const auto& [index, cell] : hits) {
    if (cell.second < 2) continue;
    grid.cells[index] = Cell::kOccupied;
    const Eigen::Vector2d mean = cell.first / cell.second;
    grid.walls.push_back({static_cast<float>(mean.x()), static_cast<float>(mean.y())});
  }
  return grid;
}

double OffLine(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double along = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (a + std::clamp(along, 0.0, 1.0) * (b - a) - p).norm();
}

/// Share of the length of `lines` that lies within 5 cm of `others`.
double Near(const Walls& lines, const Walls& others) {
  int near = 0;
  int all = 0;
  for (const auto& [a, b] : lines) {
    const int steps = std::max(1, static_cast<int>((b - a).norm() / 0.02));
    for (int i = 0; i <= steps; ++i, ++all) {
      const Eigen::Vector2d p = a + (b - a) * i / steps;
      near += std::any_of(others.begin(), others.end(), [&](const auto& other) {
        return OffLine(p, other.first, other.second) < 0.05;
      });
    }
  }
  return near / std::max(1.0, static_cast<double>(all));
}

Walls AsWalls(const std::vector<WallLine>& lines) {
  Walls walls;
  for (const WallLine& line : lines) walls.emplace_back(line.a, line.b);
  return walls;
}

Walls Turned(const Walls& walls, double angle) {
  Walls turned;
  Eigen::Matrix2d rotation;
  rotation << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Eigen::Vector2d middle(8.0, 8.0);
  for (const auto& [a, b] : walls) {
    turned.emplace_back(middle + rotation * (a - middle), middle + rotation * (b - middle));
  }
  return turned;
}

/// Two rooms with a door between them, a wall of two faces, and a piece of furniture askew.
const Walls kRooms = {{{2, 2}, {13, 2}},      {{13, 2}, {13, 9}},     {{13, 9}, {2, 9}},
                      {{2, 9}, {2, 2}},       {{7, 2}, {7, 5}},       {{7, 6}, {7, 9}},
                      {{7.12, 2}, {7.12, 5}}, {{7.12, 6}, {7.12, 9}}, {{9, 4}, {10.5, 4.7}}};

TEST(WallLines, AreTheWallsThatWereDrawn) {
  for (const double angle : {0.0, 0.1, 0.5, 0.78, 1.3}) {
    for (const double noise : {0.0, 0.02}) {
      const Walls walls = Turned(kRooms, angle);
      const Walls lines = AsWalls(FitWallLines(Drawn(walls, noise, 40)));
      EXPECT_GT(Near(lines, walls), 0.98) << angle << " " << noise;
      EXPECT_GT(Near(walls, lines), 0.97) << angle << " " << noise;
      EXPECT_LT(lines.size(), 16U) << angle << " " << noise;
    }
  }
}

TEST(WallLines, LeaveDoorsOpen) {
  const Walls lines = AsWalls(FitWallLines(Drawn(kRooms, 0.02)));
  EXPECT_LT(Near({{{7.06, 5.2}, {7.06, 5.8}}}, lines), 0.01);
}

TEST(WallLines, TellTheDirectionOfTheBuilding) {
  for (const double angle : {-0.7, -0.2, 0.0, 0.003, 0.5, 0.78}) {
    const auto direction = DirectionOf(FitWallLines(Drawn(Turned(kRooms, angle), 0.02, 40)));
    ASSERT_TRUE(direction);
    EXPECT_LT(std::abs(std::remainder(direction->angle - angle, M_PI / 2)), DegToRad(0.1)) << angle;
    EXPECT_LE(std::abs(direction->angle), M_PI / 4 + 1e-9);
  }
}

TEST(WallLines, TellHowSureADirectionIs) {
  const auto wall = [](double x, double length, double off_deg) {
    const double angle = DegToRad(off_deg);
    return WallLine{{x, 0.0}, {x + length * std::cos(angle), length * std::sin(angle)}};
  };
  std::vector<WallLine> walls;
  for (int i = -5; i <= 5; ++i) walls.push_back(wall(i, 3.0, 0.1 * i));
  for (int i = 0; i < 4; ++i) walls.push_back(wall(i, 2.9, 1.2));  // cupboards askew
  const auto direction = DirectionNear(0.0, walls);
  ASSERT_TRUE(direction);
  EXPECT_NEAR(RadToDeg(direction->angle), 0.0, 0.25);
  EXPECT_GT(RadToDeg(direction->sigma), 0.05);
  EXPECT_LT(RadToDeg(direction->sigma), 0.4);
  EXPECT_FALSE(DirectionNear(DegToRad(30.0), walls));
  walls.resize(2);
  EXPECT_TRUE(std::isinf(DirectionOf(walls)->sigma));
}

TEST(WallLines, OfNothingAreNone) {
  EXPECT_TRUE(FitWallLines(OccupancyGrid{}).empty());
  EXPECT_FALSE(DirectionOf({}));
  OccupancyGrid speck;
  speck.width = speck.height = 1;
  speck.cells = {Cell::kOccupied};
  speck.walls = {{0.02F, 0.02F}};
  EXPECT_TRUE(FitWallLines(speck).empty());
}

}  // namespace
}  // namespace masked_mapper
