// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/masks/openings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "masked_mapper/sensor/beam_directions.hpp"

namespace masked_mapper {
namespace {

// All below is in the laser's position with the robot's heading: the laser is what looks.

struct Beam {
  double angle;  ///< rad, increasing through a scan
  bool is_far;   ///< beyond min_range_m
};

struct View {
  std::vector<Beam> beams;              ///< valid ones, counter-clockwise
  std::vector<Eigen::Vector2d> points;  ///< hits, in beam order
};

/// Directions of the first and the last beam of a run; rad, `left_angle` >= `right_angle`.
struct Run {
  double right_angle;
  double left_angle;
};

/// A scan point that may become an end-point.
struct EndPoint {
  Eigen::Vector2d point;
  double root;  ///< square root of the distance to the centre line
  double
      bound;  ///< the least that it can add to the cost: its own distance to the line, and `root`
};

View LookAround(const LaserScan& scan, double min_range_m) {
  View view;
  view.beams.reserve(scan.size());
  view.points.reserve(scan.size());
  auto direction = BeamDirections::InRobot(scan);
  for (std::size_t beam = 0; beam < scan.size(); ++beam, direction.Advance()) {
    const double range = scan.ranges[beam];
    if (std::isnan(range)) continue;
    const bool is_hit = scan.IsHit(beam);
    view.beams.push_back(
        {scan.T_robot_laser.theta + scan.Angle(beam), !is_hit || range > min_range_m});
    if (is_hit) view.points.emplace_back(range * direction.Current());
  }
  if (scan.angle_step < 0.0) std::reverse(view.beams.begin(), view.beams.end());
  return view;
}

// (a) Runs of far beams. On a full circle a run that begins at the seam is one with that which ends
// there.
std::vector<Run> CutRuns(const std::vector<Beam>& beams, bool is_full_circle, double max_gap) {
  std::vector<Run> runs;
  bool goes_on = false;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!beams[i].is_far) {
      goes_on = false;
      continue;
    }
    if (goes_on && beams[i].angle - beams[i - 1].angle <= max_gap) {
      runs.back().left_angle = beams[i].angle;
    } else {
      runs.push_back({beams[i].angle, beams[i].angle});
    }
    goes_on = true;
  }
  if (!is_full_circle || beams.empty() || !beams.front().is_far || !beams.back().is_far)
    return runs;
  if (beams.front().angle + 2.0 * kPi - beams.back().angle > max_gap) return runs;
  if (runs.size() == 1) return {};  // nothing near anywhere
  runs.front().right_angle = runs.back().right_angle - 2.0 * kPi;
  runs.pop_back();
  return runs;
}

Eigen::Vector2d UnitVector(double angle) { return {std::cos(angle), std::sin(angle)}; }

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double Cost(const EndPoint& right, const EndPoint& left) {
  return (left.point - right.point).norm() + right.root + left.root;
}

const EndPoint& Best(const std::vector<EndPoint>& candidates, const EndPoint& opposite) {
  return *std::min_element(
      candidates.begin(), candidates.end(),
      [&](const EndPoint& a, const EndPoint& b) { return Cost(a, opposite) < Cost(b, opposite); });
}

void DropAbove(double bound, std::vector<EndPoint>& candidates) {
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [=](const EndPoint& end) { return end.bound > bound; }),
                   candidates.end());
}

// (b) The pair of least cost. The width is at least the sum of both distances to the centre line
// that runs between them, which leaves few pairs to try; the result is that of trying all.
Opening NarrowestPlace(std::vector<EndPoint> right, std::vector<EndPoint> left) {
  const auto by_bound = [](const EndPoint& a, const EndPoint& b) { return a.bound < b.bound; };
  EndPoint best_right = *std::min_element(right.begin(), right.end(), by_bound);
  EndPoint best_left = *std::min_element(left.begin(), left.end(), by_bound);
  const double least_right = best_right.bound;
  const double least_left = best_left.bound;
  for (int pass = 0; pass < 2; ++pass) {
    best_right = Best(right, best_left);
    best_left = Best(left, best_right);
  }
  double best_cost = Cost(best_right, best_left);
  DropAbove(best_cost - least_left, right);
  DropAbove(best_cost - least_right, left);
  for (const EndPoint& r : right) {
    for (const EndPoint& l : left) {
      const double width_to_beat = best_cost - r.root - l.root;
      if (width_to_beat <= 0.0) continue;
      if ((l.point - r.point).squaredNorm() >= width_to_beat * width_to_beat) continue;
      best_cost = Cost(r, l);
      best_right = r;
      best_left = l;
    }
  }
  Opening opening;
  opening.right_in_robot = best_right.point;
  opening.left_in_robot = best_left.point;
  return opening;
}

// (b) The original end-points are where the run leaves the circle of `min_range_m`. Both are
// equally far, so the centre line through their mean halves the run; for a run of more than 180
// degrees it still points into it.
Opening Refine(const Run& run, const std::vector<Eigen::Vector2d>& points,
               const OpeningOptions& options) {
  const double middle_angle = 0.5 * (run.right_angle + run.left_angle);
  const Eigen::Vector2d centre_line = UnitVector(middle_angle);
  std::vector<EndPoint> right;
  std::vector<EndPoint> left;
  for (const Eigen::Vector2d& point : points) {
    const double depth = centre_line.dot(point);
    if (!(depth >= 0.0 && depth <= options.max_depth_m)) continue;
    const double side = Cross(centre_line, point);
    const double distance = std::abs(side);
    const double root = std::sqrt(distance);
    if (side > 0.0) left.push_back({point, root, distance + root});
    if (side < 0.0) right.push_back({point, root, distance + root});
  }
  // Where no scan point is at hand the original end-point stays.
  if (right.empty()) right.push_back({options.min_range_m * UnitVector(run.right_angle), 0.0, 0.0});
  if (left.empty()) left.push_back({options.min_range_m * UnitVector(run.left_angle), 0.0, 0.0});

  Opening opening = NarrowestPlace(std::move(right), std::move(left));
  const Eigen::Vector2d& r = opening.right_in_robot;
  const Eigen::Vector2d& l = opening.left_in_robot;
  opening.width = (l - r).norm();
  opening.angle = std::atan2(Cross(r, l), r.dot(l));
  if (opening.angle < 0.0) opening.angle += 2.0 * kPi;
  opening.direction =
      opening.angle < kPi ? std::atan2(r.y() + l.y(), r.x() + l.x()) : WrapAngle(middle_angle);
  return opening;
}

}  // namespace

std::vector<Opening> FindOpenings(const LaserScan& scan, const OpeningOptions& options) {
  const View view = LookAround(scan, options.min_range_m);
  std::vector<Opening> openings;
  // Neighbours are a step apart; half a step of slack for rounding.
  const double max_gap = DegToRad(options.max_gap_deg) + 1.5 * std::abs(scan.angle_step);
  for (const Run& run : CutRuns(view.beams, scan.IsFullCircle(), max_gap)) {
    Opening opening = Refine(run, view.points, options);
    // (c)
    if (opening.width < options.min_width_m) continue;
    if (opening.angle < DegToRad(options.min_angle_deg)) continue;
    opening.right_in_robot += scan.T_robot_laser.Translation();
    opening.left_in_robot += scan.T_robot_laser.Translation();
    openings.push_back(opening);
  }
  return openings;
}

}  // namespace masked_mapper
