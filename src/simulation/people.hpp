// SPDX-License-Identifier: BSD-3-Clause
// People who walk about a floor along its ways and stand about now and then. A scanner at shin
// height sees their legs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "random_generator.hpp"

namespace masked_mapper {

struct Leg {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;
};

class People {
 public:
  People(const Building& building, const PeopleOptions& options, std::uint64_t seed);

  /// The legs on a floor at a time (s, not before that of the last call), as seen from a robot.
  /// A floor just entered is populated anew.
  std::vector<Leg> LegsAt(double time, std::size_t floor, const Eigen::Vector2d& robot);

 private:
  struct Person {
    std::size_t from = 0;
    std::size_t to = 0;
    double along = 0.0;     ///< m from `from`
    double speed = 0.0;     ///< m/s
    double standing = 0.0;  ///< s left
    double stride = 0.0;    ///< rad, phase of the gait
  };

  void Populate(std::size_t floor);
  void Advance(Person& person, double seconds);
  void ChooseWay(Person& person);

  const Building& building_;
  PeopleOptions options_;
  RandomGenerator random_;
  std::size_t floor_;
  double time_ = 0.0;
  std::vector<std::vector<std::size_t>> neighbours_;  // per way-point of the floor
  std::vector<Person> persons_;
};

}  // namespace masked_mapper
