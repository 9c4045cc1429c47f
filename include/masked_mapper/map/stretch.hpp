// SPDX-License-Identifier: BSD-3-Clause
// What was seen along the way before and after a node: more of a place than one scan, and from all
// sides, so that a drive the other way finds it too.
#pragma once

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Points of the scans kept within `half_length_m` of travel before and after the node, about every
/// half metre, as far as the way stays in its drive and on its floor; in the node's frame, by the
/// optimised poses. Points farther than `max_range_m` from their scan's robot are left out.
ScanPoints::Ptr StretchAround(const MappingResult& map, NodeId node, double half_length_m,
                              double max_range_m);

/// Appends the points of a scan within `max_range_m` of the robot.
void AppendPoints(const LaserScan& scan, const Pose2& T_frame_robot, double max_range_m,
                  ScanPoints& points_in_frame);

}  // namespace masked_mapper
