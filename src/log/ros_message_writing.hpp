// SPDX-License-Identifier: BSD-3-Clause
// The inverse of ros_messages.hpp: what it reads, as bytes. Fields that it has no place for are
// written as 0, and covariances as unknown.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/log/log_writer.hpp"
#include "ros_messages.hpp"
#include "ros_point_cloud.hpp"

namespace masked_mapper {

/// Stamps are written to a microsecond.
std::string WriteLaserScan(const RosLaserScan& scan, MessageEncoding encoding);
/// Times as the layout tells them, coordinates as it lays them out.
std::string WritePointCloud(const RosPointCloud& cloud, CloudLayout layout,
                            MessageEncoding encoding);
std::string WriteOdometry(const RosOdometry& odometry, MessageEncoding encoding);
std::string WriteTransforms(const std::vector<RosTransform>& transforms, MessageEncoding encoding);
std::string WriteImu(const RosImu& imu, MessageEncoding encoding);
std::string WriteFluidPressure(const RosFluidPressure& pressure, MessageEncoding encoding);

}  // namespace masked_mapper
