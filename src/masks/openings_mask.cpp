// SPDX-License-Identifier: BSD-3-Clause
#include "openings_mask.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

/// Shorter steps are noise of a robot at rest, m.
constexpr double kMinStep = 0.05;

}  // namespace

void Course::Observe(const Pose2& T_odom_robot) {
  if (!has_moved_) direction_ = T_odom_robot.theta;
  const Eigen::Vector2d here = T_odom_robot.Translation();
  if (path_in_odom_.empty()) path_in_odom_.push_back(here);
  const double step = (here - path_in_odom_.back()).norm();
  if (!(step >= kMinStep)) return;
  path_in_odom_.push_back(here);
  path_length_ += step;
  while (path_in_odom_.size() > 2) {
    const double oldest = (path_in_odom_[1] - path_in_odom_[0]).norm();
    if (path_length_ - oldest < distance_m_) break;
    path_length_ -= oldest;
    path_in_odom_.pop_front();
  }
  const Eigen::Vector2d travelled = here - path_in_odom_.front();
  // Half the path is what tells travel from moving about one spot.
  if (travelled.norm() < 0.5 * distance_m_) return;
  direction_ = std::atan2(travelled.y(), travelled.x());
  has_moved_ = true;
}

void DeadEnd::Observe(const Pose2& T_odom_robot) {
  if (T_odom_robot_) forward_ += Between(*T_odom_robot_, T_odom_robot).x;
  T_odom_robot_ = T_odom_robot;
  if (!T_odom_node_) T_odom_node_ = T_odom_robot;
}

double DeadEnd::Turned(double min_distance_m) const {
  if (!T_odom_node_ || Distance(*T_odom_node_, *T_odom_robot_) < min_distance_m) return 0.0;
  const double travel =
      std::atan2(T_odom_robot_->y - T_odom_node_->y, T_odom_robot_->x - T_odom_node_->x);
  // A robot that reverses has not turned, whatever it calls its front.
  const double faced = forward_ < 0.0 ? travel + kPi : travel;
  return std::abs(WrapAngle(T_odom_robot_->theta - faced));
}

void DirectionTracks::Observe(double path_length, const std::vector<double>& directions_in_odom) {
  path_lengths_.push_back(path_length);
  const std::size_t view = next_view_++;
  Forget();
  // Each direction goes on with the nearest track that this view has not yet prolonged.
  for (const double direction : directions_in_odom) {
    Track* nearest = nullptr;
    double smallest_jump = DegToRad(options_.max_jump_deg);
    for (Track& track : tracks_) {
      if (track.back().view == view) continue;
      const double jump = std::abs(WrapAngle(direction - track.back().direction));
      if (jump > smallest_jump) continue;
      smallest_jump = jump;
      nearest = &track;
    }
    if (nearest == nullptr) {
      tracks_.push_back({{view, direction}});
    } else {
      const double last = nearest->back().direction;
      nearest->push_back({view, last + WrapAngle(direction - last)});
    }
  }
}

void DirectionTracks::Forget() {
  const auto min_views = static_cast<std::size_t>(std::max(1, options_.min_views));
  const auto max_views = static_cast<std::size_t>(std::max(1, options_.max_views));
  const auto is_beyond_horizon = [&](double path_length) {
    return path_lengths_.size() > max_views ||
           (path_lengths_.size() > min_views &&
            path_lengths_.back() - path_length > options_.horizon_m);
  };
  while (is_beyond_horizon(path_lengths_.front())) path_lengths_.pop_front();
  const std::size_t oldest = next_view_ - path_lengths_.size();
  for (Track& track : tracks_) {
    while (!track.empty() && track.front().view < oldest) track.pop_front();
  }
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [](const Track& track) { return track.empty(); }),
                tracks_.end());
}

std::vector<double> DirectionTracks::Kept() const {
  std::vector<double> kept;
  if (path_lengths_.size() < static_cast<std::size_t>(std::max(1, options_.min_views))) return kept;
  for (const Track& track : tracks_) {
    const auto count = static_cast<double>(track.size());
    if (count < options_.min_share * static_cast<double>(path_lengths_.size())) continue;
    double mean = 0.0;
    for (const Sighting& sighting : track) mean += sighting.direction / count;
    double variance = 0.0;
    for (const Sighting& sighting : track) {
      variance += (sighting.direction - mean) * (sighting.direction - mean) / count;
    }
    if (std::sqrt(variance) <= DegToRad(options_.max_deviation_deg))
      kept.push_back(WrapAngle(mean));
  }
  return kept;
}

OpeningsMask::OpeningsMask(const OpeningsMaskOptions& options)
    : options_(options), tracks_(options), course_(options.course_distance_m) {}

bool OpeningsMask::IsNewView(const Pose2& T_odom_robot) const {
  if (!T_odom_view_) return true;
  return Distance(*T_odom_view_, T_odom_robot) >= options_.view_step_m ||
         std::abs(WrapAngle(T_odom_robot.theta - T_odom_view_->theta)) >=
             DegToRad(options_.view_step_deg);
}

void OpeningsMask::Observe(const MaskObservation& observation) {
  const Pose2& T_odom_robot = observation.T_odom_robot;
  course_.Observe(T_odom_robot);
  dead_end_.Observe(T_odom_robot);
  if (IsNewView(T_odom_robot)) {
    if (T_odom_view_) path_length_ += Distance(*T_odom_view_, T_odom_robot);
    T_odom_view_ = T_odom_robot;
    std::vector<double> directions_in_odom;
    for (const Opening& opening : FindOpenings(observation.scan, options_.detection)) {
      directions_in_odom.push_back(T_odom_robot.theta + opening.direction);
    }
    tracks_.Observe(path_length_, directions_in_odom);
  }

  // (e)
  const std::vector<double> kept = tracks_.Kept();
  fires_ = std::any_of(kept.begin(), kept.end(), [&](double direction_in_odom) {
    const double turn = std::abs(WrapAngle(direction_in_odom - course_.Direction()));
    return turn >= DegToRad(options_.min_turn_deg) && turn <= DegToRad(options_.max_turn_deg);
  });
  // (f)
  if (dead_end_.Turned(options_.dead_end_distance_m) > DegToRad(options_.dead_end_turn_deg)) {
    fires_ = true;
  }
}

void OpeningsMask::Restart() { *this = OpeningsMask(options_); }

}  // namespace masked_mapper
