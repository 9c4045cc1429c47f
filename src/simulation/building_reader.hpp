// SPDX-License-Identifier: BSD-3-Clause
// Reading the text of a building, written as if it came from an enemy.
#pragma once

#include <array>
#include <iosfwd>
#include <string>
#include <utility>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// The words of a building's file for what walls are made of.
constexpr std::array<std::pair<const char*, Surface>, 4> kSurfaces{
    {{"wall", Surface::kWall},
     {"glass", Surface::kGlass},
     {"door", Surface::kDoor},
     {"furniture", Surface::kFurniture}}};

/// Throws InputError that names `name` and the line.
Building ReadBuildingText(std::istream& text, const std::string& name);

}  // namespace masked_mapper
