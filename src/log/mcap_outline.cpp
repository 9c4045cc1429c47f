// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_outline.hpp"

#include <algorithm>
#include <optional>

#include "checksum.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr std::uint64_t kLongestRun = std::uint64_t{1} << 20U;
constexpr std::uint64_t kLongestDescription = std::uint64_t{1} << 20U;  // of a channel
constexpr std::size_t kMostChannels = 10000;

}  // namespace

bool McapChannels::Add(const McapRecord& record) {
  if (record.op == McapOp::kSchema) {
    const std::optional<McapSchema> schema = ParseMcapSchema(record);
    if (schema && schemas.size() < kMostChannels) schemas.emplace(schema->id, *schema);
    return schema.has_value();
  }
  if (record.op != McapOp::kChannel) return true;
  const std::optional<McapChannel> channel = ParseMcapChannel(record);
  if (channel && channels.size() < kMostChannels) channels.emplace(channel->id, *channel);
  return channel.has_value();
}

namespace {

class Walk {
 public:
  explicit Walk(FileWindow* file) : file_(*file) {}

  McapOutline Run() {
    CheckMagic();
    offset_ = kMcapMagic.size();
    while (!ended_ && Step()) {
    }
    outline_.truncated = outline_.truncated || !ended_;
    TakeSummary();
    std::stable_sort(
        outline_.segments.begin(), outline_.segments.end(),
        [](const McapSegment& a, const McapSegment& b) { return a.start_time < b.start_time; });
    return std::move(outline_);
  }

 private:
  void CheckMagic() {
    std::size_t found = 0;
    const auto* begin = reinterpret_cast<const char*>(file_.At(0, kMcapMagic.size(), &found));
    const std::string_view magic(begin, found);
    if (magic == kMcapMagic) return;
    constexpr std::size_t kVersionAt = 5;
    if (found > kVersionAt && magic.substr(0, kVersionAt) == kMcapMagic.substr(0, kVersionAt)) {
      throw InputError(file_.name() + ": is MCAP of version `" + magic[kVersionAt] +
                       "`; version 0 is read");
    }
    throw InputError(file_.name() + ": is not an MCAP file");
  }

  void Damage(const std::string& what) {
    if (outline_.damaged++ == 0) {
      outline_.first_damage = "byte " + std::to_string(offset_) + ": " + what;
    }
  }

  /// The record at the offset; false when nothing can follow.
  bool Step() {
    std::size_t found = 0;
    const unsigned char* bytes = file_.At(offset_, McapRecord::kHeadSize, &found);
    McapFields head(bytes, found);
    const auto op = static_cast<McapOp>(head.Number(1));
    size_ = head.U64();
    if (!head.good()) return false;
    const std::uint64_t left = file_.size() - offset_ - McapRecord::kHeadSize;
    is_cut_ = size_ > left;
    if (is_cut_ || op == McapOp{}) {
      if (const std::uint64_t next = NextIndexedChunk()) {
        Damage("a record claims " + std::to_string(size_) + " bytes");
        offset_ = next;
        return true;
      }
      size_ = left;
      if (op == McapOp::kChunk) TakeChunk();
      return false;
    }
    Take(op);
    offset_ += McapRecord::kHeadSize + size_;
    return true;
  }

  void Take(McapOp op) {
    switch (op) {
      case McapOp::kSchema:
      case McapOp::kChannel:
        TakeDescription(op);
        break;
      case McapOp::kMessage:
        if (!data_ended_) TakeMessage();
        break;
      case McapOp::kChunk:
        if (!data_ended_) TakeChunk();
        break;
      case McapOp::kDataEnd:
        data_ended_ = true;
        CheckData(Content(sizeof(std::uint32_t)).U32());
        break;
      case McapOp::kStatistics: {
        McapFields fields = Content(8 + 2 + 4);
        fields.Number(8 + 2);  // messages, schemas
        const std::uint32_t channels = fields.U32();
        if (fields.good()) stated_channels_ = channels;
        break;
      }
      case McapOp::kFooter:
        CheckSummary();
        ended_ = true;
        break;
      default:  // indexes, attachments, what is unknown
        break;
    }
  }

  /// The first bytes of the record's content, as far as it goes.
  McapFields Content(std::size_t count) {
    std::size_t found = 0;
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_));
    const unsigned char* data = file_.At(offset_ + McapRecord::kHeadSize, wanted, &found);
    return {data, found};
  }

  void TakeDescription(McapOp op) {
    // The definition of a schema comes last, and is not needed.
    const McapFields content = Content(kLongestDescription);
    const McapRecord record{op, content.here(), content.left()};
    if (!(data_ended_ ? summary_ : outline_.channels).Add(record)) Damage("a malformed channel");
  }

  void TakeMessage() {
    McapFields fields = Content(McapMessage::kFieldsSize);
    fields.Number(2 + 4);  // channel, sequence
    const std::uint64_t time = fields.U64();
    if (!fields.good() || size_ > kLargestChunk) {
      Damage("a message of " + std::to_string(size_) + " bytes");
      return;
    }
    has_bare_messages_ = true;
    const std::uint64_t end = offset_ + McapRecord::kHeadSize + size_;
    std::vector<McapSegment>& segments = outline_.segments;
    const bool goes_on = !segments.empty() && !segments.back().is_chunk &&
                         end - segments.back().offset <= kLongestRun;
    if (!goes_on) segments.push_back({time, offset_, 0, false, false});
    segments.back().start_time = std::min(segments.back().start_time, time);
    segments.back().size = end - segments.back().offset;
  }

  void TakeChunk() {
    constexpr std::size_t kFieldsSize = 8 + 8 + 8 + 4 + 4 + 256 + 8;
    const McapFields content = Content(kFieldsSize);
    const std::optional<McapChunk> chunk = ParseMcapChunk(content.here(), content.left());
    if (!chunk) {
      if (!is_cut_) Damage("a malformed chunk");
      return;
    }
    const bool fits = is_cut_ || chunk->packed_size <= size_ - chunk->fields_size;
    if (!fits || chunk->packed_size > kLargestChunk) {
      Damage("a chunk claims " + std::to_string(chunk->packed_size) + " bytes");
      return;
    }
    outline_.segments.push_back(
        {chunk->start_time, offset_ + McapRecord::kHeadSize, size_, true, is_cut_});
  }

  /// The checksum of a stretch of the file.
  std::uint32_t Checksum(std::uint64_t begin, std::uint64_t end) {
    std::uint32_t crc = 0;
    Bytes block;
    while (begin < end) {
      constexpr std::uint64_t kBlock = 256 * 1024;
      file_.Read(begin, static_cast<std::size_t>(std::min(kBlock, end - begin)), &block);
      crc = Crc32After(crc, block.data(), block.size());
      begin += block.size();
    }
    return crc;
  }

  /// Chunks have their own checksums, which also tell what is bad.
  void CheckData(std::uint32_t crc) {
    if (crc == 0 || !has_bare_messages_) return;
    if (Checksum(0, offset_) != crc) Damage("what is before fails its checksum");
  }

  void CheckSummary() {
    constexpr std::size_t kBeforeChecksum = 8 + 8;
    McapFields fields = Content(kBeforeChecksum + 4);
    const std::uint64_t begin = fields.U64();
    fields.U64();  // of the summary's offsets
    const std::uint32_t crc = fields.U32();
    const std::uint64_t end = offset_ + McapRecord::kHeadSize + kBeforeChecksum;
    if (!fields.good() || begin == 0 || begin > offset_ || crc == 0) return;
    if (Checksum(begin, end) == crc) return;
    Damage("the summary fails its checksum");
    summary_ = {};
    stated_channels_.reset();
  }

  void TakeSummary() {
    McapChannels& channels = outline_.channels;
    channels.schemas.merge(summary_.schemas);
    channels.channels.merge(summary_.channels);
    const bool has_schemas = std::all_of(
        channels.channels.begin(), channels.channels.end(), [&channels](const auto& channel) {
          return channel.second.schema == 0 || channels.schemas.count(channel.second.schema) > 0;
        });
    outline_.knows_all_channels = ended_ && has_schemas && stated_channels_.value_or(0) > 0 &&
                                  channels.channels.size() >= *stated_channels_;
  }

  /// Where the reading can go on behind a record that makes no sense: the one thing that the
  /// indexes are good for. 0: nowhere.
  std::uint64_t NextIndexedChunk() {
    if (!indexed_chunks_) indexed_chunks_ = IndexedChunks();
    const auto next = std::upper_bound(indexed_chunks_->begin(), indexed_chunks_->end(), offset_);
    return next == indexed_chunks_->end() ? 0 : *next;
  }

  std::vector<std::uint64_t> IndexedChunks() {
    constexpr std::size_t kFooter = McapRecord::kHeadSize + 8 + 8 + 4;
    constexpr std::uint64_t kLargestSummary = std::uint64_t{64} << 20U;
    const std::uint64_t size = file_.size();
    std::vector<std::uint64_t> offsets;
    if (size < kFooter + 2 * kMcapMagic.size()) return offsets;
    const std::uint64_t footer = size - kMcapMagic.size() - kFooter;
    std::size_t found = 0;
    McapFields fields(file_.At(footer, kFooter, &found), kFooter);
    if (static_cast<McapOp>(fields.Number(1)) != McapOp::kFooter) return offsets;
    fields.U64();
    const std::uint64_t begin = fields.U64();
    if (begin == 0 || begin > footer || footer - begin > kLargestSummary) return offsets;
    Bytes summary;
    file_.Read(begin, static_cast<std::size_t>(footer - begin), &summary);
    McapRecords records(summary.data(), summary.size());
    while (const std::optional<McapRecord> record = records.Next()) {
      if (record->op != McapOp::kChunkIndex) continue;
      McapFields index(*record);
      index.Number(8 + 8);  // times
      const std::uint64_t chunk = index.U64();
      if (index.good() && chunk < begin) offsets.push_back(chunk);
    }
    std::sort(offsets.begin(), offsets.end());
    return offsets;
  }

  FileWindow& file_;
  McapOutline outline_;
  McapChannels summary_;
  std::optional<std::uint32_t> stated_channels_;
  std::optional<std::vector<std::uint64_t>> indexed_chunks_;
  std::uint64_t offset_ = 0;
  std::uint64_t size_ = 0;  ///< of the record's content
  bool is_cut_ = false;
  bool has_bare_messages_ = false;
  bool data_ended_ = false;
  bool ended_ = false;
};

}  // namespace

McapOutline OutlineMcap(FileWindow* file) { return Walk(file).Run(); }

}  // namespace masked_mapper
