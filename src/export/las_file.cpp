// SPDX-License-Identifier: BSD-3-Clause
#include "las_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "little_endian.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

constexpr std::uint16_t kHeaderSize = 375;
constexpr std::uint16_t kPointSize = 36;
constexpr double kScale = 0.001;           // m
constexpr double kGpsEpoch = 315964800.0;  // s, of 1970
constexpr double kLeapSeconds = 18.0;      // since 2017
constexpr double kAdjusted = 1e9;          // s, what LAS takes off GPS time

void AppendText(const std::string& text, std::size_t size, std::string* bytes) {
  std::string field = text;
  field.resize(size, '\0');
  *bytes += field;
}

std::string HeaderOf(const std::vector<SpacePoint>& points) {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  if (!points.empty()) low = high = points.front().position;
  for (const SpacePoint& point : points) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
  }
  constexpr std::uint16_t kGpsTimeAndWkt = 0x11;
  std::string header = "LASF";
  Append(std::uint16_t{0}, &header);  // file source
  Append(kGpsTimeAndWkt, &header);
  header.append(16, '\0');  // project
  header += '\1';
  header += '\4';
  AppendText("masked_mapper", 32, &header);
  AppendText("masked_mapper", 32, &header);
  header.append(4, '\0');  // day and year: the same map is the same bytes
  Append(kHeaderSize, &header);
  Append(std::uint32_t{kHeaderSize}, &header);  // where points begin
  Append(std::uint32_t{0}, &header);            // variable records
  header += '\7';
  Append(kPointSize, &header);
  header.append(4 + 5 * 4, '\0');  // counts of older versions
  for (int axis = 0; axis < 3; ++axis) Append(kScale, &header);
  for (int axis = 0; axis < 3; ++axis) Append(0.0, &header);
  for (int axis = 0; axis < 3; ++axis) {
    Append(std::round(high(axis) / kScale) * kScale, &header);
    Append(std::round(low(axis) / kScale) * kScale, &header);
  }
  header.append(8 + 8 + 4, '\0');  // waveforms, extended records
  Append(static_cast<std::uint64_t>(points.size()), &header);
  Append(static_cast<std::uint64_t>(points.size()), &header);  // first returns
  header.append(14 * 8, '\0');
  return header;
}

std::int32_t InMillimetres(double metres) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::clamp(std::round(metres / kScale), -kMost, kMost));
}

void AppendPoint(const SpacePoint& point, const Colour& colour, std::string* bytes) {
  for (int axis = 0; axis < 3; ++axis) Append(InMillimetres(point.position(axis)), bytes);
  Append(static_cast<std::uint16_t>(std::clamp(point.intensity * 256.0F, 0.0F, 65535.0F)), bytes);
  *bytes += '\x11';  // the only return of its pulse
  *bytes += '\0';
  *bytes += '\1';  // unclassified
  *bytes += '\0';
  Append(std::int16_t{0}, bytes);  // angle
  Append(static_cast<std::uint16_t>(point.label + 1), bytes);
  Append(point.stamp - kGpsEpoch + kLeapSeconds - kAdjusted, bytes);
  for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
    Append(static_cast<std::uint16_t>(part * 257), bytes);
  }
}

}  // namespace

void WriteLas(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
              const std::filesystem::path& path) {
  OutputFile file(path);
  file.Write(HeaderOf(points));
  std::string bytes;
  for (const SpacePoint& point : points) {
    AppendPoint(point, colours.at(point.label), &bytes);
    constexpr std::size_t kEnough = 1 << 20;
    if (bytes.size() < kEnough) continue;
    file.Write(bytes);
    bytes.clear();
  }
  file.Write(bytes);
  file.Close();
}

}  // namespace masked_mapper
