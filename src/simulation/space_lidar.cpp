// SPDX-License-Identifier: BSD-3-Clause
#include "space_lidar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr double kHips = 0.85;       // m
constexpr double kHead = 1.75;       // m
constexpr double kBodyRadius = 0.2;  // m

struct Named {
  const char* name;
  SpaceLidarModel model;
};
constexpr std::array<Named, 3> kModels = {{{"vlp16", SpaceLidarModel::kVlp16},
                                           {"os1-32", SpaceLidarModel::kOs132},
                                           {"mid360", SpaceLidarModel::kMid360}}};

/// Rings that turn about an upright axis.
struct Spinner {
  int rings = 16;
  int columns = 1800;
  double lowest_deg = -15.0;
  double highest_deg = 15.0;
};
constexpr Spinner kVlp16{16, 1800, -15.0, 15.0};
constexpr Spinner kOs132{32, 1024, -22.5, 22.5};

// One whose pattern never repeats; here two sequences of golden ratios.
constexpr int kPointsOfMid360 = 20000;
constexpr double kLowestOfMid360_deg = -7.0;
constexpr double kHighestOfMid360_deg = 52.0;

/// Where a ray over the ground enters a circle.
std::optional<double> CircleRange(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                                  const Eigen::Vector2d& centre, double radius) {
  const Eigen::Vector2d to = centre - origin;
  const double along = to.dot(direction);
  const double aside = direction.x() * to.y() - direction.y() * to.x();
  const double half = radius * radius - aside * aside;
  if (half < 0.0 || along < radius) return std::nullopt;
  return along - std::sqrt(half);
}

/// Between which ranges over the ground a ray is below a block, or above.
std::optional<std::pair<double, double>> StretchOver(const Overhead& block,
                                                     const Eigen::Vector2d& origin,
                                                     const Eigen::Vector2d& direction) {
  const Eigen::Vector2d to = block.T_building_block.Translation() - origin;
  const double reach = 0.5 * std::hypot(block.length, block.width);
  if (std::abs(direction.x() * to.y() - direction.y() * to.x()) > reach) return std::nullopt;
  const Pose2 T_block_building = Inverse(block.T_building_block);
  const Eigen::Vector2d from = T_block_building * origin;
  const Eigen::Vector2d along = T_block_building * Eigen::Vector2d(origin + direction) - from;
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (const int axis : {0, 1}) {
    const double half = 0.5 * (axis == 0 ? block.length : block.width);
    const double a = (-half - from(axis)) / along(axis);
    const double b = (half - from(axis)) / along(axis);
    if (along(axis) == 0.0) {
      if (std::abs(from(axis)) > half) return std::nullopt;
      continue;
    }
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return std::nullopt;
  return {{enter, leave}};
}

float BrightnessOf(Surface surface) {
  switch (surface) {
    case Surface::kWall:
      return 100.0F;
    case Surface::kGlass:
      return 15.0F;
    case Surface::kDoor:
      return 80.0F;
    case Surface::kFurniture:
      return 55.0F;
  }
  return 0.0F;
}
constexpr float kBrightnessOfFloor = 35.0F;
constexpr float kBrightnessOfCeiling = 120.0F;

}  // namespace

std::optional<SpaceLidarModel> SpaceLidarCalled(const std::string& name) {
  for (const Named& named : kModels) {
    if (name == named.name) return named.model;
  }
  return std::nullopt;
}

std::vector<std::string> SpaceLidarNames() {
  std::vector<std::string> names;
  for (const Named& named : kModels) names.emplace_back(named.name);
  return names;
}

SpaceLidarOptions OptionsOf(SpaceLidarModel model) {
  SpaceLidarOptions options;
  options.model = model;
  if (model == SpaceLidarModel::kOs132) {
    options.max_range = 90.0;
    options.sigma = 0.01;
    options.layout = CloudLayout::kOuster;
  }
  if (model == SpaceLidarModel::kMid360) {
    options.max_range = 40.0;
    options.min_range = 0.1;
    options.layout = CloudLayout::kLivox;
  }
  return options;
}

SpaceLidar::SpaceLidar(const Building& building, const SpaceLidarOptions& options,
                       const LidarNoise& noise, std::uint64_t seed)
    : building_(building),
      options_(options),
      noise_(noise),
      random_(seed, "space lidar"),
      people_(building, noise.people, seed) {
  if (noise.sigma == 0.0) options_.sigma = 0.0;
  for (std::size_t f = 0; f < building.floors.size(); ++f) {
    surfaces_.push_back(SurfacesOf(building, f));
    std::vector<Segment> segments;
    for (const Upright& upright : surfaces_.back().standing) segments.push_back(upright.segment);
    index_.emplace_back(std::move(segments));
  }
}

std::vector<SpaceLidar::Ray> SpaceLidar::Rays() {
  std::vector<Ray> rays;
  const double period = 1.0 / options_.turn_rate;
  // Ouster's times are whole numbers after the first ray, others' lie before the last.
  const double begin = options_.layout == CloudLayout::kOuster ? 0.0 : -period;
  if (options_.model == SpaceLidarModel::kMid360) {
    constexpr double kGolden = 0.6180339887498949;
    constexpr double kPlastic = 0.7548776662466927;
    for (int i = 0; i < kPointsOfMid360; ++i) {
      const auto n = static_cast<double>(sent_++);
      const double up = kLowestOfMid360_deg + (kHighestOfMid360_deg - kLowestOfMid360_deg) *
                                                  (n * kPlastic - std::floor(n * kPlastic));
      rays.push_back({2.0 * kPi * (n * kGolden - std::floor(n * kGolden)), std::tan(DegToRad(up)),
                      begin + period * (i + 1.0) / kPointsOfMid360});
    }
    return rays;
  }
  const Spinner& spinner = options_.model == SpaceLidarModel::kVlp16 ? kVlp16 : kOs132;
  for (int column = 0; column < spinner.columns; ++column) {
    for (int ring = 0; ring < spinner.rings; ++ring) {
      const double up = spinner.lowest_deg +
                        (spinner.highest_deg - spinner.lowest_deg) * ring / (spinner.rings - 1.0);
      // Clockwise from straight behind, as these turn.
      rays.push_back({kPi - 2.0 * kPi * column / spinner.columns, std::tan(DegToRad(up)),
                      begin + period * (column + 1.0) / spinner.columns});
    }
  }
  return rays;
}

void SpaceLidar::Cross(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                       std::size_t floor, const std::vector<Segment>& doors,
                       const std::vector<Leg>& legs) {
  crossings_.clear();
  const double ceiling = surfaces_[floor].ceiling;
  for (const Segment& door : doors) {
    const auto range = RayRange(origin, direction, door, 0.0);
    if (range)
      crossings_.push_back({*range, 0.0, std::min(kCabDoorHeight, ceiling), Surface::kDoor, 1.0});
  }
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const auto range = CircleRange(origin, direction, legs[i].centre, legs[i].radius);
    if (range) crossings_.push_back({*range, 0.0, kHips, Surface::kFurniture, 1.0});
    if (i % 2 != 0) continue;  // two legs, one body
    const Eigen::Vector2d middle = 0.5 * (legs[i].centre + legs[i + 1].centre);
    const auto body = CircleRange(origin, direction, middle, kBodyRadius);
    if (body) crossings_.push_back({*body, kHips, kHead, Surface::kFurniture, 1.0});
  }
  double from = 0.0;
  while (const auto hit = index_[floor].Cast(origin, direction, from, options_.max_range)) {
    const Upright& upright = surfaces_[floor].standing[hit->segment];
    const Eigen::Vector2d edge = (upright.segment.b - upright.segment.a).normalized();
    const double cosine = direction.x() * edge.y() - direction.y() * edge.x();
    const Surface surface = upright.segment.surface;
    crossings_.push_back({hit->range, upright.low, upright.high, surface, cosine});
    if (surface == Surface::kWall && upright.low <= 0.0) break;
    from = hit->range + 1e-6;
  }
  flats_.clear();
  for (const Overhead& block : surfaces_[floor].overhead) {
    const auto over = StretchOver(block, origin, direction);
    if (!over || !(over->first < options_.max_range)) continue;
    flats_.push_back({over->first, over->second, block.low});
    flats_.push_back({over->first, over->second, block.high});
  }
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.range < b.range; });
}

/// False: the ray does not come back.
bool SpaceLidar::Return(const Ray& ray, double ceiling, CloudPoint* point) {
  const double height = options_.lidar_on_robot.z();
  const double stretch = std::hypot(1.0, ray.slope);
  double range = std::numeric_limits<double>::infinity();
  float brightness = 0.0F;
  if (ray.slope < 0.0) {
    range = -height / ray.slope;
    brightness = kBrightnessOfFloor;
  } else if (ray.slope > 0.0) {
    range = (ceiling - height) / ray.slope;
    brightness = kBrightnessOfCeiling;
  }
  for (const Flat& flat : flats_) {
    const double reached = (flat.height - height) / ray.slope;
    if (!(reached > flat.from && reached < flat.to && reached < range)) continue;
    range = reached;
    brightness = BrightnessOf(Surface::kFurniture);
  }
  for (const Crossing& crossing : crossings_) {
    if (crossing.range >= range) break;
    const double z = height + ray.slope * crossing.range;
    if (z < crossing.low || z > crossing.high) continue;
    if (crossing.surface == Surface::kGlass &&
        random_.Uniform() >= noise_.glass_return * crossing.cosine * crossing.cosine) {
      continue;
    }
    range = crossing.range;
    brightness = BrightnessOf(crossing.surface);
    break;
  }
  double along = range * stretch;
  if (noise_.lost > 0.0 && random_.Chance(noise_.lost)) return false;
  if (!(along < options_.max_range) || along < options_.min_range) return false;
  if (options_.sigma > 0.0) along += options_.sigma * random_.Normal();
  const double over_ground = along / stretch;
  point->position = Eigen::Vector3d(over_ground * std::cos(ray.turn),
                                    over_ground * std::sin(ray.turn), over_ground * ray.slope)
                        .cast<float>();
  point->intensity = brightness;
  point->time = static_cast<float>(ray.time);
  return true;
}

CloudReading SpaceLidar::Sweep(double time, const std::function<RobotState(double)>& state_at) {
  CloudReading reading;
  reading.layout = options_.layout;
  reading.T_robot_lidar.translation() = options_.lidar_on_robot;
  const RobotState now = state_at(time);
  const std::vector<Leg> legs = people_.LegsAt(time, now.floor, now.T_building_robot.Translation());
  std::vector<Segment> doors;
  for (std::size_t e = 0; e < building_.elevators.size(); ++e) {
    const Elevator& elevator = building_.elevators[e];
    const bool stops_here =
        std::any_of(elevator.landings.begin(), elevator.landings.end(),
                    [&](const Landing& landing) { return landing.floor == now.floor; });
    if (!stops_here) continue;
    const std::vector<Segment> leaves = CabDoor(elevator, now.elevator == e ? now.door_open : 0.0);
    doors.insert(doors.end(), leaves.begin(), leaves.end());
  }
  const Pose2 T_robot_lidar{options_.lidar_on_robot.x(), options_.lidar_on_robot.y(), 0.0};
  double turn_before = std::numeric_limits<double>::quiet_NaN();
  for (const Ray& ray : Rays()) {
    if (ray.turn != turn_before) {
      // A floor is left between two sweeps, not in the middle of one.
      const Pose2 T_building_lidar =
          state_at(std::max(0.0, time + ray.time)).T_building_robot * T_robot_lidar;
      const double angle = T_building_lidar.theta + ray.turn;
      Cross(T_building_lidar.Translation(), {std::cos(angle), std::sin(angle)}, now.floor, doors,
            legs);
      turn_before = ray.turn;
    }
    CloudPoint point;
    if (Return(ray, surfaces_[now.floor].ceiling, &point)) reading.points.push_back(point);
  }
  return reading;
}

}  // namespace masked_mapper
