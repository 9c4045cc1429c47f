// SPDX-License-Identifier: BSD-3-Clause
// LAS 1.4 (ASPRS, revision 15), point format 7: place, intensity, GPS time and colour. The point
// source is the floor, counted from 1 in the order of the map. Written by hand: Debian has no
// library that writes version 1.4 without a geographic stack behind it.
#pragma once

#include <filesystem>
#include <vector>

#include "point_cloud_file.hpp"
#include "voxel_cloud.hpp"

namespace masked_mapper {

/// Coordinates to a millimetre. Stamps are taken as seconds since 1970 and become GPS time.
/// `colours` by label. Throws std::runtime_error when the file cannot be written.
void WriteLas(const std::vector<SpacePoint>& points, const std::vector<Colour>& colours,
              const std::filesystem::path& path);

}  // namespace masked_mapper
