// SPDX-License-Identifier: BSD-3-Clause
// What a pass through a log gave, so that the next one need not make it again: to cut the clouds of
// a 3D lidar to scans takes longer than all that is done with the scans, which are a hundredth of
// the clouds; to unpack and to read text takes ten times as long as to take up what was read. They
// lie in a temporary file that has no name any more: whatever ends the program, it leaves nothing
// behind.
#pragma once

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include "masked_mapper/log/packed_cloud.hpp"
#include "read_ahead.hpp"

namespace masked_mapper {

class KeptPass {
 public:
  /// Without a place for the file nothing is ever kept, nor where it would be larger than this.
  explicit KeptPass(std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

  /// The batches of one pass, in order.
  void Add(const ObservationBatch& batch);
  /// Clouds that the pass kept, which stay in memory.
  void AddClouds(std::vector<StampedCloud> clouds);
  /// The pass went to the end of the log.
  void Finish();
  /// Whether all of a pass is here. From then on it may be replayed, also by several at once.
  bool IsWhole() const;
  /// In order; none before the end of the pass.
  std::vector<StampedCloud> Clouds() const;

  /// Hands the batches out as the pass did, all with its statistics at the end; ends early when the
  /// sink wants no more. Throws std::runtime_error: the file cannot be read any more.
  void Replay(const ReadAhead::Sink& sink) const;

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;  ///< bytes
    double progress = 0.0;
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::unique_ptr<std::FILE, CloseFile> file_;  ///< none: it failed
  std::uint64_t most_bytes_;
  std::vector<Place> places_;
  std::uint64_t end_ = 0;     ///< bytes
  LogStatistics statistics_;  ///< as of the last batch
  std::vector<StampedCloud> clouds_;
  mutable std::mutex mutex_;
  bool has_ended_ = false;
  bool is_whole_ = false;
};

}  // namespace masked_mapper
