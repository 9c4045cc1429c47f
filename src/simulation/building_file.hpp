// SPDX-License-Identifier: BSD-3-Clause
// Buildings as plain text, one item per line; the format is described in docs/simulation.md.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// Reads a building; `name` stands for the file in messages.
/// Throws InputError ("NAME:17: ...") at the first line that does not fit.
Building ReadBuilding(std::istream& text, const std::string& name);

/// The inverse of ReadBuilding.
std::string WriteBuilding(const Building& building);

}  // namespace masked_mapper
