// SPDX-License-Identifier: BSD-3-Clause
// sensor_msgs/PointCloud2 of any layout, byte for byte, for tests to read and spoil.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "log/bag_bytes.hpp"

namespace masked_mapper {

constexpr const char* kPointCloud2Md5 = "1158d486dd51d683ce2f1be655c3c181";

struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t type = 7;  ///< sensor_msgs/PointField: 1 int8 ... 6 uint32, 7 float32, 8 float64
  std::uint32_t count = 1;
};

/// As a message says it, true or not.
struct CloudBytes {
  double stamp = 100.0;
  std::string frame = "lidar";
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<CloudField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::string data;

  std::string Ros1() const {
    const auto seconds = static_cast<std::uint32_t>(stamp);
    const auto rest = static_cast<std::uint32_t>((stamp - seconds) * 1e9);
    std::string bytes = Raw(std::uint32_t{0}) + Raw(seconds) + Raw(rest) + WithLength(frame) +
                        Raw(height) + Raw(width) + Raw(static_cast<std::uint32_t>(fields.size()));
    for (const CloudField& field : fields) {
      bytes += WithLength(field.name) + Raw(field.offset) + Raw(field.type) + Raw(field.count);
    }
    return bytes + Raw(static_cast<std::uint8_t>(is_bigendian)) + Raw(point_step) + Raw(row_step) +
           WithLength(data) + Raw(std::uint8_t{1});
  }
};

/// The number in the bytes of a field type.
inline std::string AsField(std::uint8_t type, double value) {
  switch (type) {
    case 1:
      return Raw(static_cast<std::int8_t>(value));
    case 2:
      return Raw(static_cast<std::uint8_t>(value));
    case 3:
      return Raw(static_cast<std::int16_t>(value));
    case 4:
      return Raw(static_cast<std::uint16_t>(value));
    case 5:
      return Raw(static_cast<std::int32_t>(value));
    case 6:
      return Raw(static_cast<std::uint32_t>(value));
    case 7:
      return Raw(static_cast<float>(value));
    default:
      return Raw(value);
  }
}

/// A cloud of points whose values stand in the order of the fields.
inline CloudBytes CloudOf(const std::vector<CloudField>& fields, std::uint32_t point_step,
                          const std::vector<std::vector<double>>& points) {
  CloudBytes cloud;
  cloud.fields = fields;
  cloud.point_step = point_step;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.row_step = cloud.width * point_step;
  cloud.data.assign(points.size() * point_step, '\0');
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < fields.size(); ++j) {
      const std::string bytes = AsField(fields[j].type, points[i][j]);
      std::memcpy(cloud.data.data() + i * point_step + fields[j].offset, bytes.data(),
                  bytes.size());
    }
  }
  return cloud;
}

}  // namespace masked_mapper
