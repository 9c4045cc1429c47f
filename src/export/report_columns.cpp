// SPDX-License-Identifier: BSD-3-Clause
#include "report_columns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace masked_mapper {

std::string Base64(const void* data, std::size_t size) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::uint32_t left = static_cast<std::uint32_t>(std::min<std::size_t>(3, size - i));
    std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (left > 1) group |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (left > 2) group |= bytes[i + 2];
    text += kDigits[group >> 18 & 63U];
    text += kDigits[group >> 12 & 63U];
    text += left > 1 ? kDigits[group >> 6 & 63U] : '=';
    text += left > 2 ? kDigits[group & 63U] : '=';
  }
  return text;
}

std::uint16_t Quantised(double value, double step) {
  return static_cast<std::uint16_t>(std::clamp(std::round(value / step), 0.0, 65535.0));
}

std::int16_t QuantisedSigned(double value, double step) {
  return static_cast<std::int16_t>(std::clamp(std::round(value / step), -32767.0, 32767.0));
}

void PoseColumns::Add(const Pose2& T_world_robot_before, const Pose2& T_world_robot) {
  for (const auto& [column, pose] :
       {std::pair{&before, T_world_robot_before}, std::pair{&after, T_world_robot}}) {
    column->insert(column->end(), {static_cast<float>(pose.x), static_cast<float>(pose.y),
                                   static_cast<float>(pose.theta)});
  }
}

void PoseColumns::WriteTo(nlohmann::ordered_json& json) const {
  json["before_f32"] = Base64(before);
  json["after_f32"] = Base64(after);
}

}  // namespace masked_mapper
