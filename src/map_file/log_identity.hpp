// SPDX-License-Identifier: BSD-3-Clause
// Whether what a map in the making was read from is still what it was.
#pragma once

#include <string>

#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// Of every log, file of floors and map that `origin` names, a line: size and checksum of both
/// ends.
std::string IdentityText(const MapOrigin& origin);

/// Throws InputError naming the first that has changed since.
void CheckUnchanged(const MapOrigin& origin, const std::string& identity_before);

}  // namespace masked_mapper
