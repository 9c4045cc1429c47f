// SPDX-License-Identifier: BSD-3-Clause
#include "building_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>

#include "building_plans.hpp"
#include "building_reader.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// The shortest text that reads back as the same number.
void Append(std::string& text, double value) {
  std::array<char, 64> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  static_cast<void>(error);
  text.push_back(' ');
  text.append(digits.data(), end);
}

void Append(std::string& text, const Eigen::Vector2d& point) {
  Append(text, point.x());
  Append(text, point.y());
}

void AppendConnections(const Building& building, std::string& text) {
  for (const Elevator& elevator : building.elevators) {
    text += "elevator " + elevator.name;
    Append(text, elevator.T_building_cab.Translation());
    Append(text, RadToDeg(elevator.T_building_cab.theta));
    Append(text, elevator.depth);
    Append(text, elevator.width);
    Append(text, elevator.door_width);
    text += "\n";
  }
  for (const Stairs& stairs : building.stairs) {
    text += "stairs " + stairs.name;
    for (const Eigen::Vector2d& point : stairs.way) Append(text, point);
    text += "\n";
  }
}

void AppendFloor(const Building& building, std::size_t f, std::string& text) {
  const FloorPlan& floor = building.floors[f];
  text += "\nfloor " + floor.label;
  Append(text, floor.elevation);
  text += "\n";
  for (const Segment& segment : floor.segments) {
    const auto surface = std::find_if(kSurfaces.begin(), kSurfaces.end(), [&](const auto& entry) {
      return entry.second == segment.surface;
    });
    text += surface->first;
    Append(text, segment.a);
    Append(text, segment.b);
    text += "\n";
  }
  for (const Overhead& block : floor.overhead) {
    text += "overhead";
    Append(text, block.T_building_block.Translation());
    Append(text, RadToDeg(block.T_building_block.theta));
    for (const double metres : {block.length, block.width, block.low, block.high}) {
      Append(text, metres);
    }
    text += "\n";
  }
  for (const WayPoint& way_point : floor.way_points) {
    text += "point " + way_point.name;
    Append(text, way_point.position);
    text += "\n";
  }
  for (const Passage& passage : floor.passages) {
    text += (passage.must_visit ? "corridor " : "way ") + floor.way_points[passage.from].name +
            " " + floor.way_points[passage.to].name + "\n";
  }
  const auto landing_here = [&](const char* item, const std::string& name, const Landing& landing) {
    if (landing.floor != f) return;
    text += std::string(item) + " " + name + " " + floor.way_points[landing.way_point].name + "\n";
  };
  for (const Elevator& elevator : building.elevators) {
    for (const Landing& landing : elevator.landings) landing_here("stop", elevator.name, landing);
  }
  for (const Stairs& stairs : building.stairs) {
    landing_here("foot", stairs.name, stairs.lower);
    landing_here("head", stairs.name, stairs.upper);
  }
}

void AppendTour(const Building& building, std::string& text) {
  const UsualTour& tour = building.usual_tour;
  const FloorPlan& start = building.floors[tour.start_floor];
  text += "\nstart " + start.label + " " + start.way_points[tour.start_way_point].name + "\n";
  if (!tour.visits.empty()) {
    text += "visit";
    for (const std::size_t floor : tour.visits) text += " " + building.floors[floor].label;
    text += "\n";
  }
  text += "rest";
  Append(text, tour.rest_per_metre);
  text += "\n";
}

}  // namespace

Building ReadBuilding(std::istream& text, const std::string& name) {
  return ReadBuildingText(text, name);
}

std::string WriteBuilding(const Building& building) {
  std::string text = "building " + building.name + "\n";
  AppendConnections(building, text);
  for (std::size_t f = 0; f < building.floors.size(); ++f) AppendFloor(building, f, text);
  AppendTour(building, text);
  return text;
}

Building LoadBuilding(const std::string& name_or_path, std::uint64_t seed) {
  if (std::optional<Building> named = NamedBuilding(name_or_path, seed)) return *std::move(named);
  std::error_code error;
  if (std::filesystem::is_directory(name_or_path, error)) {
    throw InputError(name_or_path + ": is a directory, not a building file");
  }
  std::ifstream file(name_or_path, std::ios::binary);
  if (!file) {
    std::string names;
    for (const std::string& name : BuildingNames()) names += (names.empty() ? "" : ", ") + name;
    throw InputError("no building or building file '" + name_or_path + "'" +
                     DidYouMean(name_or_path, BuildingNames()) + "; there are " + names);
  }
  return ReadBuilding(file, name_or_path);
}

}  // namespace masked_mapper
