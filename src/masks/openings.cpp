// SPDX-License-Identifier: BSD-3-Clause
#include "openings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {
namespace {

// All below is in the laser's position with the robot's heading: the laser is what looks.

struct Beam {
  double angle;  ///< rad, increasing through a scan
  bool is_far;   ///< beyond min_range_m
};

struct View {
  std::vector<Beam> beams;  ///< valid ones, counter-clockwise
  /// Hits, counter-clockwise and twice round, so that any half circle of them is one stretch.
  std::vector<double> angle;  ///< rad, increasing
  std::vector<double> x;      ///< m
  std::vector<double> y;
};

/// Directions of the first and the last beam of a run; rad, `left_angle` >= `right_angle`.
struct Run {
  double right_angle;
  double left_angle;
};

/// A scan point that may become an end-point.
struct EndPoint {
  Eigen::Vector2d point;
  double distance;  ///< to the centre line
  double root;      ///< its square root
};

void TwiceRound(double turn, std::vector<double>& values) {
  const std::size_t size = values.size();
  values.resize(2 * size);
  for (std::size_t i = 0; i < size; ++i) values[size + i] = values[i] + turn;
}

View LookAround(const LaserScan& scan, double min_range_m) {
  View view;
  view.beams.reserve(scan.size());
  for (std::vector<double>* values : {&view.angle, &view.x, &view.y}) {
    values->reserve(2 * scan.size());
  }
  auto direction = BeamSweep::InRobot(scan);
  for (std::size_t beam = 0; beam < scan.size(); ++beam, direction.Advance()) {
    const double range = scan.ranges[beam];
    if (std::isnan(range)) continue;
    const double angle = scan.T_robot_laser.theta + scan.Angle(beam);
    const bool is_hit = scan.IsHit(beam);
    view.beams.push_back({angle, !is_hit || range > min_range_m});
    if (!is_hit) continue;
    view.angle.push_back(angle);
    view.x.push_back(range * direction.Current().x());
    view.y.push_back(range * direction.Current().y());
  }
  if (scan.angle_step < 0.0) {
    std::reverse(view.beams.begin(), view.beams.end());
    for (std::vector<double>* values : {&view.angle, &view.x, &view.y}) {
      std::reverse(values->begin(), values->end());
    }
  }
  TwiceRound(2.0 * kPi, view.angle);
  TwiceRound(0.0, view.x);
  TwiceRound(0.0, view.y);
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

/// (b) What one end of a run is chosen from: the hits on one side of the centre line, beside its
/// first `max_depth_m`. Keeps its memory from run to run.
class Side {
 public:
  /// The side between two directions a quarter turn apart, of which one is the centre line's.
  void Look(const View& view, double centre_angle, double other_angle, double max_depth_m,
            const EndPoint& original) {
    view_ = &view;
    original_ = original;
    const auto hit_at = [&](double angle) {
      return static_cast<std::size_t>(
          std::lower_bound(view.angle.begin(), view.angle.end(), angle) - view.angle.begin());
    };
    first_ = hit_at(std::min(centre_angle, other_angle));
    size_ = hit_at(std::max(centre_angle, other_angle)) - first_;
    if (distances_.size() < size_) distances_.resize(view.x.size());
    const Eigen::Vector2d line = UnitVector(centre_angle);
    const double* x = view.x.data() + first_;
    const double* y = view.y.data() + first_;
    for (std::size_t i = 0; i < size_; ++i) {
      const double depth = line.x() * x[i] + line.y() * y[i];
      const double distance = std::abs(line.x() * y[i] - line.y() * x[i]);
      distances_[i] = depth <= max_depth_m ? distance : kBeyond;
    }
  }

  /// The original end-point stays where no hit is at hand.
  EndPoint NearestToLine() const {
    return Least([this](std::size_t i) { return distances_[i]; });
  }
  EndPoint NearestTo(const EndPoint& opposite) const {
    return Least([&](std::size_t i) {
      return distances_[i] < kBeyond ? (Hit(i) - opposite.point).squaredNorm() : kBeyond;
    });
  }
  /// The hits up to a distance from the line.
  const std::vector<EndPoint>& Candidates(double max_distance) {
    candidates_.clear();
    for (std::size_t i = 0; i < size_; ++i) {
      if (distances_[i] <= max_distance) candidates_.push_back(At(i));
    }
    if (candidates_.empty()) candidates_.push_back(original_);
    return candidates_;
  }

 private:
  static constexpr double kBeyond = std::numeric_limits<double>::infinity();

  Eigen::Vector2d Hit(std::size_t i) const { return {view_->x[first_ + i], view_->y[first_ + i]}; }
  EndPoint At(std::size_t i) const { return {Hit(i), distances_[i], std::sqrt(distances_[i])}; }

  template <typename Measure>
  EndPoint Least(const Measure& measure) const {
    std::size_t best = size_;
    double least = kBeyond;
    for (std::size_t i = 0; i < size_; ++i) {
      const double value = measure(i);
      if (value >= least) continue;
      least = value;
      best = i;
    }
    return best == size_ ? original_ : At(best);
  }

  const View* view_ = nullptr;
  EndPoint original_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::vector<double> distances_;  ///< of the hits from `first_` on; infinite beyond the depth
  std::vector<EndPoint> candidates_;
};

struct EndPair {
  EndPoint right;
  EndPoint left;
};

double Cost(const EndPoint& right, const EndPoint& left) {
  return (left.point - right.point).norm() + right.root + left.root;
}

/// (b) The pair of least cost; the result is that of trying all pairs. The centre line runs between
/// the two ends, so the width is at least the sum of their distances d from it, and a pair costs at
/// least d + sqrt(d) for each end: most hits are out when one good pair is known.
EndPair NarrowestPlace(Side& right_side, Side& left_side) {
  EndPair best{right_side.NearestToLine(), left_side.NearestToLine()};
  double least = Cost(best.right, best.left);
  const double least_right = best.right.distance + best.right.root;
  const double least_left = best.left.distance + best.left.root;
  const auto try_pair = [&](const EndPoint& right, const EndPoint& left) {
    const double width_to_beat = least - right.root - left.root;
    if (width_to_beat <= 0.0) return;
    if ((left.point - right.point).squaredNorm() >= width_to_beat * width_to_beat) return;
    least = Cost(right, left);
    best = {right, left};
  };
  // One end after the other comes close.
  try_pair(best.right, left_side.NearestTo(best.right));
  try_pair(right_side.NearestTo(best.left), best.left);

  // d + sqrt(d) <= bound, solved for d; a little more for rounding.
  const auto max_distance = [&](double least_opposite) {
    const double bound = std::max(0.0, least - least_opposite);
    const double root = 0.5 * (std::sqrt(1.0 + 4.0 * bound) - 1.0);
    return root * root + 1e-9;
  };
  const std::vector<EndPoint>& lefts = left_side.Candidates(max_distance(least_right));
  for (const EndPoint& right : right_side.Candidates(max_distance(least_left))) {
    for (const EndPoint& left : lefts) try_pair(right, left);
  }
  return best;
}

/// (b) The original end-points are where the run leaves the circle of `min_range_m`. Both are
/// equally far, so the centre line through their mean halves the run; for a run of more than 180
/// degrees it still points into it.
Opening Refine(const View& view, const Run& run, const OpeningOptions& options, Side& right_side,
               Side& left_side) {
  double centre_angle = 0.5 * (run.right_angle + run.left_angle);
  // The half circle about it must begin within the first round of the view.
  const double first_angle = view.beams.front().angle;
  centre_angle -= 2.0 * kPi * std::floor((centre_angle - 0.5 * kPi - first_angle) / (2.0 * kPi));
  const auto original = [&](double angle) -> EndPoint {
    return {options.min_range_m * UnitVector(angle), 0.0, 0.0};
  };
  right_side.Look(view, centre_angle, centre_angle - 0.5 * kPi, options.max_depth_m,
                  original(run.right_angle));
  left_side.Look(view, centre_angle, centre_angle + 0.5 * kPi, options.max_depth_m,
                 original(run.left_angle));
  const EndPair ends = NarrowestPlace(right_side, left_side);

  const Eigen::Vector2d& r = ends.right.point;
  const Eigen::Vector2d& l = ends.left.point;
  Opening opening;
  opening.right_in_robot = r;
  opening.left_in_robot = l;
  opening.width = (l - r).norm();
  opening.angle = std::atan2(Cross(r, l), r.dot(l));
  if (opening.angle < 0.0) opening.angle += 2.0 * kPi;
  // The middle as seen, and not the direction to the middle point: in a corridor the narrowest
  // place is often beside the robot, where a robot off the corridor's axis has its middle point
  // abeam.
  opening.direction = WrapAngle(std::atan2(r.y(), r.x()) + 0.5 * opening.angle);
  return opening;
}

}  // namespace

std::vector<Opening> FindOpenings(const LaserScan& scan, const OpeningOptions& options) {
  const View view = LookAround(scan, options.min_range_m);
  std::vector<Opening> openings;
  Side right_side;
  Side left_side;
  // Neighbours are a step apart; half a step of slack for rounding.
  const double max_gap = DegToRad(options.max_gap_deg) + 1.5 * std::abs(scan.angle_step);
  for (const Run& run : CutRuns(view.beams, scan.IsFullCircle(), max_gap)) {
    Opening opening = Refine(view, run, options, right_side, left_side);
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
