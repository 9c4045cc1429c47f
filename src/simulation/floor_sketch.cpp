// SPDX-License-Identifier: BSD-3-Clause
#include "floor_sketch.hpp"

#include <algorithm>
#include <utility>

namespace masked_mapper {
namespace {

constexpr double kInside = 1e-6;    // m, nearer to an edge than this is on it
constexpr double kShortest = 1e-4;  // m, shorter remains are no walls

struct Box {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

Box BoxOf(const ConvexSpace& space) {
  Box box{space.corners.front(), space.corners.front()};
  for (const Eigen::Vector2d& corner : space.corners) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  return box;
}

bool Apart(const Box& a, const Box& b, double gap) {
  return a.high.x() + gap < b.low.x() || b.high.x() + gap < a.low.x() ||
         a.high.y() + gap < b.low.y() || b.high.y() + gap < a.low.y();
}

/// Unit normal of an edge, into a counter-clockwise polygon.
Eigen::Vector2d InwardNormal(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return Eigen::Vector2d(a.y() - b.y(), b.x() - a.x()).normalized();
}

/// The part of the edge a-b, as fractions, that lies inside a space; empty when first >= second.
std::pair<double, double> PartInside(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                     const ConvexSpace& space) {
  double first = 0.0;
  double last = 1.0;
  for (std::size_t i = 0; i < space.corners.size(); ++i) {
    const Eigen::Vector2d& corner = space.corners[i];
    const Eigen::Vector2d& next = space.corners[(i + 1) % space.corners.size()];
    const Eigen::Vector2d normal = InwardNormal(corner, next);
    const double at_a = normal.dot(a - corner) - kInside;
    const double at_b = normal.dot(b - corner) - kInside;
    if (at_a <= 0.0 && at_b <= 0.0) return {1.0, 0.0};
    if (at_a < 0.0) first = std::max(first, at_a / (at_a - at_b));
    if (at_b < 0.0) last = std::min(last, at_a / (at_a - at_b));
  }
  return {first, last};
}

/// Whether an edge of `a` keeps the two spaces more than `gap` apart.
bool EdgeSeparates(const ConvexSpace& a, const ConvexSpace& b, double gap) {
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    const Eigen::Vector2d& corner = a.corners[i];
    const Eigen::Vector2d normal = InwardNormal(corner, a.corners[(i + 1) % a.corners.size()]);
    const bool all_outside = std::all_of(
        b.corners.begin(), b.corners.end(),
        [&](const Eigen::Vector2d& point) { return normal.dot(point - corner) <= -gap; });
    if (all_outside) return true;
  }
  return false;
}

}  // namespace

ConvexSpace ConvexSpace::Rectangle(const Pose2& T_building_local, double x0, double y0, double x1,
                                   double y1) {
  ConvexSpace space;
  space.corners = {
      T_building_local * Eigen::Vector2d(x0, y0), T_building_local * Eigen::Vector2d(x1, y0),
      T_building_local * Eigen::Vector2d(x1, y1), T_building_local * Eigen::Vector2d(x0, y1)};
  space.surfaces.assign(4, Surface::kWall);
  return space;
}

bool Overlap(const ConvexSpace& a, const ConvexSpace& b, double gap) {
  if (Apart(BoxOf(a), BoxOf(b), gap)) return false;
  return !EdgeSeparates(a, b, gap) && !EdgeSeparates(b, a, gap);
}

std::vector<Segment> Walls(const std::vector<ConvexSpace>& spaces) {
  std::vector<Box> boxes;
  for (const ConvexSpace& space : spaces) boxes.push_back(BoxOf(space));

  std::vector<Segment> walls;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < spaces.size(); ++j) {
      if (j != i && !Apart(boxes[i], boxes[j], 0.0)) near.push_back(j);
    }
    const std::vector<Eigen::Vector2d>& corners = spaces[i].corners;
    for (std::size_t e = 0; e < corners.size(); ++e) {
      if (!spaces[i].surfaces[e]) continue;
      const Eigen::Vector2d& a = corners[e];
      const Eigen::Vector2d& b = corners[(e + 1) % corners.size()];
      std::vector<std::pair<double, double>> hidden;
      for (const std::size_t j : near) {
        const std::pair<double, double> part = PartInside(a, b, spaces[j]);
        if (part.first < part.second) hidden.push_back(part);
      }
      std::sort(hidden.begin(), hidden.end());
      const double length = (b - a).norm();
      double seen = 0.0;
      const auto emit = [&](double from, double to) {
        if ((to - from) * length < kShortest) return;
        walls.push_back({a + from * (b - a), a + to * (b - a), *spaces[i].surfaces[e]});
      };
      for (const auto& [from, to] : hidden) {
        emit(seen, std::max(seen, from));
        seen = std::max(seen, to);
      }
      emit(seen, 1.0);
    }
  }
  return walls;
}

}  // namespace masked_mapper
