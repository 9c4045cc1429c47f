// SPDX-License-Identifier: BSD-3-Clause
#include "ros_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "angle_as_meant.hpp"
#include "ros_fields.hpp"

namespace masked_mapper {
namespace {

constexpr double kLargestCoordinate = 1e8;  // m
constexpr std::size_t kMostBeams = 100000;

/// What `parse` makes of the fields in a message.
template <typename Parse>
auto InFields(const unsigned char* data, std::size_t size, MessageEncoding encoding,
              const Parse& parse) {
  if (encoding == MessageEncoding::kCdr) {
    CdrFields fields(data, size);
    return parse(&fields);
  }
  Ros1Fields fields(data, size);
  return parse(&fields);
}

template <typename Fields>
Eigen::Vector3d Vector(Fields* fields) {
  const auto x = fields->template Number<double>();
  const auto y = fields->template Number<double>();
  const auto z = fields->template Number<double>();
  return {x, y, z};
}

/// Position and quaternion; false when they are no transform.
template <typename Fields>
bool Transform(Fields* fields, Eigen::Isometry3d* transform) {
  const Eigen::Vector3d translation = Vector(fields);
  const auto x = fields->template Number<double>();
  const auto y = fields->template Number<double>();
  const auto z = fields->template Number<double>();
  const auto w = fields->template Number<double>();
  const Eigen::Quaterniond rotation(w, x, y, z);
  const double norm = rotation.norm();
  if (!fields->good() || !(translation.cwiseAbs().maxCoeff() <= kLargestCoordinate) ||
      !(std::abs(norm - 1.0) < 0.1)) {
    return false;
  }
  *transform = Eigen::Isometry3d(rotation.normalized());
  transform->translation() = translation;
  return true;
}

/// The fields between the header and the ranges.
template <typename Fields>
RosLaserScan ScanBeforeRanges(Fields* fields) {
  RosLaserScan scan;
  scan.header = fields->Header();
  scan.angle_min = AngleAsMeant(fields->template Number<float>());
  fields->template Number<float>();  // angle_max: the count and the increment say it
  scan.angle_increment = AngleAsMeant(fields->template Number<float>());
  scan.time_increment = fields->template Number<float>();
  fields->template Skip<float>(1);  // scan_time
  scan.range_min = fields->template Number<float>();
  scan.range_max = fields->template Number<float>();
  return scan;
}

bool IsUsable(const RosLaserScan& scan) {
  constexpr double kTwoTurns = 12.6;
  return !scan.ranges.empty() && scan.ranges.size() <= kMostBeams &&
         std::abs(scan.angle_min) <= kTwoTurns && std::abs(scan.angle_increment) > 0.0 &&
         std::abs(scan.angle_increment) * static_cast<double>(scan.ranges.size()) <= kTwoTurns;
}

/// Echoes of all beams: an array of arrays.
template <typename Fields>
std::vector<std::vector<float>> Echoes(Fields* fields) {
  const std::size_t beams = fields->Count(sizeof(std::uint32_t));
  std::vector<std::vector<float>> echoes;
  if (beams > kMostBeams) return echoes;
  echoes.reserve(beams);
  for (std::size_t i = 0; i < beams && fields->good(); ++i) echoes.push_back(fields->Floats());
  return echoes;
}

/// The range that stands for a beam; NaN without an echo.
float ChosenEcho(const std::vector<float>& ranges, const std::vector<float>& intensities,
                 EchoChoice choice) {
  if (ranges.empty()) return std::numeric_limits<float>::quiet_NaN();
  if (choice == EchoChoice::kFirst || intensities.size() != ranges.size()) return ranges.front();
  const auto strongest = std::max_element(intensities.begin(), intensities.end());
  return ranges[static_cast<std::size_t>(strongest - intensities.begin())];
}

template <typename Fields>
std::optional<RosHeader> ReadHeader(Fields* fields) {
  RosHeader header = fields->Header();
  if (!fields->good()) return std::nullopt;
  return header;
}

template <typename Fields>
std::optional<RosLaserScan> ReadLaserScan(Fields* fields) {
  RosLaserScan scan = ScanBeforeRanges(fields);
  scan.ranges = fields->Floats();
  fields->Floats();  // intensities
  if (!fields->good() || !IsUsable(scan)) return std::nullopt;
  return scan;
}

template <typename Fields>
std::optional<RosLaserScan> ReadMultiEchoLaserScan(Fields* fields, EchoChoice choice) {
  RosLaserScan scan = ScanBeforeRanges(fields);
  const std::vector<std::vector<float>> ranges = Echoes(fields);
  const std::vector<std::vector<float>> intensities = Echoes(fields);
  for (std::size_t beam = 0; beam < ranges.size(); ++beam) {
    scan.ranges.push_back(
        ChosenEcho(ranges[beam],
                   beam < intensities.size() ? intensities[beam] : std::vector<float>{}, choice));
  }
  if (!fields->good() || !IsUsable(scan)) return std::nullopt;
  return scan;
}

template <typename Fields>
std::optional<RosOdometry> ReadOdometry(Fields* fields) {
  RosOdometry odometry;
  odometry.header = fields->Header();
  odometry.child_frame_id = FrameId(fields->String());
  if (!Transform(fields, &odometry.T_frame_child)) return std::nullopt;
  return odometry;
}

template <typename Fields>
std::optional<std::vector<RosTransform>> ReadTransforms(Fields* fields) {
  constexpr std::size_t kLeastTransform = 8 + 4 + 4 + 56;  // empty names
  const std::size_t count = fields->Count(kLeastTransform);
  std::vector<RosTransform> transforms;
  transforms.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    RosTransform transform;
    transform.header = fields->Header();
    transform.child_frame_id = FrameId(fields->String());
    if (!Transform(fields, &transform.T_frame_child)) return std::nullopt;
    transforms.push_back(std::move(transform));
  }
  if (!fields->good()) return std::nullopt;
  return transforms;
}

template <typename Fields>
std::optional<RosImu> ReadImu(Fields* fields) {
  RosImu imu;
  imu.header = fields->Header();
  constexpr std::size_t kCovariance = 9;
  fields->template Skip<double>(4 + kCovariance);  // orientation
  fields->template Skip<double>(3 + kCovariance);  // angular velocity
  imu.acceleration = Vector(fields);
  if (!fields->good() || !(imu.acceleration.cwiseAbs().maxCoeff() <= 1e6)) return std::nullopt;
  return imu;
}

template <typename Fields>
std::optional<RosFluidPressure> ReadFluidPressure(Fields* fields) {
  RosFluidPressure pressure;
  pressure.header = fields->Header();
  pressure.pressure_pa = fields->template Number<double>();
  if (!fields->good() || !(std::abs(pressure.pressure_pa) <= 1e9)) return std::nullopt;
  return pressure;
}

}  // namespace

std::optional<RosHeader> ParseHeader(const unsigned char* data, std::size_t size,
                                     MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadHeader(fields); });
}

std::optional<RosLaserScan> ParseLaserScan(const unsigned char* data, std::size_t size,
                                           MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadLaserScan(fields); });
}

std::optional<RosLaserScan> ParseMultiEchoLaserScan(const unsigned char* data, std::size_t size,
                                                    EchoChoice choice, MessageEncoding encoding) {
  return InFields(data, size, encoding,
                  [choice](auto* fields) { return ReadMultiEchoLaserScan(fields, choice); });
}

std::optional<RosOdometry> ParseOdometry(const unsigned char* data, std::size_t size,
                                         MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadOdometry(fields); });
}

std::optional<std::vector<RosTransform>> ParseTransforms(const unsigned char* data,
                                                         std::size_t size,
                                                         MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadTransforms(fields); });
}

std::optional<RosImu> ParseImu(const unsigned char* data, std::size_t size,
                               MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadImu(fields); });
}

std::optional<RosFluidPressure> ParseFluidPressure(const unsigned char* data, std::size_t size,
                                                   MessageEncoding encoding) {
  return InFields(data, size, encoding, [](auto* fields) { return ReadFluidPressure(fields); });
}

}  // namespace masked_mapper
