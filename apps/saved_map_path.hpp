// SPDX-License-Identifier: BSD-3-Clause
// OUT|MAP on the command line: the folder that `map` wrote, or the saved map in it.
#pragma once

#include <filesystem>
#include <string>

namespace masked_mapper {

/// Whether this is a folder or a saved map rather than a log.
bool IsOutOrMap(const std::string& path);

/// The saved map that is meant. Throws InputError when a folder has none.
std::filesystem::path MapFileOf(const std::string& out_or_map);

}  // namespace masked_mapper
