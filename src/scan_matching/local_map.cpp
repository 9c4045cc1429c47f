// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/local_map.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "surface_normals.hpp"

namespace masked_mapper {
namespace {

double Square(double value) { return value * value; }

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map)
    : options_(options) {
  width_ = 2 * static_cast<int>(std::ceil(options.reach_m / options.cell_m)) + 1;
  corner_ = center_in_map.array() - 0.5 * width_ * options.cell_m;
  slot_of_cell_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), -1);
}

int LocalMap::Index(double x, double y) const {
  const double column = std::floor((x - corner_.x()) / options_.cell_m);
  const double row = std::floor((y - corner_.y()) / options_.cell_m);
  // A margin of a window, so that neighbours need no check of their own.
  const double margin = options_.window_cells;
  if (!(column >= margin && row >= margin && column < width_ - margin && row < width_ - margin)) {
    return -1;
  }
  return static_cast<int>(row) * width_ + static_cast<int>(column);
}

void LocalMap::Add(const ScanPoints& points_in_robot, const Pose2& T_map_robot) {
  std::vector<int> touched;
  Insert(points_in_robot, T_map_robot, touched);
  UpdateAround(std::move(touched));
}

void LocalMap::Add(const std::vector<PosedPoints>& scans) {
  std::vector<int> touched;
  for (const PosedPoints& scan : scans) Insert(*scan.points_in_robot, scan.T_map_robot, touched);
  UpdateAround(std::move(touched));
}

std::size_t LocalMap::AddSlot(int index) {
  std::int32_t& slot = slot_of_cell_[static_cast<std::size_t>(index)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(moments_.size() / kSides);
    moments_.resize(moments_.size() + kSides);
    distributions_.resize(distributions_.size() + kSides + 1);
  }
  return static_cast<std::size_t>(slot);
}

std::vector<std::uint8_t> LocalMap::SidesOf(const std::vector<Eigen::Vector2f>& normals,
                                            double theta) const {
  const auto c = static_cast<float>(std::cos(front_rad_ - theta));
  const auto s = static_cast<float>(std::sin(front_rad_ - theta));
  std::vector<std::uint8_t> sides;
  sides.reserve(normals.size());
  for (const Eigen::Vector2f& normal : normals) {
    const bool ahead = c * normal.x() + s * normal.y() >= 0.0F;
    const bool left = c * normal.y() - s * normal.x() >= 0.0F;
    sides.push_back(static_cast<std::uint8_t>((ahead ? 0 : 1) + (left ? 0 : 2)));
  }
  return sides;
}

void LocalMap::Insert(const ScanPoints& points_in_robot, const Pose2& T_map_robot,
                      std::vector<int>& touched) {
  const std::vector<Eigen::Vector2f> normals = NormalsOf(points_in_robot);
  if (scans_ == 0) front_rad_ = FrontOf(normals, T_map_robot.theta);
  const std::vector<std::uint8_t> sides = SidesOf(normals, T_map_robot.theta);
  const double c = std::cos(T_map_robot.theta);
  const double s = std::sin(T_map_robot.theta);
  for (std::size_t i = 0; i < points_in_robot.size(); ++i) {
    const pcl::PointXY& point = points_in_robot[i];
    const double x = T_map_robot.x + c * point.x - s * point.y;
    const double y = T_map_robot.y + s * point.x + c * point.y;
    const int index = Index(x, y);
    if (index < 0) continue;
    const std::size_t slot = AddSlot(index);
    const int column = index % width_;
    const int row = index / width_;
    const double dx = x - (corner_.x() + (column + 0.5) * options_.cell_m);
    const double dy = y - (corner_.y() + (row + 0.5) * options_.cell_m);
    Moments& moments = moments_[kSides * slot + sides[i]];
    moments.count += 1.0;
    moments.x += dx;
    moments.y += dy;
    moments.xx += dx * dx;
    moments.xy += dx * dy;
    moments.yy += dy * dy;
    touched.push_back(index);
  }
  ++scans_;
}

void LocalMap::UpdateAround(std::vector<int> touched) {
  const int window = options_.window_cells;
  const auto sort_unique = [](std::vector<int>& cells) {
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  };
  sort_unique(touched);
  std::vector<int> changed;
  changed.reserve(touched.size() * 9);
  for (const int index : touched) {
    for (int dy = -window; dy <= window; ++dy) {
      for (int dx = -window; dx <= window; ++dx) changed.push_back(index + dy * width_ + dx);
    }
  }
  sort_unique(changed);
  for (const int index : changed) UpdateDistributions(index % width_, index / width_);
}

void LocalMap::SumAround(int column, int row, std::array<Moments, kSides + 1>& sums) const {
  const int window = options_.window_cells;
  for (int dy = -window; dy <= window; ++dy) {
    for (int dx = -window; dx <= window; ++dx) {
      const int neighbour_column = column + dx;
      const int neighbour_row = row + dy;
      if (neighbour_column < 0 || neighbour_row < 0 || neighbour_column >= width_ ||
          neighbour_row >= width_) {
        continue;
      }
      const int neighbour = neighbour_row * width_ + neighbour_column;
      const std::int32_t slot = slot_of_cell_[static_cast<std::size_t>(neighbour)];
      if (slot < 0) continue;
      const double ox = dx * options_.cell_m;
      const double oy = dy * options_.cell_m;
      for (std::size_t side = 0; side < kSides; ++side) {
        const Moments& m = moments_[kSides * static_cast<std::size_t>(slot) + side];
        if (m.count == 0.0) continue;
        Moments& sum = sums[side];
        sum.count += m.count;
        sum.x += m.x + m.count * ox;
        sum.y += m.y + m.count * oy;
        sum.xx += m.xx + 2.0 * ox * m.x + m.count * ox * ox;
        sum.xy += m.xy + ox * m.y + oy * m.x + m.count * ox * oy;
        sum.yy += m.yy + 2.0 * oy * m.y + m.count * oy * oy;
      }
    }
  }
}

void LocalMap::Describe(const Moments& sum, int column, int row, Distribution& d) const {
  const double mx = sum.x / sum.count;
  const double my = sum.y / sum.count;
  d.mean_x = static_cast<float>(corner_.x() + (column + 0.5) * options_.cell_m + mx);
  d.mean_y = static_cast<float>(corner_.y() + (row + 0.5) * options_.cell_m + my);
  const double xx = sum.xx / sum.count - mx * mx;
  const double xy = sum.xy / sum.count - mx * my;
  const double yy = sum.yy / sum.count - my * my;
  const double mean = 0.5 * (xx + yy);
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  const double small = std::max(0.0, mean - spread);
  const double large = mean + spread;
  // Cosine and sine of twice the direction of the larger variance, and of its half.
  const double cosine = spread > 0.0 ? 0.5 * (xx - yy) / spread : 1.0;
  d.normal_x = static_cast<float>(-std::copysign(std::sqrt(std::max(0.0, 0.5 - 0.5 * cosine)), xy));
  d.normal_y = static_cast<float>(std::sqrt(std::max(0.0, 0.5 + 0.5 * cosine)));
  d.small = static_cast<float>(small);
  d.large = static_cast<float>(large);
  // Three points at the least, and spread over more than one cell: else a line is a guess.
  d.is_line = sum.count >= 3.0 && small < options_.line_ratio * large &&
              large > Square(0.5 * options_.cell_m);
  d.is_known = sum.count >= 2.0;
}

void LocalMap::UpdateDistributions(int column, int row) {
  std::array<Moments, kSides + 1> sums;  // the last: of all sides
  SumAround(column, row, sums);
  Moments& all = sums[kSides];
  std::size_t only_side = kSides;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (sums[side].count == 0.0) continue;
    only_side = all.count == 0.0 ? side : kSides;
    all.count += sums[side].count;
    all.x += sums[side].x;
    all.y += sums[side].y;
    all.xx += sums[side].xx;
    all.xy += sums[side].xy;
    all.yy += sums[side].yy;
  }
  const std::size_t slot = AddSlot(row * width_ + column);
  for (std::size_t side = 0; side <= kSides; ++side) {
    const Moments& sum = sums[side];
    if (sum.count == 0.0) continue;
    Distribution& d = distributions_[(kSides + 1) * slot + side];
    if (side == kSides && only_side < kSides) {
      d = distributions_[(kSides + 1) * slot + only_side];
      continue;
    }
    Describe(sum, column, row, d);
  }
}

double LocalMap::Step(const ScanPoints& points, const std::vector<std::uint8_t>& sides,
                      const Pose2& T_map_robot, double sigma_m, Eigen::Matrix3d& hessian,
                      Eigen::Vector3d& gradient) const {
  const double c = std::cos(T_map_robot.theta);
  const double s = std::sin(T_map_robot.theta);
  const double noise = Square(sigma_m);
  const double outlier = 1.0 / Square(options_.outlier_sigmas);
  double inliers = 0.0;
  double h00 = 0, h01 = 0, h02 = 0, h11 = 0, h12 = 0, h22 = 0, g0 = 0, g1 = 0, g2 = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const pcl::PointXY& point = points[i];
    const double rx = c * point.x - s * point.y;
    const double ry = s * point.x + c * point.y;
    const int index = Index(T_map_robot.x + rx, T_map_robot.y + ry);
    if (index < 0) continue;
    const std::int32_t slot = slot_of_cell_[static_cast<std::size_t>(index)];
    if (slot < 0) continue;
    // The face that is seen, where it is known as a line; else all that is known of the place.
    const Distribution* of_sides = &distributions_[(kSides + 1) * static_cast<std::size_t>(slot)];
    const Distribution& d = of_sides[of_sides[sides[i]].is_line ? sides[i] : kSides];
    if (!d.is_known) continue;
    const double ex = T_map_robot.x + rx - d.mean_x;
    const double ey = T_map_robot.y + ry - d.mean_y;
    const double nx = d.normal_x;
    const double ny = d.normal_y;
    const double across = nx * ex + ny * ey;
    const double w_across = 1.0 / (d.small + noise);
    const double along = -ny * ex + nx * ey;
    const double w_along = d.is_line ? 0.0 : 1.0 / (d.large + noise);
    const double chi2 = w_across * across * across + w_along * along * along;
    const double weight = 1.0 / Square(1.0 + chi2 * outlier);
    inliers += weight;
    // d(point)/d(x, y, theta) = [1 0 -ry; 0 1 rx], projected on the normal and on the tangent.
    const double a2 = -nx * ry + ny * rx;
    const double b2 = ny * ry + nx * rx;
    const double wa = weight * w_across;
    const double wb = weight * w_along;
    h00 += wa * nx * nx + wb * ny * ny;
    h01 += wa * nx * ny - wb * ny * nx;
    h02 += wa * nx * a2 - wb * ny * b2;
    h11 += wa * ny * ny + wb * nx * nx;
    h12 += wa * ny * a2 + wb * nx * b2;
    h22 += wa * a2 * a2 + wb * b2 * b2;
    g0 += wa * nx * across - wb * ny * along;
    g1 += wa * ny * across + wb * nx * along;
    g2 += wa * a2 * across + wb * b2 * along;
  }
  hessian << h00, h01, h02, h01, h11, h12, h02, h12, h22;
  gradient << g0, g1, g2;
  return inliers;
}

double LocalMap::Agreement(const ScanPoints& points_in_robot, const Pose2& T_map_robot,
                           double sigma_m) const {
  if (points_in_robot.empty()) return 0.0;
  Eigen::Matrix3d hessian;
  Eigen::Vector3d gradient;
  const std::vector<std::uint8_t> sides = SidesOf(NormalsOf(points_in_robot), T_map_robot.theta);
  return Step(points_in_robot, sides, T_map_robot, sigma_m, hessian, gradient) /
         static_cast<double>(points_in_robot.size());
}

Alignment LocalMap::Align(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                          const Eigen::Matrix3d& prior_information) const {
  return Align(points_in_robot, T_map_robot_guess, prior_information,
               options_.guess_outlier_sigmas);
}

Alignment LocalMap::AlignHeld(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                              const Eigen::Matrix3d& prior_information) const {
  return Align(points_in_robot, T_map_robot_guess, prior_information,
               std::numeric_limits<double>::infinity());
}

Alignment LocalMap::Align(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                          const Eigen::Matrix3d& prior_information,
                          double guess_outlier_sigmas) const {
  Alignment result;
  result.T_map_robot = T_map_robot_guess;
  if (points_in_robot.empty()) return result;
  double sigma = options_.first_sigma_m;
  // A guess turns by less than what lies between the walls of a building and the border of sides.
  const std::vector<std::uint8_t> sides =
      SidesOf(NormalsOf(points_in_robot), T_map_robot_guess.theta);
  Eigen::Matrix3d hessian;
  Eigen::Vector3d gradient;
  for (; result.iterations < options_.max_iterations; ++result.iterations) {
    Pose2& pose = result.T_map_robot;
    Step(points_in_robot, sides, pose, sigma, hessian, gradient);
    // The scan's own weight shrinks by the inflation, so that the prior is weighed against what the
    // scan really knows.
    const Eigen::Vector3d from_guess(pose.x - T_map_robot_guess.x, pose.y - T_map_robot_guess.y,
                                     WrapAngle(pose.theta - T_map_robot_guess.theta));
    // Wheels slip, and some logs even have their sign wrong: a guess that the points contradict by
    // many sigmas loses its say (Cauchy), while one that they say nothing against keeps it.
    const double guess_chi2 = from_guess.dot(prior_information * from_guess);
    const Eigen::Matrix3d prior =
        prior_information / (1.0 + guess_chi2 / Square(guess_outlier_sigmas));
    const Eigen::Matrix3d total = hessian / options_.covariance_inflation + prior;
    const Eigen::LDLT<Eigen::Matrix3d> factor(total);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-9)) return result;
    const Eigen::Vector3d step =
        -factor.solve(gradient / options_.covariance_inflation + prior * from_guess);
    pose = {pose.x + step.x(), pose.y + step.y(), WrapAngle(pose.theta + step.z())};
    const bool is_fine = sigma <= options_.point_sigma_m;
    if (is_fine && step.head<2>().norm() < 5e-4 && std::abs(step.z()) < 1e-4) {
      result.converged = true;
      break;
    }
    sigma = std::max(options_.point_sigma_m, 0.5 * sigma);
  }
  result.inlier_share =
      Step(points_in_robot, sides, result.T_map_robot, options_.point_sigma_m, hessian, gradient) /
      static_cast<double>(points_in_robot.size());
  result.information = hessian / options_.covariance_inflation;
  return result;
}

}  // namespace masked_mapper
