// SPDX-License-Identifier: BSD-3-Clause
#include "robot_drive.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "random_generator.hpp"
#include "segment_index.hpp"

namespace masked_mapper {
namespace {

constexpr double kMargin = 0.05;           // m, kept beyond the robot's radius
constexpr double kSharpest = 100.0;        // deg; sharper corners are turned on the spot
constexpr double kRideAcceleration = 0.8;  // m/s^2, on average over a ramp
constexpr double kRideSpeed = 1.5;         // m/s
constexpr double kDoorSeconds = 2.6;

/// A line (curvature 0) or an arc of the path in the plane.
struct Piece {
  Pose2 T_building_start;
  double length = 0.0;
  double curvature = 0.0;
};

Pose2 Along(const Pose2& T_building_start, double curvature, double distance) {
  const double turn = curvature * distance;
  Pose2 T_start_end;
  if (std::abs(turn) < 1e-9) {
    T_start_end = {distance, 0.5 * turn * distance, turn};
  } else {
    T_start_end = {std::sin(turn) / curvature, (1.0 - std::cos(turn)) / curvature, turn};
  }
  return T_building_start * T_start_end;
}

double Heading(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

template <typename T>
const T* LastStartedAt(const std::vector<T>& spans, double time) {
  const auto after = std::upper_bound(spans.begin(), spans.end(), time,
                                      [](double t, const T& span) { return t < span.start; });
  return after == spans.begin() ? nullptr : &*(after - 1);
}

}  // namespace

/// Lays motions one after another.
class DriveBuilder {
 public:
  DriveBuilder(const Building& building, const DriveOptions& options, RobotDrive& drive)
      : building_(building), options_(options), drive_(drive), random_(options.seed, "drive") {
    for (std::size_t f = 0; f < building.floors.size(); ++f) {
      standing_.emplace_back(StandingSegments(building, f));
      free_.emplace_back();
      for (const Passage& passage : building.floors[f].passages) {
        free_.back().push_back(
            standing_[f].Clearance(building.floors[f].way_points[passage.from].position,
                                   building.floors[f].way_points[passage.to].position, 2.0) -
            options.robot_radius - 2.0 * kMargin);
      }
    }
    next_rest_ = RestDistance();
  }

  void Build(const Tour& tour) {
    const TourLeg& first = tour.legs.front();
    floor_ = first.floor;
    const FloorPlan& floor = building_.floors[floor_];
    const Eigen::Vector2d start = floor.way_points[first.way_points.front()].position;
    pose_ = {start.x(), start.y(), 0.0};
    if (first.way_points.size() > 1) {
      pose_.theta = Heading(floor.way_points[first.way_points[1]].position - start);
    }
    elevation_ = floor.elevation;
    drive_.floor_spans_.push_back({0.0, floor_, false});
    Wait(2.0);
    for (std::size_t l = 0; l < tour.legs.size(); ++l) {
      Follow(PathOf(tour.legs[l]), 0.0, 0.0);
      if (l == tour.transits.size()) break;
      const Transit& transit = tour.transits[l];
      const Landing to{tour.legs[l + 1].floor, tour.legs[l + 1].way_points.front()};
      if (transit.kind == Transit::Kind::kElevator) {
        TakeElevator(transit.index, to);
      } else {
        TakeStairs(building_.stairs[transit.index], to);
      }
    }
    Wait(2.0);
    drive_.duration_ = time_;
  }

 private:
  double RestDistance() { return options_.rest_every * random_.Uniform(0.3, 1.7); }

  void Push(double seconds, const RobotDrive::Motion& motion) {
    if (!(seconds > 0.0)) return;
    drive_.motions_.push_back(motion);
    time_ += seconds;
  }

  RobotDrive::Motion Still() const {
    RobotDrive::Motion motion;
    motion.start = time_;
    motion.T_building_robot = pose_;
    motion.elevation = elevation_;
    return motion;
  }

  void Wait(double seconds) { Push(seconds, Still()); }

  /// Turns on the spot by an angle, radians, with a trapezium of turn rate.
  void Turn(double angle) {
    if (std::abs(angle) < 1e-9) return;
    const double sign = angle > 0.0 ? 1.0 : -1.0;
    const double size = std::abs(angle);
    const double peak = std::min(options_.turn_rate, std::sqrt(size * options_.turn_acceleration));
    const double ramp = peak / options_.turn_acceleration;
    const double cruise = size / peak - ramp;
    const auto phase = [&](double seconds, double rate, double acceleration) {
      RobotDrive::Motion motion = Still();
      motion.turn_rate = sign * rate;
      motion.turn_acceleration = sign * acceleration;
      Push(seconds, motion);
      pose_.theta =
          WrapAngle(pose_.theta + sign * (rate * seconds + 0.5 * acceleration * seconds * seconds));
    };
    const double goal = WrapAngle(pose_.theta + angle);
    phase(ramp, 0.0, options_.turn_acceleration);
    if (cruise > 0.0) phase(cruise, peak, 0.0);
    phase(ramp, peak, -options_.turn_acceleration);
    pose_.theta = goal;
  }

  void TurnTo(double heading) {
    double angle = WrapAngle(heading - pose_.theta);
    // Right about: either way round.
    if (std::abs(angle) > DegToRad(175.0) && random_.Chance(0.5)) {
      angle -= angle > 0.0 ? 2.0 * kPi : -2.0 * kPi;
    }
    Turn(angle);
  }

  /// The points of a leg, off the way-points and off the middle of the ways by what is free there.
  std::vector<Eigen::Vector2d> PathOf(const TourLeg& leg) {
    const FloorPlan& floor = building_.floors[leg.floor];
    const std::vector<double>& free = free_[leg.floor];
    const auto free_between = [&](std::size_t a, std::size_t b) {
      double most = 0.0;
      for (std::size_t p = 0; p < floor.passages.size(); ++p) {
        const Passage& passage = floor.passages[p];
        if ((passage.from == a && passage.to == b) || (passage.from == b && passage.to == a)) {
          most = std::max(most, free[p]);
        }
      }
      return std::clamp(most, 0.0, options_.wander);
    };
    std::vector<Eigen::Vector2d> path{pose_.Translation()};
    for (std::size_t i = 1; i < leg.way_points.size(); ++i) {
      const Eigen::Vector2d& from = floor.way_points[leg.way_points[i - 1]].position;
      const Eigen::Vector2d& to = floor.way_points[leg.way_points[i]].position;
      const double free_here = free_between(leg.way_points[i - 1], leg.way_points[i]);
      const Eigen::Vector2d way = to - from;
      const double length = way.norm();
      if (!(length > 0.0)) continue;
      const Eigen::Vector2d left(-way.y() / length, way.x() / length);
      const int bends = static_cast<int>(length / 6.0);
      for (int bend = 0; bend < bends; ++bend) {
        const double share = (bend + random_.Uniform(0.3, 0.7)) / bends;
        const double aside = free_here * random_.Uniform(-0.8, 0.8);
        path.emplace_back(from + share * way + aside * left);
      }
      if (i + 1 == leg.way_points.size()) {
        path.push_back(to);  // an elevator or the end: exactly there
      } else {
        const double free_there =
            std::min(free_here, free_between(leg.way_points[i], leg.way_points[i + 1]));
        const double reach = 0.5 * free_there;
        const double x = random_.Uniform(-reach, reach);
        const double y = random_.Uniform(-reach, reach);
        path.emplace_back(to + Eigen::Vector2d(x, y));
      }
    }
    std::vector<Eigen::Vector2d> apart{path.front()};
    for (std::size_t i = 1; i < path.size(); ++i) {
      if ((path[i] - apart.back()).norm() > 0.05) {
        apart.push_back(path[i]);
      } else if (i + 1 == path.size() && apart.size() > 1) {
        apart.back() = path[i];
      }
    }
    return apart;
  }

  bool IsFree(const Piece& piece) const {
    const int steps = 1 + static_cast<int>(piece.length / 0.04);
    for (int step = 0; step <= steps; ++step) {
      const Eigen::Vector2d at =
          Along(piece.T_building_start, piece.curvature, piece.length * step / steps).Translation();
      const double wanted = options_.robot_radius + 0.5 * kMargin;
      if (standing_[floor_].Clearance(at, wanted) < wanted) return false;
    }
    return true;
  }

  /// An arc that rounds the corner a-b-c, beginning and ending as far from b as space and the
  /// neighbours allow; none where the robot had better turn on the spot.
  std::optional<Piece> Corner(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector2d& c) const {
    const double heading = Heading(b - a);
    const double turn = WrapAngle(Heading(c - b) - heading);
    if (std::abs(turn) > DegToRad(kSharpest)) return std::nullopt;
    if (std::abs(turn) < 1e-6) return std::nullopt;
    const double half_tangent = std::tan(0.5 * std::abs(turn));
    double reach =
        std::min({0.45 * (b - a).norm(), 0.45 * (c - b).norm(), 6.0 * half_tangent, 1.1});
    for (; reach > 0.15 * half_tangent; reach *= 0.7) {
      const Eigen::Vector2d start = b - reach * (b - a).normalized();
      Piece piece;
      piece.T_building_start = {start.x(), start.y(), heading};
      piece.curvature = (turn > 0.0 ? 1.0 : -1.0) * half_tangent / reach;
      piece.length = turn / piece.curvature;
      if (IsFree(piece)) return piece;
    }
    return std::nullopt;
  }

  /// Drives along a polyline that begins here, climbing `rise` metres on the way. `speed` 0: a pace
  /// is drawn.
  void Follow(const std::vector<Eigen::Vector2d>& points, double speed, double rise) {
    std::vector<std::vector<Piece>> runs(1);  // between stops
    double total = 0.0;
    const auto line = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
      const Eigen::Vector2d way = to - from;
      const double length = way.norm();
      if (length < 1e-6) return;
      Piece piece;
      piece.T_building_start = {from.x(), from.y(), Heading(way)};
      piece.length = length;
      // A rest that is due on an arc is taken on the next line that is long enough.
      const double rest_at = std::max(next_rest_ - (drive_.length_ + total), 0.3);
      total += length;
      if (rise == 0.0 && rest_at < length - 0.3) {
        Piece before = piece;
        before.length = rest_at;
        piece.T_building_start = Along(piece.T_building_start, 0.0, rest_at);
        piece.length -= rest_at;
        runs.back().push_back(before);
        runs.emplace_back();
        next_rest_ = drive_.length_ + total - length + rest_at + RestDistance();
      }
      runs.back().push_back(piece);
    };
    Eigen::Vector2d at = points.front();
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (i + 1 == points.size()) {
        line(at, points[i]);
        break;
      }
      const std::optional<Piece> corner = Corner(points[i - 1], points[i], points[i + 1]);
      if (corner) {
        line(at, corner->T_building_start.Translation());
        runs.back().push_back(*corner);
        total += corner->length;
        at = Along(corner->T_building_start, corner->curvature, corner->length).Translation();
      } else {
        line(at, points[i]);
        at = points[i];
        const double turn =
            WrapAngle(Heading(points[i + 1] - points[i]) - Heading(points[i] - points[i - 1]));
        if (std::abs(turn) >= 1e-6) runs.emplace_back();
      }
    }
    const double slope = total > 0.0 ? rise / total : 0.0;
    for (const std::vector<Piece>& run : runs) {
      if (run.empty()) continue;
      const double turn = WrapAngle(run.front().T_building_start.theta - pose_.theta);
      if (std::abs(turn) > 1e-6) {
        TurnTo(run.front().T_building_start.theta);
      } else if (time_ > 2.5 && rise == 0.0) {
        Wait(options_.rest_per_metre * options_.rest_every * random_.Uniform(0.2, 1.8));
      }
      DriveRun(run, speed > 0.0 ? speed : random_.Uniform(options_.speed_min, options_.speed_max),
               slope);
    }
  }

  /// From rest to rest over pieces, each with its own limit of speed.
  void DriveRun(const std::vector<Piece>& run, double pace, double slope) {
    const double a = options_.acceleration;
    std::vector<double> limit;
    for (const Piece& piece : run) {
      limit.push_back(piece.curvature == 0.0
                          ? pace
                          : std::min(pace, options_.turn_rate / std::abs(piece.curvature)));
    }
    std::vector<double> border(run.size() + 1, 0.0);  // speed at the ends of pieces
    for (std::size_t i = 1; i < run.size(); ++i) {
      border[i] =
          std::min({limit[i - 1], limit[i],
                    std::sqrt(border[i - 1] * border[i - 1] + 2.0 * a * run[i - 1].length)});
    }
    for (std::size_t i = run.size(); i-- > 1;) {
      border[i] =
          std::min(border[i], std::sqrt(border[i + 1] * border[i + 1] + 2.0 * a * run[i].length));
    }
    for (std::size_t i = 0; i < run.size(); ++i) {
      const Piece& piece = run[i];
      const double v0 = border[i];
      const double v1 = border[i + 1];
      const double peak =
          std::min(limit[i], std::sqrt(0.5 * (v0 * v0 + v1 * v1) + a * piece.length));
      const double up = std::max(0.0, (peak * peak - v0 * v0) / (2.0 * a));
      const double down = std::max(0.0, (peak * peak - v1 * v1) / (2.0 * a));
      const double cruise = std::max(0.0, piece.length - up - down);
      double done = 0.0;
      const auto phase = [&](double distance, double from, double to) {
        if (distance < 1e-9) return;
        const double seconds = 2.0 * distance / (from + to);
        RobotDrive::Motion motion = Still();
        motion.T_building_robot = Along(piece.T_building_start, piece.curvature, done);
        motion.speed = from;
        motion.acceleration = (to - from) / seconds;
        motion.curvature = piece.curvature;
        motion.slope = slope;
        Push(seconds, motion);
        elevation_ += slope * distance;
        done += distance;
      };
      phase(up, v0, peak);
      phase(cruise, peak, peak);
      phase(down, peak, v1);
      drive_.length_ += piece.length;
      pose_ = Along(piece.T_building_start, piece.curvature, piece.length);
    }
  }

  void MoveDoor(std::size_t elevator, double from, double to) {
    drive_.door_moves_.push_back({time_, time_ + kDoorSeconds, elevator, from, to});
  }

  void TakeElevator(std::size_t index, const Landing& to) {
    const Elevator& elevator = building_.elevators[index];
    const Pose2& T_building_cab = elevator.T_building_cab;
    const double stop_short = random_.Uniform(-0.08, 0.08);
    const Eigen::Vector2d inside = T_building_cab * Eigen::Vector2d(stop_short, 0.0);
    const double out = T_building_cab.theta;
    enum { kBefore, kDuring, kAfter } turn;
    const double when = random_.Uniform();
    turn = when < 0.35 ? kBefore : when < 0.75 ? kDuring : kAfter;

    TurnTo(Heading(inside - pose_.Translation()));
    Wait(random_.Uniform(4.0, 25.0));
    MoveDoor(index, 0.0, 1.0);
    Wait(kDoorSeconds + random_.Uniform(0.3, 1.2));
    Follow({pose_.Translation(), inside}, 0.5, 0.0);
    if (turn == kBefore) TurnTo(out);
    Wait(random_.Uniform(0.5, 2.0));
    drive_.floor_spans_.push_back({time_, floor_, true});
    MoveDoor(index, 1.0, 0.0);
    Wait(kDoorSeconds + random_.Uniform(0.5, 2.0));

    // Speed rises and falls as a smooth step, so the acceleration is two pulses of opposite sign.
    RobotDrive::Ride ride;
    ride.start = time_;
    ride.from = building_.floors[floor_].elevation;
    ride.to = building_.floors[to.floor].elevation;
    const double height = std::abs(ride.to - ride.from);
    const double peak = std::min(kRideSpeed, std::sqrt(height * kRideAcceleration));
    ride.ramp = peak / kRideAcceleration;
    ride.end = time_ + height / peak + ride.ramp;
    drive_.rides_.push_back(ride);
    elevation_ = ride.to;  // of motions that outlast the ride; before that the ride has the say
    const double half_way = 0.5 * (ride.start + ride.end);
    drive_.floor_spans_.push_back({half_way, to.floor, true});
    Wait(random_.Uniform(0.2, 1.5));
    if (turn == kDuring) TurnTo(out);
    if (time_ < ride.end) Wait(ride.end - time_);
    floor_ = to.floor;
    Wait(random_.Uniform(0.4, 1.2));
    MoveDoor(index, 0.0, 1.0);
    Wait(kDoorSeconds);
    drive_.floor_spans_.push_back({time_, floor_, false});
    Wait(random_.Uniform(0.3, 1.5));
    TurnTo(out);
    const Eigen::Vector2d landing = building_.floors[to.floor].way_points[to.way_point].position;
    Follow({pose_.Translation(), landing}, 0.5, 0.0);
    MoveDoor(index, 1.0, 0.0);
    Wait(0.4);
  }

  void TakeStairs(const Stairs& stairs, const Landing& to) {
    const bool up = to.floor == stairs.upper.floor && floor_ == stairs.lower.floor;
    const auto [lower, upper] = StairsHalves(building_, stairs);
    std::vector<Eigen::Vector2d> way = lower;
    way.insert(way.end(), upper.begin() + 1, upper.end());
    // The point half-way is no corner.
    way.erase(way.begin() + static_cast<std::ptrdiff_t>(lower.size()) - 1);
    if (!up) std::reverse(way.begin(), way.end());
    drive_.floor_spans_.push_back({time_, floor_, true});
    const double start = time_;
    const double rise = building_.floors[to.floor].elevation - building_.floors[floor_].elevation;
    const double half_height = elevation_ + 0.5 * rise;
    Follow(way, options_.stairs_speed, rise);
    drive_.duration_ = time_;
    double before = start;
    double after = time_;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (before + after);
      ((drive_.At(middle).elevation < half_height) == up ? before : after) = middle;
    }
    floor_ = to.floor;
    elevation_ = building_.floors[to.floor].elevation;
    drive_.floor_spans_.push_back({after, floor_, true});
    drive_.floor_spans_.push_back({time_, floor_, false});
    Wait(0.3);
  }

  const Building& building_;
  const DriveOptions& options_;
  RobotDrive& drive_;
  RandomGenerator random_;
  std::vector<SegmentIndex> standing_;     // per floor
  std::vector<std::vector<double>> free_;  // per floor and passage, m to either side
  double time_ = 0.0;
  Pose2 pose_;  // T_building_robot
  double elevation_ = 0.0;
  std::size_t floor_ = 0;
  double next_rest_ = 0.0;  // m
};

RobotDrive::RobotDrive(const Building& building, const Tour& tour, const DriveOptions& options) {
  DriveBuilder(building, options, *this).Build(tour);
}

RobotState RobotDrive::At(double time) const {
  RobotState state;
  time = std::clamp(time, 0.0, duration_);
  const Motion* motion = LastStartedAt(motions_, time);
  assert(motion != nullptr);
  const double t = time - motion->start;
  const double distance = motion->speed * t + 0.5 * motion->acceleration * t * t;
  const double spin = motion->turn_rate * t + 0.5 * motion->turn_acceleration * t * t;
  state.T_building_robot = Along(motion->T_building_robot, motion->curvature, distance);
  state.T_building_robot.theta = WrapAngle(state.T_building_robot.theta + spin);
  state.elevation = motion->elevation + motion->slope * distance;
  state.slope = motion->slope;
  state.speed = motion->speed + motion->acceleration * t;
  state.speed_change = motion->acceleration;
  state.turn_rate =
      motion->turn_rate + motion->turn_acceleration * t + motion->curvature * state.speed;
  if (const FloorSpan* span = LastStartedAt(floor_spans_, time)) {
    state.floor = span->floor;
    state.in_transit = span->in_transit;
  }
  if (const DoorMove* move = LastStartedAt(door_moves_, time)) {
    const double share = std::clamp((time - move->start) / (move->end - move->start), 0.0, 1.0);
    state.elevator = move->elevator;
    state.door_open = move->from + share * (move->to - move->from);
  }
  if (const Ride* ride = LastStartedAt(rides_, time); ride != nullptr && time < ride->end) {
    // Over a ramp of length r the speed is peak * (3 u^2 - 2 u^3), u = t / r.
    const double sign = ride->to > ride->from ? 1.0 : -1.0;
    const double seconds = ride->end - ride->start;
    const double peak = std::abs(ride->to - ride->from) / (seconds - ride->ramp);
    const auto height = [&](double elapsed) {
      const double u = std::clamp(elapsed / ride->ramp, 0.0, 1.0);
      return peak * ride->ramp * (u * u * u - 0.5 * u * u * u * u) +
             peak * std::max(0.0, elapsed - ride->ramp);
    };
    const auto pulse = [&](double elapsed) {
      const double u = std::clamp(elapsed / ride->ramp, 0.0, 1.0);
      return peak / ride->ramp * 6.0 * u * (1.0 - u);
    };
    const double elapsed = time - ride->start;
    const double left = ride->end - time;
    const bool speeding = elapsed < seconds - ride->ramp;
    state.elevation =
        speeding ? ride->from + sign * height(elapsed) : ride->to - sign * height(left);
    state.vertical_acceleration = sign * (pulse(elapsed) - pulse(left));
  }
  return state;
}

}  // namespace masked_mapper
