// SPDX-License-Identifier: BSD-3-Clause
#include "ros_message_writing.hpp"

#include <algorithm>
#include <cstring>

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

struct WrittenField {
  const char* name;
  std::uint32_t offset;
  std::uint8_t type;  ///< sensor_msgs/PointField
};

/// x, y, z and intensity, then the time.
struct WrittenLayout {
  std::vector<WrittenField> fields;
  std::uint32_t step = 0;
};

WrittenLayout FieldsOf(CloudLayout layout) {
  constexpr std::uint8_t kUint32 = 6;
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::uint8_t kFloat64 = 8;
  WrittenLayout written;
  written.fields = {{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}};
  const auto add = [&written](WrittenField intensity, WrittenField time, std::uint32_t step) {
    written.fields.push_back(intensity);
    written.fields.push_back(time);
    written.step = step;
  };
  switch (layout) {
    case CloudLayout::kVelodyne:
      add({"intensity", 12, kFloat32}, {"time", 16, kFloat32}, 20);
      break;
    case CloudLayout::kOuster:
      add({"intensity", 16, kFloat32}, {"t", 20, kUint32}, 24);
      break;
    case CloudLayout::kLivox:
      add({"intensity", 12, kFloat32}, {"timestamp", 16, kFloat64}, 24);
      break;
  }
  return written;
}

/// ns after `stamp`, in the numbers of the layout.
std::string TimeBytes(CloudLayout layout, double stamp, float seconds_after) {
  std::string bytes;
  const double nanoseconds = 1e9 * static_cast<double>(seconds_after);
  if (layout == CloudLayout::kVelodyne) AppendNumber(seconds_after, &bytes);
  if (layout == CloudLayout::kOuster) {
    AppendNumber(static_cast<std::uint32_t>(std::max(0.0, nanoseconds)), &bytes);
  }
  if (layout == CloudLayout::kLivox) AppendNumber(1e9 * stamp + nanoseconds, &bytes);
  return bytes;
}

std::string PointBytes(const RosPointCloud& cloud, CloudLayout layout,
                       const WrittenLayout& written) {
  std::string data(cloud.points.size() * written.step, '\0');
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const CloudPoint& point = cloud.points[i];
    char* const begin = data.data() + i * written.step;
    std::memcpy(begin, point.position.data(), 3 * sizeof(float));
    std::memcpy(begin + written.fields[3].offset, &point.intensity, sizeof(float));
    const std::string time = TimeBytes(layout, cloud.header.stamp, point.time);
    std::copy(time.begin(), time.end(), begin + written.fields[4].offset);
  }
  return data;
}

}  // namespace

std::string WritePointCloud(const RosPointCloud& cloud, CloudLayout layout,
                            MessageEncoding encoding) {
  const WrittenLayout written = FieldsOf(layout);
  const std::string data = PointBytes(cloud, layout, written);
  return Written(encoding, [&](auto* output) {
    output->Header(cloud.header);
    output->Number(std::uint32_t{1});
    output->Number(static_cast<std::uint32_t>(cloud.points.size()));
    output->Number(static_cast<std::uint32_t>(written.fields.size()));
    for (const WrittenField& field : written.fields) {
      output->String(field.name);
      output->Number(field.offset);
      output->Number(field.type);
      output->Number(std::uint32_t{1});
    }
    output->Number(std::uint8_t{0});  // little-endian
    output->Number(written.step);
    output->Number(static_cast<std::uint32_t>(data.size()));  // of the only row
    output->Number(static_cast<std::uint32_t>(data.size()));
    output->Bytes(data);
    output->Number(std::uint8_t{1});  // dense
  });
}

std::string WriteLaserScan(const RosLaserScan& scan, MessageEncoding encoding) {
  return Written(encoding, [&scan](auto* output) {
    output->Header(scan.header);
    const double steps = static_cast<double>(scan.ranges.empty() ? 0 : scan.ranges.size() - 1);
    for (const double value :
         {scan.angle_min, scan.angle_min + steps * scan.angle_increment, scan.angle_increment,
          scan.time_increment, 0.0, scan.range_min, scan.range_max}) {
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
