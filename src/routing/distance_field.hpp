// SPDX-License-Identifier: BSD-3-Clause
// How far it is from each cell of a grid to the nearest marked one.
#pragma once

#include <cstdint>
#include <vector>

namespace masked_mapper {

/// Exact Euclidean distances between centres, in cells; `kNoneMarked` or more where nothing is
/// marked. `marked` row by row, `width` times as many as there are rows.
constexpr float kNoneMarked = 1e9F;
std::vector<float> DistanceField(const std::vector<std::uint8_t>& marked, int width);

}  // namespace masked_mapper
