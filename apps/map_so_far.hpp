// SPDX-License-Identifier: BSD-3-Clause
// The map of a log that is still coming: of all that came until it was asked for, as `map` would
// make it of that much. It is made beside the listening, and written whole into OUT, or not at all.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "map_run.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {

class MapSoFar {
 public:
  /// `kept_path`: where all that came can be read; every N seconds one, 0: when SIGUSR1 asks alone.
  MapSoFar(const MapArguments& arguments, const MapOrigin& origin, std::string kept_path,
           ExistingFolder existing, ProgressBar& progress);
  ~MapSoFar() { Finish(); }
  MapSoFar(const MapSoFar&) = delete;
  MapSoFar& operator=(const MapSoFar&) = delete;

  /// Bytes that came, in order; they are kept already.
  void Note(std::string_view bytes);
  /// Says what became of the one at work, and begins the next when it is time.
  void Look();

  /// The log is over, and its map will be that of all of it: one at work is given up. Whether OUT
  /// holds one.
  bool Finish();

 private:
  using Clock = std::chrono::steady_clock;

  void Begin();
  void CopyWhatCame();
  void Make();
  void Write(BuildingMap map);
  void Join();
  bool IsDue();

  const MapArguments& arguments_;
  const MapOrigin& origin_;
  std::string kept_path_;
  ExistingFolder existing_;
  ProgressBar& progress_;
  std::optional<bool> is_text_;
  std::uint64_t came_ = 0;         ///< bytes
  std::uint64_t whole_lines_ = 0;  ///< bytes up to the end of the last one
  std::uint64_t copied_ = 0;       ///< bytes
  std::shared_ptr<Spool> copy_;    ///< what the one at work is made of: that must not grow
  bool is_asked_ = false;
  bool is_there_ = false;
  Clock::time_point begun_;
  Clock::time_point earliest_;  ///< for the next

  std::thread worker_;
  std::atomic<bool> is_given_up_{false};
  std::atomic<bool> is_done_{false};
  bool was_written_ = false;  ///< by the worker, as what it said
  std::string said_;
};

}  // namespace masked_mapper
