// SPDX-License-Identifier: BSD-3-Clause
#include "ros_message_writing.hpp"

#include "ros_fields.hpp"

namespace masked_mapper {
namespace {

/// The bytes of what `write` puts into the output that it is given.
template <typename Write>
std::string Written(MessageEncoding encoding, const Write& write) {
  if (encoding == MessageEncoding::kCdr) {
    CdrOutput output;
    write(&output);
    return output.Take();
  }
  Ros1Output output;
  write(&output);
  return output.Take();
}

template <typename Output>
void PutVector(const Eigen::Vector3d& vector, Output* output) {
  for (int axis = 0; axis < 3; ++axis) output->Number(vector(axis));
}

template <typename Output>
void PutTransform(const Eigen::Isometry3d& transform, Output* output) {
  PutVector(transform.translation(), output);
  const Eigen::Quaterniond rotation(transform.linear());
  for (const double value : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) {
    output->Number(value);
  }
}

/// Of what is not measured, the first element is -1 (sensor_msgs/Imu).
template <typename Output>
void PutCovariance(double first, int elements, Output* output) {
  output->Number(first);
  for (int i = 1; i < elements; ++i) output->Number(0.0);
}

}  // namespace

std::string WriteLaserScan(const RosLaserScan& scan, MessageEncoding encoding) {
  return Written(encoding, [&scan](auto* output) {
    output->Header(scan.header);
    const double steps = static_cast<double>(scan.ranges.empty() ? 0 : scan.ranges.size() - 1);
    for (const double value : {scan.angle_min, scan.angle_min + steps * scan.angle_increment,
                               scan.angle_increment, 0.0, 0.0, scan.range_min, scan.range_max}) {
      output->Number(static_cast<float>(value));
    }
    output->Number(static_cast<std::uint32_t>(scan.ranges.size()));
    for (const float range : scan.ranges) output->Number(range);
    output->Number(std::uint32_t{0});  // intensities
  });
}

std::string WriteOdometry(const RosOdometry& odometry, MessageEncoding encoding) {
  return Written(encoding, [&odometry](auto* output) {
    constexpr int kCovariance = 36;
    output->Header(odometry.header);
    output->String(odometry.child_frame_id);
    PutTransform(odometry.T_frame_child, output);
    PutCovariance(0.0, kCovariance, output);
    PutVector(Eigen::Vector3d::Zero(), output);  // twist
    PutVector(Eigen::Vector3d::Zero(), output);
    PutCovariance(0.0, kCovariance, output);
  });
}

std::string WriteTransforms(const std::vector<RosTransform>& transforms, MessageEncoding encoding) {
  return Written(encoding, [&transforms](auto* output) {
    output->Number(static_cast<std::uint32_t>(transforms.size()));
    for (const RosTransform& transform : transforms) {
      output->Header(transform.header);
      output->String(transform.child_frame_id);
      PutTransform(transform.T_frame_child, output);
    }
  });
}

std::string WriteImu(const RosImu& imu, MessageEncoding encoding) {
  return Written(encoding, [&imu](auto* output) {
    constexpr int kCovariance = 9;
    output->Header(imu.header);
    for (const double value : {0.0, 0.0, 0.0, 1.0}) output->Number(value);  // orientation
    PutCovariance(-1.0, kCovariance, output);
    PutVector(Eigen::Vector3d::Zero(), output);  // angular velocity
    PutCovariance(-1.0, kCovariance, output);
    PutVector(imu.acceleration, output);
    PutCovariance(0.0, kCovariance, output);
  });
}

std::string WriteFluidPressure(const RosFluidPressure& pressure, MessageEncoding encoding) {
  return Written(encoding, [&pressure](auto* output) {
    output->Header(pressure.header);
    output->Number(pressure.pressure_pa);
    output->Number(0.0);  // variance
  });
}

}  // namespace masked_mapper
