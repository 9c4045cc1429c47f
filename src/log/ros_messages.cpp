// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/ros_messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "masked_mapper/geometry/angle.hpp"

namespace masked_mapper {
namespace {

constexpr double kLargestCoordinate = 1e8;  // m
constexpr std::size_t kMostBeams = 100000;
constexpr std::size_t kLongestFrame = 256;

/// Reads fields one after the other; once one does not fit, nothing does, and good() is false.
class FieldReader {
 public:
  FieldReader(const unsigned char* data, std::size_t size) : data_(data), left_(size) {}

  bool good() const { return good_; }
  std::size_t left() const { return left_; }

  template <typename T>
  T Number() {
    T value{};
    const unsigned char* bytes = Take(sizeof(T));
    // ROS is little-endian, and so is every machine that this is built for.
    if (bytes != nullptr) std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  void Skip(std::size_t bytes) { Take(bytes); }

  /// The number of elements of at least `element_size` bytes each that follow.
  std::size_t Count(std::size_t element_size) {
    const auto count = Number<std::uint32_t>();
    if (count > left_ / element_size) good_ = false;
    return good_ ? count : 0;
  }

  std::string String() {
    const std::size_t size = Count(1);
    const unsigned char* bytes = Take(size);
    if (bytes == nullptr || size > kLongestFrame) return {};
    return {reinterpret_cast<const char*>(bytes), size};
  }

  std::vector<float> Floats() {
    const std::size_t count = Count(sizeof(float));
    const unsigned char* bytes = Take(count * sizeof(float));
    std::vector<float> values(bytes == nullptr ? 0 : count);
    if (!values.empty()) std::memcpy(values.data(), bytes, count * sizeof(float));
    return values;
  }

 private:
  const unsigned char* Take(std::size_t count) {
    if (!good_ || count > left_) {
      good_ = false;
      return nullptr;
    }
    const unsigned char* bytes = data_;
    data_ += count;
    left_ -= count;
    return bytes;
  }

  const unsigned char* data_;
  std::size_t left_;
  bool good_ = true;
};

std::string FrameId(std::string frame) {
  return frame.empty() || frame.front() != '/' ? frame : frame.substr(1);
}

RosHeader Header(FieldReader* fields) {
  RosHeader header;
  fields->Number<std::uint32_t>();  // seq
  const auto seconds = fields->Number<std::uint32_t>();
  const auto nanoseconds = fields->Number<std::uint32_t>();
  header.stamp = static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
  header.frame_id = FrameId(fields->String());
  return header;
}

Eigen::Vector3d Vector(FieldReader* fields) {
  const auto x = fields->Number<double>();
  const auto y = fields->Number<double>();
  const auto z = fields->Number<double>();
  return {x, y, z};
}

/// Position and quaternion; false when they are no transform.
bool Transform(FieldReader* fields, Eigen::Isometry3d* transform) {
  const Eigen::Vector3d translation = Vector(fields);
  const auto x = fields->Number<double>();
  const auto y = fields->Number<double>();
  const auto z = fields->Number<double>();
  const auto w = fields->Number<double>();
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

/// Scanners are built in degrees, and a message holds single precision. Where a short number of
/// degrees has the same bits, it was meant: a bag and a text log then give the same beams.
double AngleAsMeant(float angle) {
  constexpr double kStepsPerDegree = 1e4;
  const double meant = DegToRad(std::round(RadToDeg(angle) * kStepsPerDegree) / kStepsPerDegree);
  return static_cast<float>(meant) == angle ? meant : static_cast<double>(angle);
}

/// The fields between the header and the ranges.
RosLaserScan ScanBeforeRanges(FieldReader* fields) {
  RosLaserScan scan;
  scan.header = Header(fields);
  scan.angle_min = AngleAsMeant(fields->Number<float>());
  fields->Number<float>();  // angle_max: the count and the increment say it
  scan.angle_increment = AngleAsMeant(fields->Number<float>());
  fields->Skip(2 * sizeof(float));  // time_increment, scan_time
  scan.range_min = fields->Number<float>();
  scan.range_max = fields->Number<float>();
  return scan;
}

bool IsUsable(const RosLaserScan& scan) {
  constexpr double kTwoTurns = 12.6;
  return !scan.ranges.empty() && scan.ranges.size() <= kMostBeams &&
         std::abs(scan.angle_min) <= kTwoTurns && std::abs(scan.angle_increment) > 0.0 &&
         std::abs(scan.angle_increment) * static_cast<double>(scan.ranges.size()) <= kTwoTurns;
}

/// Echoes of all beams: an array of arrays.
std::vector<std::vector<float>> Echoes(FieldReader* fields) {
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

}  // namespace

std::optional<RosHeader> ParseHeader(const unsigned char* data, std::size_t size) {
  FieldReader fields(data, size);
  RosHeader header = Header(&fields);
  if (!fields.good()) return std::nullopt;
  return header;
}

std::optional<RosLaserScan> ParseLaserScan(const unsigned char* data, std::size_t size) {
  FieldReader fields(data, size);
  RosLaserScan scan = ScanBeforeRanges(&fields);
  scan.ranges = fields.Floats();
  fields.Floats();  // intensities
  if (!fields.good() || !IsUsable(scan)) return std::nullopt;
  return scan;
}

std::optional<RosLaserScan> ParseMultiEchoLaserScan(const unsigned char* data, std::size_t size,
                                                    EchoChoice choice) {
  FieldReader fields(data, size);
  RosLaserScan scan = ScanBeforeRanges(&fields);
  const std::vector<std::vector<float>> ranges = Echoes(&fields);
  const std::vector<std::vector<float>> intensities = Echoes(&fields);
  for (std::size_t beam = 0; beam < ranges.size(); ++beam) {
    scan.ranges.push_back(
        ChosenEcho(ranges[beam],
                   beam < intensities.size() ? intensities[beam] : std::vector<float>{}, choice));
  }
  if (!fields.good() || !IsUsable(scan)) return std::nullopt;
  return scan;
}

std::optional<RosOdometry> ParseOdometry(const unsigned char* data, std::size_t size) {
  FieldReader fields(data, size);
  RosOdometry odometry;
  odometry.header = Header(&fields);
  odometry.child_frame_id = FrameId(fields.String());
  if (!Transform(&fields, &odometry.T_frame_child)) return std::nullopt;
  return odometry;
}

std::optional<std::vector<RosTransform>> ParseTransforms(const unsigned char* data,
                                                         std::size_t size) {
  FieldReader fields(data, size);
  constexpr std::size_t kLeastTransform = 12 + 4 + 4 + 56;  // empty names
  const std::size_t count = fields.Count(kLeastTransform);
  std::vector<RosTransform> transforms;
  transforms.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    RosTransform transform;
    transform.header = Header(&fields);
    transform.child_frame_id = FrameId(fields.String());
    if (!Transform(&fields, &transform.T_frame_child)) return std::nullopt;
    transforms.push_back(std::move(transform));
  }
  if (!fields.good()) return std::nullopt;
  return transforms;
}

std::optional<RosImu> ParseImu(const unsigned char* data, std::size_t size) {
  FieldReader fields(data, size);
  RosImu imu;
  imu.header = Header(&fields);
  constexpr std::size_t kCovariance = 9 * sizeof(double);
  fields.Skip(4 * sizeof(double) + kCovariance);  // orientation
  fields.Skip(3 * sizeof(double) + kCovariance);  // angular velocity
  imu.acceleration = Vector(&fields);
  if (!fields.good() || !(imu.acceleration.cwiseAbs().maxCoeff() <= 1e6)) return std::nullopt;
  return imu;
}

std::optional<RosFluidPressure> ParseFluidPressure(const unsigned char* data, std::size_t size) {
  FieldReader fields(data, size);
  RosFluidPressure pressure;
  pressure.header = Header(&fields);
  pressure.pressure_pa = fields.Number<double>();
  if (!fields.good() || !(std::abs(pressure.pressure_pa) <= 1e9)) return std::nullopt;
  return pressure;
}

}  // namespace masked_mapper
