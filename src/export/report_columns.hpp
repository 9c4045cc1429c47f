// SPDX-License-Identifier: BSD-3-Clause
// Columns of numbers as the page of the report reads them: packed, in base 64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

std::string Base64(const void* data, std::size_t size);

template <typename T>
std::string Base64(const std::vector<T>& column) {
  return Base64(column.data(), column.size() * sizeof(T));
}

// Not `int` halves: a floor is some hundred metres, and 16 bits make that millimetres.
std::uint16_t Quantised(double value, double step);
std::int16_t QuantisedSigned(double value, double step);

// Poses as columns, before and after optimisation.
struct PoseColumns {
  std::vector<float> before;  // x, y, theta of each
  std::vector<float> after;

  void Add(const Pose2& T_world_robot_before, const Pose2& T_world_robot);
  void WriteTo(nlohmann::ordered_json& json) const;
};

}  // namespace masked_mapper
