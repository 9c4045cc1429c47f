// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/space_lidar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "masked_mapper/geometry/angle.hpp"

namespace masked_mapper {
namespace {

constexpr double kCeiling = 2.7;         // m, where storeys are not lower
constexpr double kBetweenStoreys = 0.3;  // m of concrete
constexpr double kDoorHeight = 2.05;     // m
constexpr double kLintel = 2.1;          // m, over the door of a cab
constexpr double kHips = 0.85;           // m
constexpr double kHead = 1.75;           // m
constexpr double kBodyRadius = 0.2;      // m
constexpr std::array<double, 4> kFurniture = {0.74, 1.2, 1.9, 2.2};  // m

struct Named {
  const char* name;
  SpaceLidarModel model;
};
constexpr std::array<Named, 3> kModels = {{{"vlp16", SpaceLidarModel::kVlp16},
                                           {"os1-32", SpaceLidarModel::kOs1_32},
                                           {"mid360", SpaceLidarModel::kMid360}}};

/// Rings that turn about an upright axis.
struct Spinner {
  int rings = 16;
  int columns = 1800;
  double lowest_deg = -15.0;
  double highest_deg = 15.0;
};
constexpr Spinner kVlp16{16, 1800, -15.0, 15.0};
constexpr Spinner kOs1_32{32, 1024, -22.5, 22.5};

// One whose pattern never repeats; here two sequences of golden ratios.
constexpr int kPointsOfMid360 = 20000;
constexpr double kLowestOfMid360_deg = -7.0;
constexpr double kHighestOfMid360_deg = 52.0;

std::vector<Upright> UprightsOf(const std::vector<Segment>& segments, double ceiling) {
  std::vector<Upright> uprights;
  std::size_t piece = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    double high = ceiling;
    if (segment.surface == Surface::kDoor) high = std::min(kDoorHeight, ceiling);
    if (segment.surface == Surface::kFurniture) {
      // The sides of one piece stand together.
      const bool goes_on = i > 0 && segments[i - 1].surface == Surface::kFurniture &&
                           (segments[i - 1].b - segment.a).norm() < 1e-6;
      piece += goes_on ? 0 : 1;
      high = std::min(kFurniture[piece % kFurniture.size()], ceiling);
    }
    uprights.push_back({segment, 0.0, high});
  }
  return uprights;
}

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
  if (model == SpaceLidarModel::kOs1_32) {
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
    double ceiling = kCeiling;
    if (f + 1 < building.floors.size()) {
      const double storey = building.floors[f + 1].elevation - building.floors[f].elevation;
      ceiling = std::min(ceiling, std::max(storey - kBetweenStoreys, 1.0));
    }
    ceilings_.push_back(ceiling);
    std::vector<Segment> segments = StandingSegments(building, f);
    standing_.push_back(UprightsOf(segments, ceiling));
    for (const Elevator& elevator : building.elevators) {
      for (const Landing& landing : elevator.landings) {
        if (landing.floor != f || !(ceiling > kLintel)) continue;
        for (const Segment& leaf : CabDoor(elevator, 0.0)) {
          segments.push_back(leaf);
          segments.back().surface = Surface::kWall;
          standing_.back().push_back({segments.back(), kLintel, ceiling});
        }
      }
    }
    index_.emplace_back(std::move(segments));
  }
}

std::vector<SpaceLidar::Ray> SpaceLidar::Rays() {
  std::vector<Ray> rays;
  const double period = 1.0 / options_.rate;
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
  const Spinner& spinner = options_.model == SpaceLidarModel::kVlp16 ? kVlp16 : kOs1_32;
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
  const double ceiling = ceilings_[floor];
  for (const Segment& door : doors) {
    const auto range = RayRange(origin, direction, door, 0.0);
    if (range) crossings_.push_back({*range, 0.0, std::min(kLintel, ceiling), Surface::kDoor, 1.0});
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
    const Upright& upright = standing_[floor][hit->segment];
    const Eigen::Vector2d edge = (upright.segment.b - upright.segment.a).normalized();
    const double cosine = direction.x() * edge.y() - direction.y() * edge.x();
    const Surface surface = upright.segment.surface;
    crossings_.push_back({hit->range, upright.low, upright.high, surface, cosine});
    if (surface == Surface::kWall && upright.low <= 0.0) break;
    from = hit->range + 1e-6;
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
    if (Return(ray, ceilings_[now.floor], &point)) reading.points.push_back(point);
  }
  return reading;
}

}  // namespace masked_mapper
