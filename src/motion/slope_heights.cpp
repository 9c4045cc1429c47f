// SPDX-License-Identifier: BSD-3-Clause
#include "slope_heights.hpp"

#include <cmath>
#include <utility>

#include "masked_mapper/geometry/median.hpp"

namespace masked_mapper {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2
constexpr double kSpell = 0.5;        // s between heights
constexpr double kSigma = 0.05;       // m: speeding up to 1 m/s looks like a climb of 5 cm

}  // namespace

PressureHeights SlopeHeights(const std::vector<TiltSample>& samples,
                             const Eigen::Vector3d& up_in_robot, const WheelTrack& track) {
  PressureHeights heights;
  heights.sigma = kSigma;
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX() - up_in_robot.x() * up_in_robot;
  if (samples.empty() || !track.Travels() || !(ahead.norm() > 0.5)) return heights;
  ahead.normalize();
  std::vector<double> ways = {0.0};
  std::vector<double> sines;   // of the pitch, and of how the sensor is mounted
  std::vector<double> driven;  // of those, the ones on the way
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) ways.push_back(track.Travel(samples[i - 1].stamp, samples[i].stamp));
    sines.push_back(ahead.dot(samples[i].acceleration_in_robot) / kGravity);
    if (ways.back() > 0.0) driven.push_back(sines.back());
  }
  if (driven.empty()) return heights;
  const double level = Median(std::move(driven));  // most of the way is
  double height = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    height += ways[i] * (sines[i] - level);
    if (heights.samples.empty() || samples[i].stamp >= heights.samples.back().stamp + kSpell) {
      heights.samples.push_back({samples[i].stamp, height});
    }
  }
  return heights;
}

}  // namespace masked_mapper
