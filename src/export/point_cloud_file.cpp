// SPDX-License-Identifier: BSD-3-Clause
#include "point_cloud_file.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string>

#include "little_endian.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

// From dark to light, each clear before black and before white.
constexpr std::array<Colour, 4> kRamp = {Colour{52, 74, 160}, Colour{32, 138, 160},
                                         Colour{104, 184, 106}, Colour{244, 218, 84}};

Colour OnRamp(double fraction) {
  const double place = fraction * static_cast<double>(kRamp.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const double share = place - static_cast<double>(below);
  const auto mix = [share](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround((1.0 - share) * a + share * b));
  };
  const Colour& a = kRamp[below];
  const Colour& b = kRamp[below + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

std::string PcdHeader(std::size_t points, bool has_intensity) {
  const std::string count = std::to_string(points);
  const auto with = [has_intensity](const char* fields, const char* intensity) {
    return std::string(fields) + (has_intensity ? intensity : "") + "\n";
  };
  return "# .PCD v0.7 - Point Cloud Data file format\n"
         "VERSION 0.7\n" +
         with("FIELDS x y z rgba label", " intensity") + with("SIZE 4 4 4 4 4", " 4") +
         with("TYPE F F F U U", " F") + with("COUNT 1 1 1 1 1", " 1") + "WIDTH " + count +
         "\n"
         "HEIGHT 1\n"
         "VIEWPOINT 0 0 0 1 0 0 0\n"
         "POINTS " +
         count +
         "\n"
         "DATA binary\n";
}

std::string PlyHeader(std::size_t points, bool has_intensity) {
  return "ply\n"
         "format binary_little_endian 1.0\n"
         "element vertex " +
         std::to_string(points) +
         "\n"
         "property float x\n"
         "property float y\n"
         "property float z\n"
         "property uchar red\n"
         "property uchar green\n"
         "property uchar blue\n"
         "property uint label\n" +
         (has_intensity ? "property float intensity\n" : "") + "end_header\n";
}

// Of a point first its place, then what the format has for a colour, then its label.
template <typename AppendColour>
void WriteCloud(const std::string& header, const ColouredCloud& cloud,
                const AppendColour& append_colour, const std::filesystem::path& path) {
  std::string bytes = header;
  bytes.reserve(header.size() + cloud.size() * 20);
  for (const pcl::PointXYZRGBL& point : cloud) {
    Append(point.x, &bytes);
    Append(point.y, &bytes);
    Append(point.z, &bytes);
    append_colour(point, &bytes);
    Append(point.label, &bytes);
  }
  WriteFile(path, bytes);
}

// The same of points in space, with their intensity last.
template <typename AppendColour>
void WriteSpace(const std::string& header, const std::vector<SpacePoint>& points,
                const std::vector<Colour>& colours, const AppendColour& append_colour,
                const std::filesystem::path& path) {
  std::string bytes = header;
  bytes.reserve(header.size() + points.size() * 24);
  for (const SpacePoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      Append(static_cast<float>(point.position(axis)), &bytes);
    }
    append_colour(colours.at(point.label), &bytes);
    Append(point.label, &bytes);
    Append(point.intensity, &bytes);
  }
  WriteFile(path, bytes);
}

}  // namespace

std::vector<Colour> FloorColours(const std::vector<Floor>& floors) {
  std::vector<std::size_t> upwards(floors.size());
  std::iota(upwards.begin(), upwards.end(), std::size_t{0});
  std::stable_sort(upwards.begin(), upwards.end(), [&floors](std::size_t a, std::size_t b) {
    return floors[a].elevation < floors[b].elevation;
  });
  std::vector<Colour> colours(floors.size());
  const double steps = std::max<double>(1.0, static_cast<double>(floors.size()) - 1.0);
  for (std::size_t place = 0; place < upwards.size(); ++place) {
    colours[upwards[place]] = OnRamp(static_cast<double>(place) / steps);
  }
  return colours;
}

ColouredCloud Coloured(const pcl::PointCloud<pcl::PointXYZL>& cloud,
                       const std::vector<Colour>& colours) {
  ColouredCloud coloured;
  coloured.reserve(cloud.size());
  for (const pcl::PointXYZL& point : cloud) {
    assert(point.label < colours.size());
    const Colour& colour = colours[point.label];
    coloured.push_back(
        {point.x, point.y, point.z, colour.red, colour.green, colour.blue, point.label});
  }
  return coloured;
}

void WritePcd(const ColouredCloud& cloud, const std::filesystem::path& path) {
  WriteCloud(
      PcdHeader(cloud.size(), false), cloud,
      [](const pcl::PointXYZRGBL& point, std::string* bytes) { Append(point.rgba, bytes); }, path);
}

void WritePly(const ColouredCloud& cloud, const std::filesystem::path& path) {
  WriteCloud(
      PlyHeader(cloud.size(), false), cloud,
      [](const pcl::PointXYZRGBL& point, std::string* bytes) {
        Append(point.r, bytes);
        Append(point.g, bytes);
        Append(point.b, bytes);
      },
      path);
}

void WriteSpacePcd(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
                   const std::filesystem::path& path) {
  WriteSpace(
      PcdHeader(points.size(), true), points, colours,
      [](const Colour& colour, std::string* bytes) {
        Append(std::uint32_t{0xFF000000U} | static_cast<std::uint32_t>(colour.red) << 16U |
                   static_cast<std::uint32_t>(colour.green) << 8U | colour.blue,
               bytes);
      },
      path);
}

void WriteSpacePly(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
                   const std::filesystem::path& path) {
  WriteSpace(
      PlyHeader(points.size(), true), points, colours,
      [](const Colour& colour, std::string* bytes) {
        Append(colour.red, bytes);
        Append(colour.green, bytes);
        Append(colour.blue, bytes);
      },
      path);
}

}  // namespace masked_mapper
