// SPDX-License-Identifier: BSD-3-Clause
// Files that no command may take for a log.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/program.hpp"

namespace masked_mapper {

/// Writes them; each name comes with what the program must say of it.
inline std::vector<std::pair<std::string, std::string>> WriteLogsThatAreNone(
    const ScratchFolder& folder) {
  std::filesystem::create_directory(folder / "folder");
  WriteText(folder / "empty.log", "");
  std::string binary(5000, '\0');
  for (std::size_t i = 0; i < binary.size(); ++i) binary[i] = static_cast<char>(i * 37 % 251);
  WriteText(folder / "binary.log", binary);
  WriteText(folder / "fake.log.gz", "\x1f\x8b\x08" + binary);
  return {{"nowhere.log", "nowhere.log"},
          {"folder", "folder"},
          {"empty.log", "empty"},
          {"binary.log", "binary.log"},
          {"fake.log.gz", "fake.log.gz"}};
}

}  // namespace masked_mapper
