// SPDX-License-Identifier: BSD-3-Clause
// The records of an MCAP file (mcap.dev/spec, version 0): an operation code, a length, fields.
// What a record holds behind the fields that are known belongs to it and is skipped, and so are
// records of unknown code. Every length is held against the bytes that are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "unpacking.hpp"

namespace masked_mapper {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

struct McapRecord {
  static constexpr std::size_t kHeadSize = 9;  ///< code and length

  McapOp op{};
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

/// Fields one after the other; once one does not fit, nothing does, and good() is false.
class McapFields {
 public:
  McapFields(const unsigned char* data, std::size_t size) : data_(data), left_(size) {}
  explicit McapFields(const McapRecord& record) : McapFields(record.data, record.size) {}

  bool good() const { return good_; }
  std::size_t left() const { return left_; }
  const unsigned char* here() const { return data_; }

  std::uint64_t Number(std::size_t bytes);
  std::uint16_t U16() { return static_cast<std::uint16_t>(Number(2)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Number(4)); }
  std::uint64_t U64() { return Number(8); }
  /// The bytes behind their length, which is a number of `length_bytes`.
  std::string_view Bytes(std::size_t length_bytes = 4);
  std::string String() { return std::string(Bytes()); }
  std::vector<std::pair<std::string, std::string>> Map();

 private:
  const unsigned char* Take(std::uint64_t count);

  const unsigned char* data_;
  std::size_t left_;
  bool good_ = true;
};

/// Walks through records that lie in memory.
class McapRecords {
 public:
  McapRecords(const unsigned char* data, std::size_t size) : data_(data), left_(size) {}

  /// Empty at the end, or before a record that does not fit.
  std::optional<McapRecord> Next();
  /// Bytes that Next() left because they are no whole record.
  std::size_t left() const { return left_; }

 private:
  const unsigned char* data_;
  std::size_t left_;
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic;
  std::string message_encoding;
  std::string md5sum;  ///< of a channel that was a ROS 1 connection
};

struct McapMessage {
  static constexpr std::size_t kFieldsSize = 22;  ///< before the data

  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;  ///< ns
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

/// Without its records, which are the `packed_size` bytes behind the `fields_size` first.
struct McapChunk {
  std::uint64_t start_time = 0;  ///< ns
  std::uint64_t end_time = 0;    ///< ns
  std::uint64_t size = 0;        ///< unpacked, as the chunk claims
  std::uint32_t crc = 0;         ///< of the unpacked records; 0: not given
  std::string compression;
  std::uint64_t packed_size = 0;
  std::size_t fields_size = 0;
};

std::optional<McapSchema> ParseMcapSchema(const McapRecord& record);
std::optional<McapChannel> ParseMcapChannel(const McapRecord& record);
std::optional<McapMessage> ParseMcapMessage(const McapRecord& record);
/// Of the beginning of a record's bytes; whether the packed records fit into it is for the caller
/// to see.
std::optional<McapChunk> ParseMcapChunk(const unsigned char* data, std::size_t size);

/// Unpacks the records of chunks, one after the other.
class McapUnpacker {
 public:
  /// What is wrong with a chunk, in words; empty: nothing, and `*records` is what it holds. Of a
  /// chunk whose end is missing (`is_cut`) that is its beginning, and no checksum holds. What
  /// `*packed` held is lost. What `*records` had before is room, and is not filled anew.
  std::string Unpack(const McapChunk& chunk, bool is_cut, Bytes* packed, Bytes* records);

 private:
  std::unique_ptr<Unpacker> lz4_;
  std::unique_ptr<Unpacker> zstd_;
};

}  // namespace masked_mapper
