// SPDX-License-Identifier: BSD-3-Clause
#include "carry_watch.hpp"

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongGap = 20.0;  // s without a scan
constexpr double kFastest = 4.0;   // m/s; what the odometry does beyond it no wheels did
constexpr double kSlack = 1.0;     // m

}  // namespace

std::string CarryWatch::Observe(const LaserScan& scan) {
  std::string why;
  if (is_broken_) {
    why = "another log began";
  } else if (stamp_before_) {
    const double elapsed = scan.stamp - *stamp_before_;
    const bool has_jumped =
        scan.T_odom_robot && T_odom_before_ &&
        Distance(*T_odom_before_, *scan.T_odom_robot) > kSlack + kFastest * elapsed;
    if (elapsed > kLongGap) {
      why = "no scan for " + FixedText(elapsed, 1) + " s";
    } else if (has_jumped) {
      why = "the odometry jumped";
    }
  }
  is_broken_ = false;
  stamp_before_ = scan.stamp;
  T_odom_before_ = scan.T_odom_robot;
  return why;
}

}  // namespace masked_mapper
