// SPDX-License-Identifier: BSD-3-Clause
// The shortest way through a simulated building itself, by another method than the program's: a
// graph of who sees whom among points around every end of a wall. Never longer than the true
// shortest way of a robot of that radius, and shorter by millimetres a turn.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

class TrueWays {
 public:
  TrueWays(std::vector<Segment> standing, double radius_m) : standing_(std::move(standing)) {
    constexpr int kAround = 12;
    kept_m_ = radius_m * std::cos(M_PI / kAround);
    std::vector<Eigen::Vector2d> ends;
    for (const Segment& segment : standing_) {
      for (const Eigen::Vector2d& end : {segment.a, segment.b}) {
        const bool is_known = std::any_of(ends.begin(), ends.end(), [&](const auto& other) {
          return (other - end).norm() < 1e-6;
        });
        if (!is_known) ends.push_back(end);
      }
    }
    for (const Eigen::Vector2d& end : ends) {
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2.0 * M_PI * i / kAround;
        const Eigen::Vector2d corner =
            end + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        if (IsFree(corner, corner)) corners_.push_back(corner);
      }
    }
  }

  /// m; infinity: no way.
  double Length(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    std::vector<Eigen::Vector2d> points = corners_;
    points.push_back(to);
    points.push_back(from);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<double> length(points.size(), kNever);
    std::vector<bool> is_done(points.size());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    length.back() = 0.0;
    open.push({0.0, points.size() - 1});
    while (!open.empty()) {
      const std::size_t at = open.top().second;
      open.pop();
      if (is_done[at]) continue;
      is_done[at] = true;
      if (at == corners_.size()) return length[at];
      for (std::size_t next = 0; next < points.size(); ++next) {
        if (is_done[next]) continue;
        const double longer = length[at] + (points[next] - points[at]).norm();
        if (longer >= length[next] || !IsFree(points[at], points[next])) continue;
        length[next] = longer;
        open.push({longer + (to - points[next]).norm(), next});
      }
    }
    return kNever;
  }

 private:
  /// Whether the straight way keeps clear of everything.
  bool IsFree(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const double low_x = std::min(a.x(), b.x()) - kept_m_;
    const double high_x = std::max(a.x(), b.x()) + kept_m_;
    const double low_y = std::min(a.y(), b.y()) - kept_m_;
    const double high_y = std::max(a.y(), b.y()) + kept_m_;
    for (const Segment& wall : standing_) {
      if (std::max(wall.a.x(), wall.b.x()) < low_x || std::min(wall.a.x(), wall.b.x()) > high_x ||
          std::max(wall.a.y(), wall.b.y()) < low_y || std::min(wall.a.y(), wall.b.y()) > high_y) {
        continue;
      }
      if (Crosses(a, b, wall)) return false;
      const double off =
          std::min({DistanceToSegment(a, wall.a, wall.b), DistanceToSegment(b, wall.a, wall.b),
                    DistanceToSegment(wall.a, a, b), DistanceToSegment(wall.b, a, b)});
      if (off < kept_m_ - 1e-9) return false;
    }
    return true;
  }

  static bool Crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Segment& wall) {
    const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                         const Eigen::Vector2d& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    return side(a, b, wall.a) * side(a, b, wall.b) < 0.0 &&
           side(wall.a, wall.b, a) * side(wall.a, wall.b, b) < 0.0;
  }

  std::vector<Segment> standing_;
  double kept_m_ = 0.0;
  std::vector<Eigen::Vector2d> corners_;
};

}  // namespace masked_mapper
