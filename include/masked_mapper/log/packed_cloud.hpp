// SPDX-License-Identifier: BSD-3-Clause
// A levelled cloud as a map keeps it: of each voxel one point, packed into two bytes or three. It
// is what exports need of a place once the log is gone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

/// What a log keeps of a cloud.
struct StampedCloud {
  double log_stamp = 0.0;                     ///< s, as LevelledCloud has it
  std::shared_ptr<const std::string> packed;  ///< as below; never null
};

/// m, a side, about the robot.
constexpr double kPackedVoxel_m = 0.05;

/// Of each voxel the mean of its points, to an eighth of its side, and of their intensities, to
/// 1/255 of the cloud's greatest. Points 100 m away and farther are left out, and so are times and
/// the stamp, which the map has.
std::string PackCloud(const LevelledCloud& cloud);

/// Voxels from the lowest to the highest. Empty when the bytes are no such cloud: every length is
/// held against the bytes that are there.
std::optional<LevelledCloud> UnpackCloud(std::string_view bytes);

}  // namespace masked_mapper
