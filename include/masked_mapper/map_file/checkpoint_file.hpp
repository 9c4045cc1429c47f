// SPDX-License-Identifier: BSD-3-Clause
// The unfinished map on disk: a SQLite file in a folder beside the one that the map goes to,
// written in transactions, so that whatever ends the program, the last checkpoint stands.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/mapping/checkpoint.hpp"

namespace masked_mapper {

class CheckpointFile : public CheckpointStore {
 public:
  /// Nothing is made before the first Save(). `interval_s` between two checkpoints at least, and
  /// longer if one takes more than a small share of it; 0: only when asked by Save(). With
  /// `resume`, Load() gives what is there; else the first Save() replaces it. Of several logs each
  /// `drive` has a checkpoint of its own.
  CheckpointFile(const std::filesystem::path& out, const MapOrigin& origin, double interval_s,
                 bool resume, std::size_t drive = 0);
  ~CheckpointFile() override;

  /// Whether there is a checkpoint of a map that goes to `out`.
  static bool Exists(const std::filesystem::path& out);

  std::optional<Checkpoint> Load() override;
  bool IsDue() override;
  void Save(const CheckpointState& state, const BuildingMap& map) override;
  void StartOver() override;

  /// Whether Load() found or Save() left something to go on from.
  bool HasCheckpoint() const { return has_checkpoint_; }
  /// The share of the log that has gone into it, 0 to 1.
  double progress() const { return progress_; }
  /// Removes it: the map is finished, or wanted no more.
  void Remove();

 private:
  using Clock = std::chrono::steady_clock;
  class Impl;

  std::filesystem::path folder_;
  std::filesystem::path file_;
  MapOrigin origin_;
  Clock::duration interval_;
  Clock::time_point due_;
  bool resume_;
  bool has_checkpoint_ = false;
  double progress_ = 0.0;
  std::unique_ptr<Impl> impl_;
};

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
