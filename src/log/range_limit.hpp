// SPDX-License-Identifier: BSD-3-Clause
// What a log means by "no return". Every scanner and logger has its own word for it (50, 51.1, 80,
// 81.83 to 81.91 m ...), found here from the ranges themselves. How is our choice: the word is one
// exact value that nothing exceeds, far more frequent than all values just below it, and seen where
// no wall could be: from places well apart, or in directions well apart with nearer things between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

class RangeLimitFinder {
 public:
  /// Ranges as the log has them, m; their step in rad.
  void Add(const std::vector<float>& ranges, double angle_step, const Pose2& T_odom_robot);

  struct Finding {
    float no_return = 0.0F;    ///< m, the least value that means no return
    float far_value = 0.0F;    ///< m, the log's word for it
    bool from_places = false;  ///< seen from several places: cannot be a wall
  };
  /// Empty when no value behaves like a word for "no return".
  std::optional<Finding> Find() const;

  /// m, the farthest range seen that may be one (below kAbsurdRange).
  float Farthest() const { return farthest_; }
  /// Share of ranges beyond `limit`, the word for "no return" (if there is one) not counted.
  double ShareBeyond(double limit) const;

  /// m; a finite range beyond this is a word or a mistake, never a measurement.
  static constexpr float kAbsurdRange = 1000.0F;

 private:
  /// What is known of one exact value.
  struct Value {
    std::uint64_t count = 0;
    std::uint64_t spread_scans = 0;  ///< scans that saw it in directions that no wall explains
    std::vector<Pose2> places;       ///< T_odom_robot, a metre apart, a few
  };
  void AddSpread(const std::vector<float>& ranges, double angle_step);

  std::map<float, Value> farthest_values_;  ///< a bounded number of the largest
  std::uint64_t ranges_ = 0;
  std::uint64_t scans_ = 0;
  float farthest_ = 0.0F;
};

}  // namespace masked_mapper
