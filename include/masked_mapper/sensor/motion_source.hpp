// SPDX-License-Identifier: BSD-3-Clause
// Which sensors tell how the robot moved.
#pragma once

#include <array>

namespace masked_mapper {

enum class MotionSource {
  kAuto,  ///< fused where scans come often enough, else the wheels; scans where there are no wheels
  kOdometry,  ///< wheels alone, as in the paper
  kScans,     ///< scans alone: wheels are not looked at
  kFused,     ///< wheels guess, scans correct
};
constexpr std::array<const char*, 4> NamesOf(MotionSource /*any*/) {
  return {"auto", "odometry", "scans", "fused"};
}

}  // namespace masked_mapper
