// SPDX-License-Identifier: BSD-3-Clause
#include "simulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acceleration.hpp"
#include "lidar_simulation.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "odometry_simulation.hpp"
#include "pressure.hpp"
#include "random_generator.hpp"
#include "robot_drive.hpp"
#include "space_lidar.hpp"
#include "tour.hpp"

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

void CheckOptions(const SimulationOptions& options) {
  CheckRate(options.odometry_rate, "odometry");
  CheckRate(options.pressure.rate, "barometer");
  CheckRate(options.acceleration.rate, "accelerometer");
  if (!(options.length >= 0.0 && options.length <= 1e6)) {
    throw InputError("the length of a tour is not within 0 to 1000 km");
  }
}

Tour TourOf(const Building& building, const SimulationOptions& options) {
  TourOptions tour_options;
  tour_options.seed = options.seed;
  tour_options.length = options.length;
  tour_options.visits = options.visits;
  return PlanTour(building, tour_options);
}

RobotDrive DriveOf(const Building& building, const Tour& tour, const SimulationOptions& options) {
  DriveOptions drive_options = options.drive;
  drive_options.seed = options.seed;
  if (options.usual_rest) drive_options.rest_per_metre = building.usual_tour.rest_per_metre;
  return RobotDrive(building, tour, drive_options);
}

/// The sensors of a robot on its drive, each at its own rate.
class DrivenSensors {
 public:
  DrivenSensors(const Building& building, const RobotDrive& drive, const SimulationOptions& options,
                const SimulationNoise& noise, const SimulationSink& sink)
      : building_(building),
        drive_(drive),
        options_(options),
        sink_(sink),
        lidar_(building, options.lidar, noise.lidar, options.seed),
        odometry_(noise.odometry, options.seed),
        pressure_(options.pressure, noise.pressure, options.seed),
        acceleration_(noise.acceleration, options.seed),
        scan_ticks_(options.space_lidar ? options.space_lidar->rate : options.lidar.rate,
                    drive.Duration()),
        odometry_ticks_(options.odometry_rate, drive.Duration()),
        pressure_ticks_(options.pressure.rate, drive.Duration()),
        acceleration_ticks_(options.acceleration.rate, drive.Duration()),
        start_(drive.At(0.0)),
        T_building_world_(Snapped(start_.T_building_robot)),
        T_building_before_(T_building_world_) {
    if (options.space_lidar) {
      space_lidar_.emplace(building, *options.space_lidar, noise.lidar, options.seed);
    }
  }

  const Pose2& T_building_world() const { return T_building_world_; }
  std::size_t start_floor() const { return start_.floor; }

  /// Measures all along the drive; how many scans there were.
  std::uint64_t Drive() {
    while (true) {
      const double time = std::min({scan_ticks_.Next(), odometry_ticks_.Next(),
                                    pressure_ticks_.Next(), acceleration_ticks_.Next()});
      if (time == Ticks::kNever) break;
      RobotState state = drive_.At(time);
      state.T_building_robot = Snapped(state.T_building_robot);
      MeasureAt(time, state);
    }
    if (sink_.progress) sink_.progress(1.0);
    return scans_;
  }

 private:
  void Emit(const Observation& observation) const {
    if (sink_.observation) sink_.observation(observation);
  }

  /// All that is due, in a fixed order: label, pressure, acceleration, odometry, scan.
  void MeasureAt(double time, const RobotState& state) {
    const double stamp = options_.first_stamp + time;
    const bool scan_now = scan_ticks_.Next() <= time;
    const std::string label_now = state.in_transit ? "-" : building_.floors[state.floor].label;
    if (options_.floor_labels && scan_now && label_now != label_) {
      Emit(FloorLabel{stamp, label_now});
      label_ = label_now;
    }
    if (pressure_ticks_.Next() <= time) {
      pressure_ticks_.Pass();
      Emit(PressureReading{stamp, pressure_.Measure(time, state.elevation)});
    }
    if (acceleration_ticks_.Next() <= time) {
      acceleration_ticks_.Pass();
      Emit(AccelerationReading{stamp, acceleration_.Measure(state)});
    }
    MeasureOdometry(time, stamp, state, scan_now);
    if (scan_now) MeasureScan(time, stamp, state, label_now);
  }

  void MeasureOdometry(double time, double stamp, const RobotState& state, bool scan_now) {
    const bool odometry_now = odometry_ticks_.Next() <= time;
    if (odometry_now || scan_now) {
      odometry_.Advance(Between(T_building_before_, state.T_building_robot), time - before_);
      T_building_before_ = state.T_building_robot;
      before_ = time;
    }
    if (!odometry_now) return;
    odometry_ticks_.Pass();
    if (!scan_now) Emit(OdometryReading{stamp, odometry_.T_odom_robot()});
  }

  void MeasureScan(double time, double stamp, const RobotState& state, const std::string& label) {
    scan_ticks_.Pass();
    ++scans_;
    if (sink_.truth) {
      sink_.truth({stamp, Between(T_building_world_, state.T_building_robot),
                   state.elevation - start_.elevation, label});
    }
    if (space_lidar_) {
      CloudReading cloud = space_lidar_->Sweep(time, [this](double t) { return drive_.At(t); });
      cloud.stamp = stamp;
      cloud.T_odom_robot = odometry_.T_odom_robot();
      if (sink_.cloud) sink_.cloud(cloud);
    } else {
      LaserScan scan = lidar_.Scan(time, state);
      scan.stamp = stamp;
      scan.T_odom_robot = odometry_.T_odom_robot();
      Emit(scan);
    }
    if (sink_.progress && scans_ % 256 == 0) sink_.progress(time / drive_.Duration());
  }

  const Building& building_;
  const RobotDrive& drive_;
  const SimulationOptions& options_;
  const SimulationSink& sink_;
  LidarSimulation lidar_;
  std::optional<SpaceLidar> space_lidar_;
  OdometrySimulation odometry_;
  PressureSimulation pressure_;
  AccelerationSimulation acceleration_;
  Ticks scan_ticks_;
  Ticks odometry_ticks_;
  Ticks pressure_ticks_;
  Ticks acceleration_ticks_;
  RobotState start_;
  Pose2 T_building_world_;
  Pose2 T_building_before_;
  double before_ = 0.0;
  std::string label_;
  std::uint64_t scans_ = 0;
};

SimulationSummary SimulateUsualTour(const Building& building, const SimulationOptions& options,
                                    const SimulationNoise& noise, const SimulationSink& sink) {
  CheckOptions(options);
  CheckBuilding(building, options.drive.robot_radius + kClearance);
  const Tour tour = TourOf(building, options);
  const RobotDrive drive = DriveOf(building, tour, options);
  DrivenSensors sensors(building, drive, options, noise, sink);
  SimulationSummary summary;
  summary.seconds = drive.Duration();
  summary.length = drive.Length();
  summary.floor_changes = tour.transits.size();
  summary.T_building_world = sensors.T_building_world();
  summary.start_floor = building.floors[sensors.start_floor()].label;
  summary.scans = sensors.Drive();
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
