// SPDX-License-Identifier: BSD-3-Clause
// Of several logs, the drives that are finished while others are not: whatever ends the program,
// they need not be driven again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

/// Of a map of several logs in the making, the drives that are finished: each a saved map in the
/// folder of the checkpoints.
class FinishedDrives {
 public:
  /// With `resume`, Load() gives what is there.
  FinishedDrives(const std::filesystem::path& out, const MapOrigin& origin, bool resume);

  /// Empty when the drive is not finished. Throws InputError when it is, but of other logs or
  /// options, or damaged.
  std::optional<BuildingMap> Load(std::size_t drive);
  /// Keeps it, whole or not at all, and removes the drive's checkpoint. Throws std::exception when
  /// it cannot be written.
  void Save(std::size_t drive, const BuildingMap& result);
  /// How many were loaded or saved.
  std::size_t count() const { return count_; }
  /// Removes them, with all checkpoints.
  void Remove();

 private:
  std::filesystem::path folder_;
  MapOrigin origin_;
  bool resume_;
  std::size_t count_ = 0;
};

}  // namespace masked_mapper
