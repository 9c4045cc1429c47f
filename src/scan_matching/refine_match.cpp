// SPDX-License-Identifier: BSD-3-Clause
#include "refine_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "table_surface.hpp"

namespace masked_mapper {
namespace {

constexpr double kStepTolerance = 1e-5;  // m, translation and rotation at the points' radius

struct Response {
  double score = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

enum class Curvature { kTrue, kDownward };

Response RespondAt(const LookupTable& table, const std::vector<Eigen::Vector2d>& points,
                   const Pose2& pose, Curvature curvature) {
  const LookupTable::Level& cells = table.level(0);
  const double scale = 1.0 / table.resolution();
  const double c = scale * std::cos(pose.theta);
  const double s = scale * std::sin(pose.theta);
  Response response;
  Eigen::Matrix3d& hessian = response.hessian;
  TableSurface surface;
  for (const Eigen::Vector2d& point : points) {
    const double x = c * point.x() - s * point.y();  // cells, from the query's origin
    const double y = s * point.x() + c * point.y();
    if (!ReadSurface(cells, scale * pose.x + x, scale * pose.y + y, &surface)) continue;
    const Eigen::Vector2d& g = surface.gradient;
    response.score += surface.value;
    response.gradient += Eigen::Vector3d(g.x(), g.y(), x * g.y() - y * g.x());
    double bend = -x * g.x() - y * g.y();  // of the point's path as the angle changes
    if (curvature == Curvature::kDownward) {
      KeepDownward(&surface);
      bend = std::min(bend, 0.0);
    }
    hessian(0, 0) += surface.xx;
    hessian(0, 1) += surface.xy;
    hessian(1, 1) += surface.yy;
    hessian(0, 2) += x * surface.xy - y * surface.xx;
    hessian(1, 2) += x * surface.yy - y * surface.xy;
    hessian(2, 2) += y * y * surface.xx - 2.0 * x * y * surface.xy + x * x * surface.yy + bend;
  }
  const double norm = 1.0 / (255.0 * static_cast<double>(points.size()));
  const Eigen::Vector3d units(scale, scale, 1.0);
  response.score *= norm;
  response.gradient = norm * units.cwiseProduct(response.gradient);
  hessian = Eigen::Matrix3d(hessian.selfadjointView<Eigen::Upper>());
  hessian = norm * (units.asDiagonal() * hessian * units.asDiagonal());
  return response;
}

// The score alone.
double ScoreAt(const LookupTable& table, const std::vector<Eigen::Vector2d>& points,
               const Pose2& pose) {
  const LookupTable::Level& cells = table.level(0);
  const double scale = 1.0 / table.resolution();
  const double c = scale * std::cos(pose.theta);
  const double s = scale * std::sin(pose.theta);
  const double left = scale * pose.x - cells.x0 - 0.5;
  const double bottom = scale * pose.y - cells.y0 - 0.5;
  const double end_x = cells.width + 2.0;
  const double end_y = cells.height + 2.0;
  double sum = 0.0;
  for (const Eigen::Vector2d& point : points) {
    const double x = left + c * point.x() - s * point.y();
    const double y = bottom + s * point.x() + c * point.y();
    if (!(x > -2.0 && y > -2.0 && x < end_x && y < end_y)) continue;
    // Within the padding, so truncation is made to round down.
    const int column = static_cast<int>(x + 2.0) - 2;
    const int row = static_cast<int>(y + 2.0) - 2;
    const double u = x - column;
    const double v = y - row;
    const std::uint8_t* from = cells.data + row * cells.stride + column;
    const std::uint8_t* above = from + cells.stride;
    sum += (1.0 - v) * (from[0] + u * (from[1] - from[0])) +
           v * (above[0] + u * (above[1] - above[0]));
  }
  return sum / (255.0 * static_cast<double>(points.size()));
}

double RmsRadius(const std::vector<Eigen::Vector2d>& points) {
  double sum = 0.0;
  for (const Eigen::Vector2d& point : points) sum += point.squaredNorm();
  return std::max(0.1, std::sqrt(sum / static_cast<double>(points.size())));
}

using Axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

// The covariance with the given variances along axes in (x, y, radius * theta), plus the floor.
Eigen::Matrix3d AssembleCovariance(const Eigen::Matrix3d& axes, const Eigen::Vector3d& variances,
                                   double radius, const RefineOptions& options) {
  const Eigen::Vector3d units(1.0, 1.0, 1.0 / radius);
  const Eigen::Matrix3d scaled = axes * variances.asDiagonal() * axes.transpose();
  Eigen::Matrix3d covariance = units.asDiagonal() * scaled * units.asDiagonal();
  const double floor_m2 = options.floor_sigma_m * options.floor_sigma_m;
  const double floor_rad = DegToRad(options.floor_sigma_deg);
  covariance.diagonal() += Eigen::Vector3d(floor_m2, floor_m2, floor_rad * floor_rad);
  return 0.5 * (covariance + covariance.transpose());
}

Eigen::Matrix3d CurvatureCovariance(const Response& response, double radius,
                                    const RefineOptions& options) {
  const Eigen::Vector3d units(1.0, 1.0, 1.0 / radius);
  const Eigen::Matrix3d information =
      -options.sharpness * (units.asDiagonal() * response.hessian * units.asDiagonal());
  const Axes axes(information);
  const double least = 1.0 / (options.reach_m * options.reach_m);
  const Eigen::Vector3d variances = axes.eigenvalues().cwiseMax(least).cwiseInverse();
  return AssembleCovariance(axes.eigenvectors(), variances, radius, options);
}

// The response surface about a pose, in (x, y, radius * theta) from it.
class LocalSurface {
 public:
  LocalSurface(const LookupTable& table, const std::vector<Eigen::Vector2d>& points,
               const Pose2& centre, double radius)
      : table_(table), points_(points), centre_(centre), radius_(radius) {}

  double operator()(const Eigen::Vector3d& offset) const {
    return ScoreAt(
        table_, points_,
        {centre_.x + offset.x(), centre_.y + offset.y(), centre_.theta + offset.z() / radius_});
  }

 private:
  const LookupTable& table_;
  const std::vector<Eigen::Vector2d>& points_;
  Pose2 centre_;
  double radius_;
};

// Second differences over `arm`, wide enough to look past the bumps that single points make.
Eigen::Matrix3d SecondDifferences(const LocalSurface& surface, double arm) {
  const double centre = surface(Eigen::Vector3d::Zero());
  Eigen::Matrix3d differences;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d u = arm * Eigen::Vector3d::Unit(i);
    differences(i, i) = surface(u) + surface(-u) - 2.0 * centre;
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d v = arm * Eigen::Vector3d::Unit(j);
      differences(i, j) =
          0.25 * (surface(u + v) + surface(-u - v) - surface(u - v) - surface(v - u));
      differences(j, i) = differences(i, j);
    }
  }
  return differences / (arm * arm);
}

// Integrals of the likelihood exp(sharpness (score - top)) and of its second moment on one side of
// the centre; the steps grow with the distance.
struct Moments {
  double mass = 0.0;
  double second = 0.0;
};

constexpr double kFirstStep = 0.02;    // m
constexpr double kStepGrowth = 1.3;    // each step over the one before
constexpr double kNegligible = 0.002;  // likelihood at which a side ends

Moments SideMoments(const LocalSurface& surface, const Eigen::Vector3d& direction, double top,
                    double core, const RefineOptions& options) {
  Moments moments;
  const auto likelihood = [&](double distance) {
    return std::exp(options.sharpness * (surface(distance * direction) - top));
  };
  // Ours: a square discounted within the blur, where it would tell the width of the blur.
  const auto spread = [&](double distance) {
    const double square = distance * distance;
    return square * square / (square + core * core);
  };
  double last = 0.0;
  double last_value = likelihood(0.0);
  for (double step = kFirstStep; last < options.reach_m; step *= kStepGrowth) {
    const double next = std::min(last + step, options.reach_m);
    const double value = likelihood(next);
    moments.mass += 0.5 * (next - last) * (last_value + value);
    moments.second += 0.5 * (next - last) * (last_value * spread(last) + value * spread(next));
    if (value < kNegligible) break;
    last = next;
    last_value = value;
  }
  return moments;
}

}  // namespace

RefinedMatch RefineMatch(const LookupTable& table,
                         const std::vector<Eigen::Vector2d>& points_in_query,
                         const Pose2& T_reference_query_initial, const RefineOptions& options) {
  RefinedMatch match;
  match.T_reference_query.mean = T_reference_query_initial;
  if (points_in_query.empty()) {
    match.T_reference_query.covariance =
        ResponseCovariance(table, points_in_query, T_reference_query_initial, options);
    return match;
  }
  const double radius = RmsRadius(points_in_query);
  const double max_turn = DegToRad(options.max_turn_deg);
  const Pose2& start = T_reference_query_initial;

  // Damping is relative to the curvature of a point on the ridge of a wall.
  const double sigma = std::max(table.sigma(), table.resolution());
  const Eigen::Vector3d unit_damping = Eigen::Vector3d(1.0, 1.0, radius * radius) / (sigma * sigma);
  double damping = 1e-4;
  Pose2 pose = start;
  Response response = RespondAt(table, points_in_query, pose, Curvature::kTrue);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    Eigen::LLT<Eigen::Matrix3d> curvature(Eigen::Matrix3d((damping * unit_damping).asDiagonal()) -
                                          response.hessian);
    if (curvature.info() != Eigen::Success) {
      const Response downward = RespondAt(table, points_in_query, pose, Curvature::kDownward);
      curvature.compute(Eigen::Matrix3d((damping * unit_damping).asDiagonal()) - downward.hessian);
      if (curvature.info() != Eigen::Success) break;
    }
    const Eigen::Vector3d step = curvature.solve(response.gradient);
    if (!step.allFinite()) break;
    const Pose2 next{pose.x + step.x(), pose.y + step.y(), WrapAngle(pose.theta + step.z())};
    if (Distance(start, next) > options.max_shift_m ||
        std::abs(WrapAngle(next.theta - start.theta)) > max_turn) {
      damping *= 10.0;  // along a ridge a step may be far too long, and a shorter one right
      continue;
    }
    const Response at_next = RespondAt(table, points_in_query, next, Curvature::kTrue);
    if (at_next.score >= response.score) {
      pose = next;
      response = at_next;
      damping = std::max(1e-8, 0.1 * damping);
    } else {
      damping *= 10.0;
    }
    if (step.head<2>().norm() + radius * std::abs(step.z()) < kStepTolerance) {
      match.converged = true;
      break;
    }
  }
  match.T_reference_query = {pose, CurvatureCovariance(response, radius, options)};
  match.score = response.score;
  return match;
}

Eigen::Matrix3d ResponseCovariance(const LookupTable& table,
                                   const std::vector<Eigen::Vector2d>& points_in_query,
                                   const Pose2& T_reference_query, const RefineOptions& options) {
  if (points_in_query.empty()) {
    return AssembleCovariance(Eigen::Matrix3d::Identity(),
                              Eigen::Vector3d::Constant(options.reach_m * options.reach_m), 1.0,
                              options);
  }
  const double radius = RmsRadius(points_in_query);
  const LocalSurface surface(table, points_in_query, T_reference_query, radius);
  const double arm = 1.5 * std::max(table.sigma(), table.resolution());
  const Axes axes(SecondDifferences(surface, arm));
  const double top = surface(Eigen::Vector3d::Zero());
  Eigen::Vector3d variances;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    const Moments ahead = SideMoments(surface, axis, top, table.sigma(), options);
    const Moments behind = SideMoments(surface, -axis, top, table.sigma(), options);
    variances(i) = (ahead.second + behind.second) / (ahead.mass + behind.mass);
  }
  return AssembleCovariance(axes.eigenvectors(), variances, radius, options);
}

}  // namespace masked_mapper
