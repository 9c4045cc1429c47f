// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "checksum.hpp"
#include "mcap_records.hpp"
#include "output_bytes.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kChunk = std::size_t{768} << 10U;  // as rosbag2 closes them
constexpr int kZstdLevel = 3;

std::string Record(McapOp op, const std::string& content) {
  std::string record(1, static_cast<char>(op));
  AppendNumber(std::uint64_t{content.size()}, &record);
  return record + content;
}

class McapWriter final : public BagWriter {
 public:
  explicit McapWriter(const std::string& path) : file_(path) {
    file_.Write(kMcapMagic);
    std::string header;
    AppendString("ros2", &header);
    AppendString("masked_mapper", &header);
    file_.Write(Record(McapOp::kHeader, header));
  }

  MessageEncoding Encoding() const override { return MessageEncoding::kCdr; }

  std::uint16_t AddTopic(const std::string& name, const RosType& type) override {
    const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
    const auto next_schema = static_cast<std::uint16_t>(schemas_.size() + 1);
    const auto [schema, is_new] = schema_of_type_.emplace(type.Ros2Name(), next_schema);
    if (is_new) {
      std::string content;
      AppendNumber(schema->second, &content);
      AppendString(type.Ros2Name(), &content);
      AppendString("ros2msg", &content);
      AppendString(DefinitionOf(type, Encoding()), &content);
      schemas_.push_back(Record(McapOp::kSchema, content));
      records_ += schemas_.back();
    }
    std::string content;
    AppendNumber(number, &content);
    AppendNumber(schema->second, &content);
    AppendString(name, &content);
    AppendString("cdr", &content);
    AppendNumber(std::uint32_t{0}, &content);  // no metadata
    channels_.push_back(Record(McapOp::kChannel, content));
    records_ += channels_.back();
    return number;
  }

  void Write(std::uint16_t topic, std::uint64_t time_ns, std::string_view message) override {
    index_[topic].emplace_back(time_ns, records_.size());
    std::string content;
    AppendNumber(topic, &content);
    AppendNumber(static_cast<std::uint32_t>(counts_[topic]++), &content);
    AppendNumber(time_ns, &content);
    AppendNumber(time_ns, &content);
    content.append(message);
    records_ += Record(McapOp::kMessage, content);
    if (records_.size() >= kChunk) WriteChunk();
  }

  void Close() override {
    if (!records_.empty()) WriteChunk();
    std::string data_end;
    AppendNumber(file_.checksum(), &data_end);
    file_.Write(Record(McapOp::kDataEnd, data_end));
    WriteSummary();
    file_.Write(kMcapMagic);
    file_.Close();
  }

 private:
  struct Chunk {
    std::uint64_t start = 0;  ///< ns
    std::uint64_t end = 0;    ///< ns
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length = 0;
    std::uint64_t packed_size = 0;
    std::uint64_t size = 0;
  };

  std::string Packed() const {
    std::string packed(ZSTD_compressBound(records_.size()), '\0');
    const std::size_t size =
        ZSTD_compress(packed.data(), packed.size(), records_.data(), records_.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
    packed.resize(size);
    return packed;
  }

  void WriteChunk() {
    Chunk chunk;
    chunk.start = index_.empty() ? 0 : ~std::uint64_t{0};
    for (const auto& [topic, entries] : index_) {
      for (const auto& [time, offset] : entries) {
        chunk.start = std::min(chunk.start, time);
        chunk.end = std::max(chunk.end, time);
      }
    }
    const std::string packed = Packed();
    chunk.size = records_.size();
    chunk.packed_size = packed.size();
    std::string content;
    AppendNumber(chunk.start, &content);
    AppendNumber(chunk.end, &content);
    AppendNumber(chunk.size, &content);
    AppendNumber(Crc32After(0, records_.data(), records_.size()), &content);
    AppendString("zstd", &content);
    AppendNumber(chunk.packed_size, &content);
    chunk.offset = file_.position();
    file_.Write(Record(McapOp::kChunk, content + packed));
    chunk.length = file_.position() - chunk.offset;
    WriteMessageIndexes(&chunk);
    chunks_.push_back(std::move(chunk));
    records_.clear();
    index_.clear();
  }

  void WriteMessageIndexes(Chunk* chunk) {
    const std::uint64_t begin = file_.position();
    for (const auto& [topic, entries] : index_) {
      std::string list;
      for (const auto& [time, offset] : entries) {
        AppendNumber(time, &list);
        AppendNumber(offset, &list);
      }
      std::string content;
      AppendNumber(topic, &content);
      AppendString(list, &content);
      chunk->index_offsets[topic] = file_.position();
      file_.Write(Record(McapOp::kMessageIndex, content));
    }
    chunk->index_length = file_.position() - begin;
  }

  std::string Statistics() const {
    std::string counts;
    std::uint64_t messages = 0;
    for (const auto& [topic, count] : counts_) {
      AppendNumber(topic, &counts);
      AppendNumber(count, &counts);
      messages += count;
    }
    std::uint64_t start = chunks_.empty() ? 0 : ~std::uint64_t{0};
    std::uint64_t end = 0;
    for (const Chunk& chunk : chunks_) {
      start = std::min(start, chunk.start);
      end = std::max(end, chunk.end);
    }
    std::string content;
    AppendNumber(messages, &content);
    AppendNumber(static_cast<std::uint16_t>(schemas_.size()), &content);
    AppendNumber(static_cast<std::uint32_t>(channels_.size()), &content);
    AppendNumber(std::uint32_t{0}, &content);  // attachments
    AppendNumber(std::uint32_t{0}, &content);  // metadata
    AppendNumber(static_cast<std::uint32_t>(chunks_.size()), &content);
    AppendNumber(start, &content);
    AppendNumber(end, &content);
    AppendString(counts, &content);
    return Record(McapOp::kStatistics, content);
  }

  static std::string ChunkIndex(const Chunk& chunk) {
    std::string offsets;
    for (const auto& [topic, offset] : chunk.index_offsets) {
      AppendNumber(topic, &offsets);
      AppendNumber(offset, &offsets);
    }
    std::string content;
    AppendNumber(chunk.start, &content);
    AppendNumber(chunk.end, &content);
    AppendNumber(chunk.offset, &content);
    AppendNumber(chunk.length, &content);
    AppendString(offsets, &content);
    AppendNumber(chunk.index_length, &content);
    AppendString("zstd", &content);
    AppendNumber(chunk.packed_size, &content);
    AppendNumber(chunk.size, &content);
    return Record(McapOp::kChunkIndex, content);
  }

  /// Schemas, channels, statistics and chunks, where each of these groups begins, and the footer.
  void WriteSummary() {
    std::string chunk_indexes;
    for (const Chunk& chunk : chunks_) chunk_indexes += ChunkIndex(chunk);
    const auto all = [](const std::vector<std::string>& records) {
      std::string joined;
      for (const std::string& record : records) joined += record;
      return joined;
    };
    const std::uint64_t begin = file_.position();
    std::string summary;
    std::string offsets;
    for (const auto& [op, group] : std::initializer_list<std::pair<McapOp, std::string>>{
             {McapOp::kSchema, all(schemas_)},
             {McapOp::kChannel, all(channels_)},
             {McapOp::kStatistics, Statistics()},
             {McapOp::kChunkIndex, chunk_indexes}}) {
      if (group.empty()) continue;
      std::string content(1, static_cast<char>(op));
      AppendNumber(begin + summary.size(), &content);
      AppendNumber(std::uint64_t{group.size()}, &content);
      offsets += Record(McapOp::kSummaryOffset, content);
      summary += group;
    }
    std::string footer;
    AppendNumber(begin, &footer);
    AppendNumber(begin + summary.size(), &footer);
    // The checksum stands for all before it, the footer's own beginning too.
    std::string record = Record(McapOp::kFooter, footer + std::string(4, '\0'));
    record.resize(record.size() - 4);
    summary += offsets + record;
    AppendNumber(Crc32After(0, summary.data(), summary.size()), &summary);
    file_.Write(summary);
  }

  OutputBytes file_;
  std::map<std::string, std::uint16_t> schema_of_type_;
  std::vector<std::string> schemas_;   ///< as records
  std::vector<std::string> channels_;  ///< as records
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::string records_;  ///< of the chunk that is being filled
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  std::vector<Chunk> chunks_;
};

}  // namespace

std::unique_ptr<BagWriter> CreateMcap(const std::string& path) {
  return std::make_unique<McapWriter>(path);
}

}  // namespace masked_mapper
