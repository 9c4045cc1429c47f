// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/checkpoint_file.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "log_identity.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "unfinished_folder.hpp"

namespace fs = std::filesystem;

namespace masked_mapper {
namespace {

fs::path FinishedFile(const fs::path& folder, std::size_t drive) {
  return folder / ("drive-" + std::to_string(drive + 1) + kFinishedEnding);
}

}  // namespace

FinishedDrives::FinishedDrives(const fs::path& out, const MapOrigin& origin, bool resume)
    : folder_(UnfinishedFolder(out)), origin_(origin), resume_(resume) {}

std::optional<BuildingMap> FinishedDrives::Load(std::size_t drive) {
  const fs::path file = FinishedFile(folder_, drive);
  if (!resume_ || !fs::exists(file)) return std::nullopt;
  try {
    SavedMap saved = ReadMapFile(file);
    const std::string difference = DifferenceFrom(saved.origin, origin_);
    if (!difference.empty()) {
      throw InputError("the unfinished map was made otherwise: " + difference);
    }
    CheckUnchanged(origin_, saved.origin.identity);
    ++count_;
    return std::move(saved.result);
  } catch (const InputError& error) {
    const std::string text = error.what();
    const bool says_how = text.find("--force") != std::string::npos;
    throw InputError(text + (says_how ? "" : "; --force starts afresh"));
  }
}

void FinishedDrives::Save(std::size_t drive, const BuildingMap& result) {
  std::error_code ignored;
  fs::create_directories(folder_);
  const fs::path file = FinishedFile(folder_, drive);
  const fs::path partial = file.string() + ".partial";
  fs::remove(partial, ignored);
  MapOrigin origin = origin_;
  origin.identity = IdentityText(origin_);
  WriteMapFile(origin, result, partial);
  fs::rename(partial, file);
  fs::remove(folder_ / CheckpointFileName(drive), ignored);
  for (const char* ending : {"-wal", "-journal", "-shm"}) {
    fs::remove((folder_ / CheckpointFileName(drive)).string() + ending, ignored);
  }
  ++count_;
}

void FinishedDrives::Remove() { RemoveUnfinished(folder_); }

}  // namespace masked_mapper
