// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "masked_mapper/simulation/random_generator.hpp"
#include "masked_mapper/simulation/tour.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr double kClearance = 0.1;  // m, beyond the robot's radius, that ways must have

/// The stamps of one sensor: first, first + 1 / rate, ... up to an end; none at rate 0.
class Ticks {
 public:
  Ticks(double rate, double end) : rate_(rate), end_(end) {}
  /// Seconds from the start of the next tick; infinite when there is none.
  double Next() const {
    if (!(rate_ > 0.0)) return kNever;
    const double time = static_cast<double>(count_) / rate_;
    return time <= end_ ? time : kNever;
  }
  void Pass() { ++count_; }

  static constexpr double kNever = std::numeric_limits<double>::infinity();

 private:
  double rate_;
  double end_;
  std::uint64_t count_ = 0;
};

/// Poses are kept to a micrometre and a nanoradian: the last bits of sines and cosines differ
/// between platforms, and must not reach the output.
Pose2 Snapped(const Pose2& pose) {
  return {std::round(pose.x * 1e6) * 1e-6, std::round(pose.y * 1e6) * 1e-6,
          std::round(pose.theta * 1e9) * 1e-9};
}

void CheckRate(double rate, const char* what) {
  if (!(rate >= 0.0 && rate <= 1000.0)) {
    throw InputError(std::string("simulated ") + what + ": the rate is not within 0 to 1000 Hz");
  }
}

SimulationSummary SimulateUsualTour(const Building& building, const SimulationOptions& options,
                                    const SimulationNoise& noise, const SimulationSink& sink) {
  CheckRate(options.odometry_rate, "odometry");
  CheckRate(options.pressure.rate, "barometer");
  CheckRate(options.acceleration.rate, "accelerometer");
  if (!(options.length >= 0.0 && options.length <= 1e6)) {
    throw InputError("the length of a tour is not within 0 to 1000 km");
  }
  CheckBuilding(building, options.drive.robot_radius + kClearance);

  TourOptions tour_options;
  tour_options.seed = options.seed;
  tour_options.length = options.length;
  tour_options.visits = options.visits;
  const Tour tour = PlanTour(building, tour_options);
  DriveOptions drive_options = options.drive;
  drive_options.seed = options.seed;
  if (options.usual_rest) drive_options.rest_per_metre = building.usual_tour.rest_per_metre;
  const RobotDrive drive(building, tour, drive_options);

  LidarSimulation lidar(building, options.lidar, noise.lidar, options.seed);
  OdometrySimulation odometry(noise.odometry, options.seed);
  PressureSimulation pressure(options.pressure, noise.pressure, options.seed);
  AccelerationSimulation acceleration(noise.acceleration, options.seed);
  Ticks scan_ticks(options.lidar.rate, drive.Duration());
  Ticks odometry_ticks(options.odometry_rate, drive.Duration());
  Ticks pressure_ticks(options.pressure.rate, drive.Duration());
  Ticks acceleration_ticks(options.acceleration.rate, drive.Duration());

  const RobotState start = drive.At(0.0);
  const Pose2 T_building_world = Snapped(start.T_building_robot);
  Pose2 T_building_before = T_building_world;
  double before = 0.0;
  std::string label;
  SimulationSummary summary;
  summary.seconds = drive.Duration();
  summary.length = drive.Length();
  summary.floor_changes = tour.transits.size();
  summary.T_building_world = T_building_world;
  summary.start_floor = building.floors[start.floor].label;

  while (true) {
    const double time = std::min({scan_ticks.Next(), odometry_ticks.Next(), pressure_ticks.Next(),
                                  acceleration_ticks.Next()});
    if (time == Ticks::kNever) break;
    const double stamp = options.first_stamp + time;
    RobotState state = drive.At(time);
    state.T_building_robot = Snapped(state.T_building_robot);
    const auto emit = [&](const Observation& observation) {
      if (sink.observation) sink.observation(observation);
    };
    const bool scan_now = scan_ticks.Next() <= time;
    const std::string label_now = state.in_transit ? "-" : building.floors[state.floor].label;
    if (options.floor_labels && scan_now && label_now != label) {
      emit(FloorLabel{stamp, label_now});
      label = label_now;
    }
    if (pressure_ticks.Next() <= time) {
      pressure_ticks.Pass();
      emit(PressureReading{stamp, pressure.Measure(time, state.elevation)});
    }
    if (acceleration_ticks.Next() <= time) {
      acceleration_ticks.Pass();
      emit(AccelerationReading{stamp, acceleration.Measure(state)});
    }
    const bool odometry_now = odometry_ticks.Next() <= time;
    if (odometry_now || scan_now) {
      odometry.Advance(Between(T_building_before, state.T_building_robot), time - before);
      T_building_before = state.T_building_robot;
      before = time;
    }
    if (odometry_now) {
      odometry_ticks.Pass();
      if (!scan_now) emit(OdometryReading{stamp, odometry.T_odom_robot()});
    }
    if (!scan_now) continue;
    scan_ticks.Pass();
    ++summary.scans;
    if (sink.truth) {
      sink.truth({stamp, Between(T_building_world, state.T_building_robot),
                  state.elevation - start.elevation, label_now});
    }
    LaserScan scan = lidar.Scan(time, state);
    scan.stamp = stamp;
    scan.T_odom_robot = odometry.T_odom_robot();
    emit(scan);
    if (sink.progress && summary.scans % 256 == 0) sink.progress(time / drive.Duration());
  }
  if (sink.progress) sink.progress(1.0);
  return summary;
}

}  // namespace

SimulationNoise SimulationNoise::None() {
  return {LidarNoise::None(), OdometryNoise::None(), PressureNoise::None(),
          AccelerationNoise::None()};
}

SimulationSummary Simulate(const Building& building, const SimulationOptions& options,
                           const SimulationNoise& noise, const SimulationSink& sink) {
  if (options.tour == 1) return SimulateUsualTour(building, options, noise, sink);
  Building other_building = building;
  SimulationOptions other_options = options;
  other_building.usual_tour = OtherTour(building, options.seed, options.tour, options.visits);
  other_options.seed = RandomGenerator(options.seed, "tour " + std::to_string(options.tour)).Next();
  return SimulateUsualTour(other_building, other_options, noise, sink);
}

}  // namespace masked_mapper
