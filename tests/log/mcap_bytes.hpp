// SPDX-License-Identifier: BSD-3-Clause
// MCAP files made by hand, byte for byte, so that tests can spoil them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

#include "log/bag_bytes.hpp"
#include "log/packed_bytes.hpp"

namespace masked_mapper {

inline const std::string kMcapMagicBytes("\x89MCAP0\r\n", 8);

inline std::string McapRecordBytes(int op, const std::string& content) {
  return std::string(1, static_cast<char>(op)) + Raw(std::uint64_t{content.size()}) + content;
}

inline std::string McapHeaderBytes() {
  return McapRecordBytes(1, WithLength("ros2") + WithLength("by hand"));
}

inline std::string McapSchemaBytes(std::uint16_t id, const std::string& type,
                                   const std::string& encoding = "ros2msg") {
  return McapRecordBytes(3, Raw(id) + WithLength(type) + WithLength(encoding) + WithLength("..."));
}

inline std::string McapChannelBytes(std::uint16_t id, std::uint16_t schema,
                                    const std::string& topic, const std::string& encoding = "cdr") {
  return McapRecordBytes(
      4, Raw(id) + Raw(schema) + WithLength(topic) + WithLength(encoding) + WithLength(""));
}

inline std::string McapMessageBytes(std::uint16_t channel, double time, const std::string& data) {
  const auto ns = static_cast<std::uint64_t>(time * 1e9);
  return McapRecordBytes(5, Raw(channel) + Raw(std::uint32_t{0}) + Raw(ns) + Raw(ns) + data);
}

inline std::uint32_t CrcOf(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// With whatever it claims of its records.
inline std::string McapChunkBytes(double start, const std::string& packed, std::uint64_t size,
                                  std::uint32_t crc, const std::string& compression) {
  const auto ns = static_cast<std::uint64_t>(start * 1e9);
  return McapRecordBytes(6, Raw(ns) + Raw(ns) + Raw(size) + Raw(crc) + WithLength(compression) +
                                Raw(std::uint64_t{packed.size()}) + packed);
}

inline std::string McapZstdChunk(double start, const std::string& records) {
  return McapChunkBytes(start, ZstdPacked(records), records.size(), CrcOf(records), "zstd");
}

inline std::string McapEndBytes() {
  return McapRecordBytes(15, Raw(std::uint32_t{0})) +
         McapRecordBytes(2, Raw(std::uint64_t{0}) + Raw(std::uint64_t{0}) + Raw(std::uint32_t{0})) +
         kMcapMagicBytes;
}

inline std::string McapBytes(const std::string& data_section) {
  return kMcapMagicBytes + McapHeaderBytes() + data_section + McapEndBytes();
}

}  // namespace masked_mapper
