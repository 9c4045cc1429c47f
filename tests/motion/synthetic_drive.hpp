// SPDX-License-Identifier: BSD-3-Clause
// A robot's day in a building for the tests of floor sources: where the wheels were, how high the
// robot was, and on which floor, at any time. Floors are driven in circles with rests; elevators
// are entered, turned round in, ridden and left; stairs are driven.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class SyntheticDrive {
 public:
  struct State {
    double stamp = 0.0;
    Pose2 T_odom_robot;
    double height = 0.0;      ///< m
    std::size_t floor = 0;    ///< in transit: the floor left
    bool in_transit = false;  ///< the cab's door is not open, or on stairs
    double slope = 0.0;       ///< m up per metre driven
  };
  struct Ride {
    double start = 0.0;  ///< s, of the motion up or down
    double end = 0.0;
    std::size_t from = 0;
    std::size_t to = 0;
    double push = 0.0;  ///< m/s^2 up at the start, down at the end; 0: stairs
    double ramp = 0.0;  ///< s of speeding up, and of slowing down
  };

  SyntheticDrive(std::vector<double> elevations, std::size_t first_floor, unsigned seed)
      : elevations_(std::move(elevations)), random_(seed) {
    state_.floor = first_floor;
    state_.height = elevations_[first_floor];
  }

  /// Drives about on the floor for so long, resting now and then; then stands in front of a door.
  void Roam(double duration) {
    const double end = state_.stamp + duration;
    while (state_.stamp < end) {
      // Drawn one after the other: compilers differ in which argument they work out first.
      const double turning = Uniform(-0.3, 0.3);
      const double seconds = Uniform(3.0, 12.0);
      Move(seconds, 0.6, turning);
      if (Uniform(0.0, 1.0) < 0.2) Move(Uniform(1.0, 25.0), 0.0, 0.0);
    }
  }
  void Rest(double duration) { Move(duration, 0.0, 0.0); }
  /// Into the cab, turn, door closes.
  void EnterCab() {
    Move(2.5 / 0.6, 0.6, 0.0);
    Move(Uniform(1.0, 4.0), 0.0, 0.0);
    Move(kPi / 0.8, 0.04, 0.8);
    state_.in_transit = true;
    Move(Uniform(2.0, 6.0), 0.0, 0.0);
  }
  /// Speeds up and slows down with 0.8 m/s^2.
  void RideTo(std::size_t floor, double speed = 1.0) {
    const double from = state_.height;
    const double climb = elevations_[floor] - from;
    const double sign = climb < 0.0 ? -1.0 : 1.0;
    const double top = std::min(speed, std::sqrt(0.8 * std::abs(climb)));
    const double ramp = top / 0.8;
    const double duration = std::abs(climb) / top + ramp;
    const double start = state_.stamp;
    rides_.push_back({start, start + duration, state_.floor, floor, 0.8 * sign, ramp});
    const double ramp_climb = 0.4 * ramp * ramp;
    Append(duration, [&](State& state, double) {
      const double t = state.stamp - start;
      const double left = std::max(0.0, duration - t);
      double height = ramp_climb + top * (t - ramp);
      if (t < ramp) height = 0.4 * t * t;
      if (left < ramp) height = std::abs(climb) - 0.4 * left * left;
      state.height = from + sign * height;
    });
    state_.height = elevations_[floor];
    floor_reached_ = floor;
  }
  void LeaveCab() {
    Move(Uniform(2.0, 6.0), 0.0, 0.0);
    state_.in_transit = false;
    state_.floor = floor_reached_;
    Move(Uniform(0.5, 2.0), 0.0, 0.0);
    Move(2.5 / 0.6, 0.6, 0.0);
  }
  void TakeElevator(std::size_t floor, double speed = 1.0) {
    EnterCab();
    RideTo(floor, speed);
    LeaveCab();
  }
  /// Two flights with a slow turn between them.
  void TakeStairs(std::size_t floor) {
    const double climb = elevations_[floor] - state_.height;
    rides_.push_back({state_.stamp, 0.0, state_.floor, floor, 0.0, 0.0});
    state_.in_transit = true;
    const double half = 0.5 * std::abs(climb) / 0.3;
    Move(half, 0.5, 0.0, climb < 0.0 ? -0.3 : 0.3);
    Move(kPi / 0.8, 0.2, 0.8);
    Move(half, 0.5, 0.0, climb < 0.0 ? -0.3 : 0.3);
    state_.in_transit = false;
    state_.floor = floor;
    state_.height = elevations_[floor];
    rides_.back().end = state_.stamp;
  }

  /// At 5 Hz.
  const std::vector<State>& states() const { return states_; }
  const std::vector<Ride>& rides() const { return rides_; }
  const std::vector<double>& elevations() const { return elevations_; }
  double Duration() const { return states_.back().stamp; }
  double HeightAt(double stamp) const {
    const auto index = static_cast<std::size_t>(std::max(0.0, stamp / kPeriod));
    if (index + 1 >= states_.size()) return states_.back().height;
    const double fraction = stamp / kPeriod - static_cast<double>(index);
    return states_[index].height + fraction * (states_[index + 1].height - states_[index].height);
  }
  double SlopeAt(double stamp) const {
    const auto index = static_cast<std::size_t>(std::max(0.0, stamp / kPeriod));
    return states_[std::min(index, states_.size() - 1)].slope;
  }
  /// m/s^2 upwards, without gravity; `stamp` rises from call to call of one `ride` counter.
  double AccelerationAt(double stamp, std::size_t* ride) const {
    while (*ride + 1 < rides_.size() && rides_[*ride].end < stamp) ++*ride;
    if (rides_.empty()) return 0.0;
    const Ride& now = rides_[*ride];
    if (stamp < now.start || stamp > now.end) return 0.0;
    if (stamp < now.start + now.ramp) return now.push;
    return stamp > now.end - now.ramp ? -now.push : 0.0;
  }

 private:
  static constexpr double kPeriod = 0.2;

  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  template <typename Change>
  void Append(double duration, const Change& change) {
    const int steps = std::max(1, static_cast<int>(std::lround(duration / kPeriod)));
    for (int i = 0; i < steps; ++i) {
      states_.push_back(state_);
      state_.stamp = kPeriod * static_cast<double>(states_.size());
      change(state_, kPeriod);
    }
  }
  void Move(double duration, double speed, double turn_rate, double climb_rate = 0.0) {
    state_.slope = speed > 0.0 ? climb_rate / speed : 0.0;
    Append(duration, [&](State& state, double step) {
      state.T_odom_robot = state.T_odom_robot * Pose2{speed * step, 0.0, turn_rate * step};
      state.height += climb_rate * step;
    });
  }

  std::vector<double> elevations_;
  std::mt19937 random_;  // its numbers are the same everywhere, those of distributions are not
  State state_;
  std::size_t floor_reached_ = 0;
  std::vector<State> states_;
  std::vector<Ride> rides_;
};

struct SyntheticBarometer {
  double rate = 5.0;         ///< Hz
  double sigma = 0.25;       ///< m
  double weather = 5.0;      ///< m, over hours
  double pa_per_unit = 1.0;  ///< 100: hectopascals

  std::vector<PressureReading> Read(const SyntheticDrive& drive, unsigned seed) const {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0; };
    const double phases[3] = {6.28 * uniform(), 6.28 * uniform(), 6.28 * uniform()};
    const double periods[3] = {10'000.0, 4'000.0, 1'500.0};  // s
    const double shares[3] = {0.7, 0.2, 0.1};
    std::vector<PressureReading> readings;
    for (double t = 0.0; t < drive.Duration(); t += 1.0 / rate) {
      double height = drive.HeightAt(t);
      for (int k = 0; k < 3; ++k) {
        height += weather * shares[k] * std::sin(6.2832 * t / periods[k] + phases[k]);
      }
      double noise = -6.0;
      for (int k = 0; k < 12; ++k) noise += uniform();
      height += sigma * noise;
      readings.push_back({t, (101'000.0 - 12.0 * height) / pa_per_unit});
    }
    return readings;
  }
};

}  // namespace masked_mapper
