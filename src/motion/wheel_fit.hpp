// SPDX-License-Identifier: BSD-3-Clause
// The clock, the scale and the turn factor by which wheels agree best with scans.
#pragma once

#include <vector>

#include "masked_mapper/motion/wheel_check.hpp"

namespace masked_mapper {

/// Least squares with bounded squares over the turns of all stretches, for every clock in question;
/// the way is held against that with the best. `wheel_poses` in order of stamps.
WheelReport Compare(const std::vector<WheelCheck::Stretch>& stretches,
                    const std::vector<WheelCheck::WheelPose>& wheel_poses);

}  // namespace masked_mapper
