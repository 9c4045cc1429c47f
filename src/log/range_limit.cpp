// SPDX-License-Identifier: BSD-3-Clause
#include "range_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kValuesKept = 128;
constexpr std::size_t kPlacesWanted = 3;
constexpr double kPlacesApart = 1.0;      // m
constexpr float kNearer = 0.9F;           // of the value: something stands between two directions
constexpr double kDirectionsApart = 5.0;  // deg
constexpr std::uint64_t kLeastCount = 5;
constexpr double kDominance = 5.0;  // times all values just below together
constexpr float kJustBelow = 0.98F;
// SICK scanners give 81.83 to 81.91 m for different kinds of no return.
constexpr float kCodesBelow = 0.9985F;
constexpr double kOutliers = 0.05;  // share of larger values, which are mistakes in the log

}  // namespace

void RangeLimitFinder::Add(const std::vector<float>& ranges, double angle_step,
                           const Pose2& T_odom_robot) {
  ++scans_;
  float scan_farthest = 0.0F;
  for (const float range : ranges) {
    if (!std::isfinite(range) || range <= 0.0F) continue;
    ++ranges_;
    if (range < kAbsurdRange) farthest_ = std::max(farthest_, range);
    if (farthest_values_.size() >= kValuesKept && range < farthest_values_.begin()->first) continue;
    scan_farthest = std::max(scan_farthest, range);
    Value& value = farthest_values_[range];
    ++value.count;
    const bool new_place =
        value.places.size() < kPlacesWanted &&
        std::all_of(value.places.begin(), value.places.end(), [&](const Pose2& place) {
          return Distance(place, T_odom_robot) > kPlacesApart;
        });
    if (new_place) value.places.push_back(T_odom_robot);
    if (farthest_values_.size() > kValuesKept) farthest_values_.erase(farthest_values_.begin());
  }
  if (scan_farthest > 0.0F) AddSpread(ranges, angle_step);
}

/// A flat wall gives one exact value over a few beams only, and gives it again in another direction
/// only by chance; the word for "no return" stands wherever nothing is.
void RangeLimitFinder::AddSpread(const std::vector<float>& ranges, double angle_step) {
  const float word = *std::max_element(ranges.begin(), ranges.end(), [](float a, float b) {
    return (std::isfinite(a) ? a : 0.0F) < (std::isfinite(b) ? b : 0.0F);
  });
  const auto known = farthest_values_.find(word);
  if (known == farthest_values_.end()) return;
  const double step = std::abs(angle_step);
  // Twice as wide as a wall at that distance, met at a right angle, keeps one value to the
  // centimetre.
  const double widest_wall = 4.0 * std::sqrt(2.0 * 0.01 / std::max(1.0F, word));
  std::size_t runs = 0;
  std::size_t run_length = 0;
  double since_counted = 2.0 * kPi;
  bool nearer_between = true;
  bool wide = false;
  bool any_nearer = false;
  for (const float range : ranges) {
    since_counted += step;
    if (range == word) {
      if (run_length == 0 && nearer_between && since_counted > DegToRad(kDirectionsApart)) {
        ++runs;
        since_counted = 0.0;
        nearer_between = false;
      }
      ++run_length;
      wide = wide || static_cast<double>(run_length) * step > widest_wall;
    } else {
      run_length = 0;
      const bool nearer = range < kNearer * word;
      nearer_between = nearer_between || nearer;
      any_nearer = any_nearer || nearer;
    }
  }
  if (any_nearer && (wide || runs >= 3)) ++known->second.spread_scans;
}

std::optional<RangeLimitFinder::Finding> RangeLimitFinder::Find() const {
  std::uint64_t larger = 0;
  for (auto it = farthest_values_.rbegin(); it != farthest_values_.rend(); ++it) {
    const auto& [word, value] = *it;
    std::uint64_t just_below = 0;
    for (auto below = farthest_values_.lower_bound(kJustBelow * word);
         below->first < kCodesBelow * word; ++below) {
      just_below += below->second.count;
    }
    const bool from_places = value.places.size() >= kPlacesWanted;
    const bool spread = value.spread_scans >= std::min<std::uint64_t>(3, scans_);
    const auto count = static_cast<double>(value.count);
    if (value.count >= kLeastCount && (from_places || spread) &&
        count >= kDominance * static_cast<double>(just_below) &&
        static_cast<double>(larger) <= kOutliers * count) {
      return Finding{kCodesBelow * word, word, from_places};
    }
    larger += value.count;
  }
  return std::nullopt;
}

double RangeLimitFinder::ShareBeyond(double limit) const {
  const std::optional<Finding> finding = Find();
  const double end = finding ? finding->no_return : std::numeric_limits<float>::infinity();
  std::uint64_t beyond = 0;
  for (const auto& [value, known] : farthest_values_) {
    if (value > limit && value < end) beyond += known.count;
  }
  return ranges_ == 0 ? 0.0 : static_cast<double>(beyond) / static_cast<double>(ranges_);
}

}  // namespace masked_mapper
