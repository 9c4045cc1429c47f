// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_records.hpp"

#include <algorithm>

#include "checksum.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kLongestName = 256;

std::string Shortened(std::string_view text) { return std::string(text.substr(0, kLongestName)); }

}  // namespace

const unsigned char* McapFields::Take(std::uint64_t count) {
  if (!good_ || count > left_) {
    good_ = false;
    return nullptr;
  }
  const unsigned char* bytes = data_;
  data_ += count;
  left_ -= static_cast<std::size_t>(count);
  return bytes;
}

std::uint64_t McapFields::Number(std::size_t bytes) {
  const unsigned char* from = Take(bytes);
  std::uint64_t value = 0;
  if (from == nullptr) return value;
  for (std::size_t i = bytes; i-- > 0;) value = (value << 8U) | from[i];
  return value;
}

std::string_view McapFields::Bytes(std::size_t length_bytes) {
  const std::uint64_t length = Number(length_bytes);
  const unsigned char* bytes = Take(length);
  if (bytes == nullptr) return {};
  return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(length)};
}

std::vector<std::pair<std::string, std::string>> McapFields::Map() {
  const std::string_view all = Bytes();
  McapFields inner(reinterpret_cast<const unsigned char*>(all.data()), all.size());
  std::vector<std::pair<std::string, std::string>> map;
  while (inner.good() && inner.left() > 0) {
    std::string key = inner.String();
    map.emplace_back(std::move(key), inner.String());
  }
  if (!inner.good()) good_ = false;
  return map;
}

std::optional<McapRecord> McapRecords::Next() {
  McapFields head(data_, left_);
  const auto op = static_cast<McapOp>(head.Number(1));
  const std::uint64_t size = head.U64();
  if (!head.good() || size > head.left()) return std::nullopt;
  const McapRecord record{op, head.here(), static_cast<std::size_t>(size)};
  data_ = record.data + record.size;
  left_ = head.left() - record.size;
  return record;
}

std::optional<McapSchema> ParseMcapSchema(const McapRecord& record) {
  McapFields fields(record);
  McapSchema schema;
  schema.id = fields.U16();
  schema.name = Shortened(fields.Bytes());
  schema.encoding = Shortened(fields.Bytes());
  if (!fields.good()) return std::nullopt;
  return schema;
}

std::optional<McapChannel> ParseMcapChannel(const McapRecord& record) {
  McapFields fields(record);
  McapChannel channel;
  channel.id = fields.U16();
  channel.schema = fields.U16();
  channel.topic = Shortened(fields.Bytes());
  channel.message_encoding = Shortened(fields.Bytes());
  for (const auto& [key, value] : fields.Map()) {
    if (key == "md5sum") channel.md5sum = Shortened(value);
  }
  if (!fields.good()) return std::nullopt;
  return channel;
}

std::optional<McapMessage> ParseMcapMessage(const McapRecord& record) {
  McapFields fields(record);
  McapMessage message;
  message.channel = fields.U16();
  message.sequence = fields.U32();
  message.log_time = fields.U64();
  fields.U64();  // time of publishing
  message.data = fields.here();
  message.size = fields.left();
  if (!fields.good()) return std::nullopt;
  return message;
}

std::optional<McapChunk> ParseMcapChunk(const unsigned char* data, std::size_t size) {
  McapFields fields(data, size);
  McapChunk chunk;
  chunk.start_time = fields.U64();
  chunk.end_time = fields.U64();
  chunk.size = fields.U64();
  chunk.crc = fields.U32();
  chunk.compression = Shortened(fields.Bytes());
  chunk.packed_size = fields.U64();
  if (!fields.good()) return std::nullopt;
  chunk.fields_size = static_cast<std::size_t>(fields.here() - data);
  return chunk;
}

std::string McapUnpacker::Unpack(const McapChunk& chunk, bool is_cut, Bytes* packed,
                                 Bytes* records) {
  const bool is_plain = chunk.compression.empty();
  const bool is_lz4 = chunk.compression == "lz4";
  if (!is_plain && !is_lz4 && chunk.compression != "zstd") {
    return "is compressed as `" + chunk.compression + "`, which is not known";
  }
  const Packing packing = is_plain ? Packing::kNone : is_lz4 ? Packing::kLz4 : Packing::kZstd;
  const double most = std::min(
      static_cast<double>(kLargestChunk),
      GreatestRatio(packing) * static_cast<double>(is_cut ? chunk.packed_size : packed->size()));
  if (static_cast<double>(chunk.size) > most) {
    return "claims to unpack to " + std::to_string(chunk.size) + " bytes";
  }
  bool whole = true;
  if (is_plain) {
    records->swap(*packed);
  } else {
    std::unique_ptr<Unpacker>& unpacker = is_lz4 ? lz4_ : zstd_;
    if (!unpacker) unpacker = MakeUnpacker(packing);
    whole = UnpackAll(unpacker.get(), packed->data(), packed->size(),
                      static_cast<std::size_t>(chunk.size), records);
  }
  if (is_cut) return "";
  if (!whole) return "cannot be unpacked";
  if (records->size() != chunk.size) return "has not the size that it claims";
  if (chunk.crc != 0 && chunk.crc != Crc32After(0, records->data(), records->size()))
    return "fails its checksum";
  return "";
}

}  // namespace masked_mapper
