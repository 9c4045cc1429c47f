// SPDX-License-Identifier: BSD-3-Clause
#include "ground.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "voxel_set.hpp"

namespace masked_mapper {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kMostPoints = 8000;  // of a cloud: a plane needs no more
// A floor is large: what lies close about the lidar is many returns, but little of a floor.
constexpr double kVoxel = 0.15;         // m
constexpr double kReach = 20.0;         // m; farther, a tilt moves a floor by more than its bin
constexpr double kBin = 0.05;           // m of height
constexpr double kLowest = -10.0;       // m, of what is looked at
constexpr double kHighest = 15.0;       // m
constexpr double kShareOfFloor = 0.02;  // of the returns: a floor is no speck
constexpr double kShareBelow = 0.03;    // of the returns: mirrors and glossy floors
constexpr double kMargin = 0.15;        // m; what lies as much below is below the floor
constexpr double kThin = 0.04;          // m, off a plane: noise, and a floor that is not even
constexpr double kThick = 0.12;         // m
constexpr double kShareThin = 0.65;  // of what lies within kThick: of clutter it would be a third
constexpr double kUsualTilt_deg = 8.0;      // of mounts, ramps and thresholds
constexpr double kUsualHeight = 0.5;        // m, of a lidar above a floor that it does not see
constexpr double kWidestSearch_deg = 24.0;  // of tilts, where nothing is known
constexpr double kSearchStep_deg = 3.0;
constexpr double kGravityIsSure_deg = 3.0;  // more than wheels that brake make it lean
constexpr std::size_t kOctants = 8;
constexpr std::size_t kFewestOctants = 2;
constexpr std::size_t kFewestSpread = 4;
constexpr std::size_t kSectorsPerSpread = 5;

Points Sampled(const CloudPoints& cloud, const Eigen::Vector3d& lidar) {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kMostPoints);
  VoxelSet voxels(cloud.size() / stride + 1, kVoxel);
  Points points;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    const Eigen::Vector3d point = cloud[i].position.cast<double>();
    if ((point - lidar).norm() > kReach || !voxels.Insert(cloud[i].position)) continue;
    points.push_back(point);
  }
  return points;
}

Eigen::Vector3d UpOf(double slope_x, double slope_y) {
  return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
}

/// One of kOctants, in whatever order: by comparisons, since an angle costs as much as all else
/// that is done with a point.
std::size_t OctantOf(const Eigen::Vector3d& direction) {
  const double x = direction.x();
  const double y = direction.y();
  const auto is = [](bool so) { return static_cast<std::size_t>(so); };
  return is(x < 0.0) | is(y < 0.0) << 1U | is(std::abs(x) < std::abs(y)) << 2U;
}

std::size_t SectorOf(const Eigen::Vector3d& direction, std::size_t sectors) {
  const double turn = (std::atan2(direction.y(), direction.x()) + kPi) / (2.0 * kPi);
  return static_cast<std::size_t>(turn * static_cast<double>(sectors)) % sectors;
}

/// Heights along one direction.
class Heights {
 public:
  Heights(const Points& points, const Eigen::Vector3d& up) {
    counts_.fill(0);
    for (const Eigen::Vector3d& point : points) {
      const double height = up.dot(point);
      if (height < kLowest || height >= kHighest) continue;
      ++counts_[static_cast<std::size_t>((height - kLowest) / kBin)];
      ++total_;
    }
  }

  struct Slab {
    double height_m = 0.0;
    int count = 0;
  };

  /// The fullest slab with hardly anything below, among those below `limit_m`.
  std::optional<Slab> Floor(double limit_m) const {
    std::optional<Slab> best;
    int below = 0;
    const auto margin = static_cast<std::size_t>(kMargin / kBin);
    for (std::size_t i = 0; i + 1 < counts_.size(); ++i) {
      if (i >= margin) below += counts_[i - margin];
      const double height = kLowest + kBin * static_cast<double>(i + 1);
      if (height > limit_m || below > kShareBelow * total_) break;
      const int count = counts_[i] + counts_[i + 1];
      if (count > kShareOfFloor * total_ && (!best || count > best->count))
        best = {{height, count}};
    }
    return best;
  }

  /// The same from above.
  std::optional<Slab> Ceiling(double limit_m) const {
    std::optional<Slab> best;
    int above = 0;
    const auto margin = static_cast<std::size_t>(kMargin / kBin);
    for (std::size_t i = counts_.size() - 1; i > 0; --i) {
      if (i + margin < counts_.size()) above += counts_[i + margin];
      const double height = kLowest + kBin * static_cast<double>(i);
      if (height < limit_m || above > kShareBelow * total_) break;
      const int count = counts_[i] + counts_[i - 1];
      if (count > kShareOfFloor * total_ && (!best || count > best->count))
        best = {{height, count}};
    }
    return best;
  }

 private:
  static constexpr auto kBins = static_cast<std::size_t>((kHighest - kLowest) / kBin);
  std::array<int, kBins> counts_{};
  int total_ = 0;
};

struct Plane {
  double slope_x = 0.0;  ///< z = slope_x x + slope_y y + height
  double slope_y = 0.0;
  double height = 0.0;  ///< m

  double Off(const Eigen::Vector3d& point) const {
    return point.z() - slope_x * point.x() - slope_y * point.y() - height;
  }
};

/// The plane through the points near it; empty when they do not span one.
std::optional<Plane> Refined(const Points& points, Plane plane) {
  // What a first guess of the tilt is off by grows with the distance; from pass to pass it is less.
  const std::array<double, 5> windows = {0.12, 0.10, 0.08, 0.06, 0.05};  // m
  for (const double window : windows) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    std::array<bool, kOctants> octants{};
    int count = 0;
    for (const Eigen::Vector3d& point : points) {
      if (std::abs(plane.Off(point)) > window) continue;
      const Eigen::Vector3d row(point.x(), point.y(), 1.0);
      normal += row * row.transpose();
      right += row * point.z();
      octants[OctantOf(point)] = true;
      ++count;
    }
    const auto seen = static_cast<std::size_t>(std::count(octants.begin(), octants.end(), true));
    if (count < kShareOfFloor * static_cast<double>(points.size()) || count < 30 ||
        seen < kFewestOctants) {
      return std::nullopt;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.rcond() < 1e-6) return std::nullopt;
    const Eigen::Vector3d solution = solver.solve(right);
    plane = {solution.x(), solution.y(), solution.z()};
  }
  return plane;
}

/// Whether the plane is seen along the ground, near and far in one direction, and not only where it
/// meets walls.
bool IsSpread(const Points& points, const Eigen::Vector3d& lidar, const Plane& plane) {
  constexpr std::size_t kSectors = 72;
  constexpr double kSpread = 0.5;  // m
  struct Reach {
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
  };
  std::array<Reach, kSectors> sectors;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(plane.Off(point)) > kThin) continue;
    const Eigen::Vector3d ray = point - lidar;
    Reach& sector = sectors[SectorOf(ray, kSectors)];
    sector.nearest = std::min(sector.nearest, ray.norm());
    sector.farthest = std::max(sector.farthest, ray.norm());
  }
  std::size_t seen = 0;
  std::size_t spread = 0;
  for (const Reach& sector : sectors) {
    seen += sector.farthest > 0.0 ? 1 : 0;
    spread += sector.farthest > sector.nearest + kSpread ? 1 : 0;
  }
  return spread >= kFewestSpread && spread * kSectorsPerSpread >= seen;
}

/// Whether what lies about the plane lies in it.
bool IsSharp(const Points& points, const Plane& plane) {
  int thin = 0;
  int thick = 0;
  for (const Eigen::Vector3d& point : points) {
    const double off = std::abs(plane.Off(point));
    thin += off < kThin ? 1 : 0;
    thick += off < kThick ? 1 : 0;
  }
  return thin > kShareThin * thick;
}

/// The tilt at which a floor is fullest, about a first guess.
std::optional<Plane> Searched(const Points& points, const Eigen::Vector3d& lidar,
                              const Eigen::Vector3d& up, double widest_deg) {
  std::optional<Plane> best;
  double fullest = 0.0;
  const Plane middle{-up.x() / up.z(), -up.y() / up.z(), 0.0};
  const int steps = static_cast<int>(widest_deg / kSearchStep_deg);
  const double step = std::tan(DegToRad(kSearchStep_deg));
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      const double slope_x = middle.slope_x + step * i;
      const double slope_y = middle.slope_y + step * j;
      const Eigen::Vector3d tried = UpOf(slope_x, slope_y);
      const auto floor = Heights(points, tried).Floor(tried.dot(lidar) - kMargin);
      if (!floor) continue;
      // Of two floors the one that is less of a slope, unless it is much less of a floor.
      const double tilts = RadToDeg(std::acos(std::min(1.0, tried.dot(up)))) / kUsualTilt_deg;
      const double fullness = floor->count * std::exp(-0.5 * tilts * tilts);
      if (fullness <= fullest) continue;
      fullest = fullness;
      best = {{slope_x, slope_y, floor->height_m / tried.z()}};
    }
  }
  return best;
}

}  // namespace

Eigen::Isometry3d Ground::T_level_robot() const {
  // The heading stays: x ahead remains above x ahead.
  const Eigen::Vector3d left = up_in_robot.cross(Eigen::Vector3d::UnitX()).normalized();
  Eigen::Matrix3d rotation;
  rotation.row(0) = left.cross(up_in_robot);
  rotation.row(1) = left;
  rotation.row(2) = up_in_robot;
  Eigen::Isometry3d T(rotation);
  T.translation().z() = -floor_m;
  return T;
}

Ground GroundFinder::Find(const CloudPoints& points_in_robot, const Eigen::Vector3d& lidar_in_robot,
                          const std::optional<Eigen::Vector3d>& gravity_up) {
  const Points points = Sampled(points_in_robot, lidar_in_robot);
  Ground ground = last_.value_or(
      Ground{{0.0, 0.0, 1.0}, std::min(0.0, lidar_in_robot.z() - kUsualHeight), {}, false});
  ground.is_seen = false;
  ground.ceiling_m.reset();
  if (gravity_up) ground.up_in_robot = *gravity_up;

  std::optional<Plane> plane;
  if (last_ && last_->is_seen) {
    const Eigen::Vector3d up = last_->up_in_robot;
    plane = Refined(points, {-up.x() / up.z(), -up.y() / up.z(), last_->floor_m / up.z()});
    // Something else that is flat, a table that came near, has the floor below it.
    if (plane) {
      const Eigen::Vector3d found = UpOf(plane->slope_x, plane->slope_y);
      const auto floor = Heights(points, found).Floor(found.dot(lidar_in_robot) - kMargin);
      if (!floor || std::abs(floor->height_m - plane->height * found.z()) > kMargin) plane.reset();
    }
  }
  if (!plane) {
    const double widest = last_ && last_->is_seen ? 3.0 * kSearchStep_deg : kWidestSearch_deg;
    plane = Searched(points, lidar_in_robot, ground.up_in_robot, widest);
    if (plane) plane = Refined(points, *plane);
  }
  if (plane && IsSharp(points, *plane) && IsSpread(points, lidar_in_robot, *plane)) {
    const Eigen::Vector3d up = UpOf(plane->slope_x, plane->slope_y);
    const bool is_level =
        !gravity_up || up.dot(*gravity_up) > std::cos(DegToRad(kGravityIsSure_deg));
    ground.up_in_robot = is_level ? up : *gravity_up;
    ground.floor_m = plane->height * ground.up_in_robot.z();
    ground.is_seen = true;
  }
  const auto ceiling =
      Heights(points, ground.up_in_robot).Ceiling(ground.up_in_robot.dot(lidar_in_robot) + kMargin);
  if (ceiling) ground.ceiling_m = ceiling->height_m;
  last_ = ground;
  return ground;
}

}  // namespace masked_mapper
