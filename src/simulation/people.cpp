// SPDX-License-Identifier: BSD-3-Clause
#include "people.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kStep = 0.7;         // m per step
constexpr double kHalfHips = 0.11;    // m
constexpr double kHalfStride = 0.28;  // m

}  // namespace

People::People(const Building& building, const PeopleOptions& options, std::uint64_t seed)
    : building_(building),
      options_(options),
      random_(seed, "people"),
      floor_(building.floors.size()) {}

void People::Populate(std::size_t floor) {
  floor_ = floor;
  persons_.clear();
  const FloorPlan& plan = building_.floors[floor];
  neighbours_.assign(plan.way_points.size(), {});
  double length = 0.0;
  for (const Passage& passage : plan.passages) {
    neighbours_[passage.from].push_back(passage.to);
    neighbours_[passage.to].push_back(passage.from);
    length +=
        (plan.way_points[passage.to].position - plan.way_points[passage.from].position).norm();
  }
  if (plan.passages.empty()) return;
  const auto count =
      static_cast<std::size_t>(std::lround(options_.per_kilometre * length / 1000.0));
  for (std::size_t i = 0; i < count; ++i) {
    const Passage& passage = plan.passages[random_.Below(plan.passages.size())];
    Person person;
    person.from = passage.from;
    person.to = passage.to;
    person.speed = options_.speed * random_.Uniform(0.75, 1.25);
    person.along =
        random_.Uniform() *
        (plan.way_points[passage.to].position - plan.way_points[passage.from].position).norm();
    person.stride = random_.Uniform(0.0, 2.0 * kPi);
    persons_.push_back(person);
  }
}

void People::ChooseWay(Person& person) {
  const std::vector<std::size_t>& next = neighbours_[person.to];
  std::size_t choice = next[random_.Below(next.size())];
  if (choice == person.from) choice = next[random_.Below(next.size())];
  person.from = person.to;
  person.to = choice;
  person.along = 0.0;
  if (random_.Chance(options_.stand_share)) person.standing = random_.Uniform(2.0, 30.0);
}

void People::Advance(Person& person, double seconds) {
  const FloorPlan& plan = building_.floors[floor_];
  // A way may be shorter than a step of time; the count bounds ways of no length.
  for (int ways = 0; ways < 8 && seconds > 0.0; ++ways) {
    if (person.standing > 0.0) {
      const double rest = std::min(person.standing, seconds);
      person.standing -= rest;
      seconds -= rest;
      continue;
    }
    const double length =
        (plan.way_points[person.to].position - plan.way_points[person.from].position).norm();
    const double step = std::min(seconds, std::max(0.0, length - person.along) / person.speed);
    person.along += step * person.speed;
    person.stride += kPi * step * person.speed / kStep;
    seconds -= step;
    if (person.along >= length - 1e-9) ChooseWay(person);
  }
}

std::vector<Leg> People::LegsAt(double time, std::size_t floor, const Eigen::Vector2d& robot) {
  if (floor != floor_) {
    Populate(floor);
  } else {
    for (Person& person : persons_) Advance(person, time - time_);
  }
  time_ = time;
  std::vector<Leg> legs;
  const FloorPlan& plan = building_.floors[floor];
  for (const Person& person : persons_) {
    const Eigen::Vector2d& from = plan.way_points[person.from].position;
    const Eigen::Vector2d way = plan.way_points[person.to].position - from;
    const double length = way.norm();
    if (!(length > 0.0)) continue;
    const Eigen::Vector2d ahead = way / length;
    const Eigen::Vector2d right(ahead.y(), -ahead.x());
    const Eigen::Vector2d at = from + person.along * ahead + options_.aside * right;
    if ((at - robot).norm() < options_.keep_from_robot) continue;
    const double swing = person.standing > 0.0 ? 0.0 : kHalfStride * std::sin(person.stride);
    legs.push_back({at + kHalfHips * right + swing * ahead, options_.leg_radius});
    legs.push_back({at - kHalfHips * right - swing * ahead, options_.leg_radius});
  }
  return legs;
}

}  // namespace masked_mapper
