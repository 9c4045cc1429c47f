// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/route.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr double kStampTolerance = 0.5;  // s
constexpr double kFarthest = 1e7;        // m; as far as grids go

std::optional<double> NumberIn(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

Place ByStamp(const std::string& text, const BuildingMap& map) {
  const std::optional<double> stamp = NumberIn(std::string_view(text).substr(2));
  if (!stamp) throw InputError("place `" + text + "`: a stamp in seconds must follow t=");
  const TrajectoryPose* nearest = nullptr;
  double smallest = kStampTolerance;
  for (const TrajectoryPose& pose : map.trajectory) {
    const double off = std::abs(pose.stamp - *stamp);
    if (off > smallest || (nearest != nullptr && off == smallest)) continue;
    smallest = off;
    nearest = &pose;
  }
  if (nearest == nullptr) {
    throw InputError("place `" + text + "`: the map has no scan within half a second of it");
  }
  if (nearest->in_transit) {
    throw InputError("place `" + text + "`: the robot was between two floors then");
  }
  return {nearest->floor, nearest->T_world_robot.Translation()};
}

Place ByCoordinates(const std::string& text, const BuildingMap& map) {
  const std::size_t first = text.find(',');
  const std::size_t second = text.find(',', first + 1);
  const std::string_view all = text;
  const auto x = second == std::string::npos ? std::nullopt
                                             : NumberIn(all.substr(first + 1, second - first - 1));
  const auto y = second == std::string::npos ? std::nullopt : NumberIn(all.substr(second + 1));
  if (!x || !y || std::abs(*x) > kFarthest || std::abs(*y) > kFarthest) {
    throw InputError("place `" + text + "`: expected floor,x,y in metres, such as 0,4.5,-2");
  }
  const std::string label = text.substr(0, first);
  std::vector<std::string> labels;
  for (const Floor& floor : map.graph.floors()) labels.push_back(floor.label);
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found == labels.end()) {
    std::string known;
    for (const std::string& one : labels) known += (known.empty() ? "" : ", ") + one;
    throw InputError("place `" + text + "`: the map has no floor `" + label + "`, it has " + known);
  }
  return {static_cast<FloorId>(found - labels.begin()), {*x, *y}};
}

}  // namespace

Place PlaceOf(const std::string& text, const BuildingMap& map) {
  if (text.rfind("t=", 0) == 0) return ByStamp(text, map);
  if (text.find(',') != std::string::npos) return ByCoordinates(text, map);
  std::vector<std::string> names;
  for (const NamedPlace& place : map.places) {
    if (place.name == text) return {place.floor, place.at_in_world};
    names.push_back(place.name);
  }
  const std::string meant = DidYouMean(text, names);
  throw InputError("place `" + text + "`: the map has no place of that name" +
                   (meant.empty() ? "; expected floor,x,y or t=STAMP or a name" : meant));
}

}  // namespace masked_mapper
