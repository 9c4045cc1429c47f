// SPDX-License-Identifier: BSD-3-Clause
// Where a map in the making is kept: checkpoints, and of several logs the drives that are finished.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace masked_mapper {

constexpr const char* kCheckpointEnding = ".mmck";
constexpr const char* kFinishedEnding = ".mmap";

/// `out` without its last part, then `.NAME.unfinished`.
std::filesystem::path UnfinishedFolder(const std::filesystem::path& out);

/// Of the first log, and of later ones.
std::string CheckpointFileName(std::size_t drive);

/// The folder with all that is in it.
void RemoveUnfinished(const std::filesystem::path& folder);

}  // namespace masked_mapper
