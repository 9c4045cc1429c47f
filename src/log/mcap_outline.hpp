// SPDX-License-Identifier: BSD-3-Clause
// What an MCAP file holds and where: found by walking over the heads of its records from front to
// back, so that no index is needed, nor an end. Of the summary only the list of channels is used,
// and only when it is complete; else the chunks are looked through for theirs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "file_window.hpp"
#include "mcap_records.hpp"

namespace masked_mapper {

/// A chunk, or neighbouring records of which some are messages.
struct McapSegment {
  std::uint64_t start_time = 0;  ///< ns; a chunk's own word for it
  std::uint64_t offset = 0;      ///< of a chunk's fields, or of the first record
  std::uint64_t size = 0;        ///< of bytes that are in the file
  bool is_chunk = false;
  bool is_cut = false;  ///< the file ends before the chunk does
};

/// Channels and their schemas, wherever they were found.
struct McapChannels {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;

  /// Takes a schema or a channel; false when the record is one and makes no sense.
  bool Add(const McapRecord& record);
};

struct McapOutline {
  std::vector<McapSegment> segments;  ///< in order of time
  McapChannels channels;
  bool knows_all_channels = false;
  bool truncated = false;
  std::uint64_t damaged = 0;
  std::string first_damage;
};

/// Throws InputError: no MCAP file, or of another version.
McapOutline OutlineMcap(FileWindow* file);

}  // namespace masked_mapper
