// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 and ROS 2 bags as robot logs: LaserScan and MultiEchoLaserScan of any field of view
// (several scanners as one, see scan_merger.hpp), Odometry or tf, Imu, FluidPressure.
//
// A topic is found by its type when there is one of it, and named by an option when there are
// several. Where scanners sit comes from tf: from the frame that odometry moves (its child frame,
// the frame below `odom`, `base_link` or `base_footprint`) to the scan's frame. Stamps are those of
// the messages' headers; a topic whose clock is seconds away from the scans' is stamped by its time
// of recording.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "log_plan.hpp"

namespace masked_mapper {

/// Looks at the beginning of a bag, or of several that are one recording. Throws InputError: not a
/// bag that is read, no scan in it, several topics to choose from, a topic that is not there.
std::unique_ptr<LogPlan> PlanRosBag(const std::vector<std::string>& paths,
                                    const LogOptions& options);

}  // namespace masked_mapper
