// SPDX-License-Identifier: BSD-3-Clause
// Point clouds as binary PCD and PLY, with a colour and the field `label` per point. Written by
// hand: PCL's own writers print, refuse an empty cloud, miss a full disk, and load VTK at every
// start.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"
#include "voxel_cloud.hpp"

namespace masked_mapper {

using ColouredCloud = pcl::PointCloud<pcl::PointXYZRGBL>;

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

/// The colour of each floor, lighter upwards as in the paper's Fig. 1; floors at one height differ
/// too.
std::vector<Colour> FloorColours(const std::vector<Floor>& floors);

/// The points with a colour each, that of their label.
ColouredCloud Coloured(const pcl::PointCloud<pcl::PointXYZL>& cloud,
                       const std::vector<Colour>& colours);

/// Fields x y z rgba label, as PCL writes its PointXYZRGBL. Throws std::runtime_error when the file
/// cannot be written.
void WritePcd(const ColouredCloud& cloud, const std::filesystem::path& path);

/// The same with the field intensity behind; `colours` by label.
void WriteSpacePcd(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
                   const std::filesystem::path& path);
void WriteSpacePly(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
                   const std::filesystem::path& path);

/// Properties x y z red green blue label. Throws std::runtime_error when the file cannot be
/// written.
void WritePly(const ColouredCloud& cloud, const std::filesystem::path& path);

}  // namespace masked_mapper
