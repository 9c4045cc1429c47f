// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// A scan at its final place, as rendering wants it.
struct PosedScan {
  Pose2 T_world_robot;
  std::int32_t floor = 0;
  const LaserScan* scan = nullptr;  ///< outlives the rendering
  std::size_t drive = 0;            ///< later ones are newer
};

}  // namespace masked_mapper
