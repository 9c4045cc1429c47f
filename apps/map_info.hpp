// SPDX-License-Identifier: BSD-3-Clause
// What `info` says of a saved map.
#pragma once

#include <string>

namespace masked_mapper {

/// Prints it, in words or as JSON. Throws InputError when there is no readable map.
void PrintMapInfo(const std::string& out_or_map, bool as_json);

}  // namespace masked_mapper
