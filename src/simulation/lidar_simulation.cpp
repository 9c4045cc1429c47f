// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Distance at which a ray meets a leg; infinite when it does not, or from inside.
double LegRange(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, const Leg& leg) {
  const Eigen::Vector2d to = leg.centre - origin;
  const double along = to.dot(direction);
  const double aside = direction.x() * to.y() - direction.y() * to.x();
  const double half = leg.radius * leg.radius - aside * aside;
  if (half < 0.0 || along < leg.radius) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(half);
}

void Check(bool fits, const char* what) {
  if (!fits) throw InputError(std::string("simulated lidar: ") + what);
}

}  // namespace

LidarNoise LidarNoise::None() {
  LidarNoise noise;
  noise.sigma = 0.0;
  noise.resolution = 0.0;
  noise.glass_return = std::numeric_limits<double>::infinity();
  noise.lost = 0.0;
  noise.people.per_kilometre = 0.0;
  return noise;
}

LidarSimulation::LidarSimulation(const Building& building, const LidarOptions& options,
                                 const LidarNoise& noise, std::uint64_t seed)
    : building_(building),
      options_(options),
      noise_(noise),
      random_(seed, "lidar"),
      people_(building, noise.people, seed) {
  Check(options.rate > 0.0 && options.rate <= 1000.0, "the rate is not within 0 to 1000 Hz");
  Check(options.beams >= 2 && options.beams <= 100'000, "the number of beams is not 2 to 100000");
  Check(options.field_of_view_deg > 0.0 && options.field_of_view_deg <= 360.0,
        "the field of view is not within 0 to 360 degrees");
  Check(options.max_range > 0.1 && options.max_range <= 1000.0,
        "the maximum range is not within 0.1 to 1000 m");
  Check(options.min_range >= 0.0 && options.min_range < options.max_range,
        "the minimum range is not below the maximum");
  Check(noise.sigma >= 0.0 && noise.sigma <= 1.0, "sigma is not within 0 to 1 m");
  Check(noise.people.per_kilometre >= 0.0 && noise.people.per_kilometre <= 1e4,
        "people per kilometre are not within 0 to 10000");
  for (std::size_t f = 0; f < building.floors.size(); ++f) {
    standing_.emplace_back(StandingSegments(building, f));
  }
}

std::vector<Segment> LidarSimulation::Doors(const RobotState& state) const {
  std::vector<Segment> doors;
  for (std::size_t e = 0; e < building_.elevators.size(); ++e) {
    const Elevator& elevator = building_.elevators[e];
    const bool stops_here =
        std::any_of(elevator.landings.begin(), elevator.landings.end(),
                    [&](const Landing& landing) { return landing.floor == state.floor; });
    if (!stops_here) continue;
    const double open = state.elevator == e ? state.door_open : 0.0;
    const std::vector<Segment> leaves = CabDoor(elevator, open);
    doors.insert(doors.end(), leaves.begin(), leaves.end());
  }
  return doors;
}

LaserScan LidarSimulation::Scan(double time, const RobotState& state) {
  LaserScan scan;
  scan.T_robot_laser = options_.T_robot_laser;
  scan.max_range = static_cast<float>(options_.max_range);
  const bool all_round = options_.field_of_view_deg >= 360.0;
  const double beams = static_cast<double>(options_.beams);
  scan.angle_step = DegToRad(options_.field_of_view_deg) / (all_round ? beams : beams - 1.0);
  scan.first_angle = -0.5 * DegToRad(options_.field_of_view_deg);

  const Pose2 T_building_laser = state.T_building_robot * options_.T_robot_laser;
  const Eigen::Vector2d origin = T_building_laser.Translation();
  const SegmentIndex& standing = standing_[state.floor];
  const std::vector<Segment> doors = Doors(state);
  std::vector<Leg> legs = people_.LegsAt(time, state.floor, state.T_building_robot.Translation());
  legs.erase(std::remove_if(legs.begin(), legs.end(),
                            [&](const Leg& leg) {
                              return (leg.centre - origin).norm() > options_.max_range + leg.radius;
                            }),
             legs.end());

  scan.ranges.reserve(options_.beams);
  for (std::size_t beam = 0; beam < options_.beams; ++beam) {
    const double angle = T_building_laser.theta + scan.Angle(beam);
    scan.ranges.push_back(Range(origin, {std::cos(angle), std::sin(angle)}, standing, doors, legs));
  }
  return scan;
}

float LidarSimulation::Range(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                             const SegmentIndex& standing, const std::vector<Segment>& doors,
                             const std::vector<Leg>& legs) {
  double nearest_moving = options_.max_range;
  for (const Segment& door : doors) {
    const std::optional<double> range = RayRange(origin, direction, door, options_.min_range);
    if (range) nearest_moving = std::min(nearest_moving, *range);
  }
  for (const Leg& leg : legs) {
    const double range = LegRange(origin, direction, leg);
    if (range > options_.min_range) nearest_moving = std::min(nearest_moving, range);
  }
  double range = nearest_moving;
  double from = options_.min_range;
  while (const std::optional<SegmentIndex::Hit> hit =
             standing.Cast(origin, direction, from, nearest_moving)) {
    const Segment& segment = standing.segments()[hit->segment];
    if (segment.surface == Surface::kGlass) {
      const Eigen::Vector2d edge = (segment.b - segment.a).normalized();
      const double cosine = direction.x() * edge.y() - direction.y() * edge.x();
      if (random_.Uniform() >= noise_.glass_return * cosine * cosine) {
        from = hit->range + 1e-6;
        continue;
      }
    }
    range = hit->range;
    break;
  }
  if (noise_.lost > 0.0 && random_.Chance(noise_.lost)) return kNoReturn;
  if (!(range < options_.max_range)) return kNoReturn;
  if (noise_.sigma > 0.0) range += noise_.sigma * random_.Normal();
  if (noise_.resolution > 0.0) range = std::round(range / noise_.resolution) * noise_.resolution;
  if (!(range < options_.max_range)) return kNoReturn;
  return static_cast<float>(std::max(range, std::max(options_.min_range, 0.01)));
}

}  // namespace masked_mapper
