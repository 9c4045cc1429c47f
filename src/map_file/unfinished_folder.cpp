// SPDX-License-Identifier: BSD-3-Clause
#include "unfinished_folder.hpp"

#include <system_error>

namespace fs = std::filesystem;

namespace masked_mapper {

fs::path UnfinishedFolder(const fs::path& out) {
  fs::path resolved = fs::weakly_canonical(fs::absolute(out));
  if (!resolved.has_filename()) resolved = resolved.parent_path();
  return resolved.parent_path() / ("." + resolved.filename().string() + ".unfinished");
}

std::string CheckpointFileName(std::size_t drive) {
  return "checkpoint" + (drive == 0 ? "" : "-" + std::to_string(drive + 1)) + kCheckpointEnding;
}

void RemoveUnfinished(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace masked_mapper
