// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_file.hpp"

#include <algorithm>
#include <vector>

#include "file_window.hpp"
#include "mcap_outline.hpp"
#include "mcap_records.hpp"

namespace masked_mapper {
namespace {

// Of segments that are read side by side. Beyond it the order suffers, which the mending of stamps
// makes good as far as it can, and memory does not.
constexpr std::size_t kMostOpenBytes = std::size_t{64} << 20U;
constexpr std::size_t kMostOpen = 64;

/// "sensor_msgs/msg/LaserScan", or what else it is in words: then it is counted, not read.
std::string TypeOf(const McapChannel& channel, const std::map<std::uint16_t, McapSchema>& schemas) {
  const auto schema = schemas.find(channel.schema);
  std::string name = schema == schemas.end() ? "no schema" : schema->second.name;
  const std::string& encoding = channel.message_encoding;
  if (encoding == "cdr" || encoding == "ros1") return name;
  return name + " as " + (encoding.empty() ? "something unsaid" : encoding);
}

/// A segment in memory.
struct OpenSegment {
  struct Entry {
    std::uint64_t time = 0;  ///< ns
    std::size_t begin = 0;   ///< of the data
    std::size_t size = 0;
    std::uint16_t channel = 0;
  };

  std::uint64_t offset = 0;  ///< in the file
  Bytes records;
  std::vector<Entry> messages;  ///< in order of time
  std::size_t next = 0;

  bool IsBefore(const OpenSegment& other) const {
    const std::uint64_t time = messages[next].time;
    const std::uint64_t other_time = other.messages[other.next].time;
    return time != other_time ? time < other_time : offset < other.offset;
  }
};

class McapFile final : public RosBag {
 public:
  McapFile(const std::string& path, const std::string& shown_name)
      : file_(path, shown_name), outline_(OutlineMcap(&file_)) {
    if (!outline_.knows_all_channels) FindChannels();
    for (const auto& [id, channel] : outline_.channels.channels) Connect(channel);
    for (const McapSegment& segment : outline_.segments) total_bytes_ += segment.size;
    Rewind();
  }

  std::optional<BagMessage> Next() override {
    while (true) {
      CloseFinished();
      OpenDue();
      if (open_.empty()) return std::nullopt;
      OpenSegment& first = **std::min_element(
          open_.begin(), open_.end(), [](const auto& a, const auto& b) { return a->IsBefore(*b); });
      const OpenSegment::Entry& entry = first.messages[first.next++];
      if (connections_.count(entry.channel) == 0) {
        Damage("a message on channel " + std::to_string(entry.channel) +
               ", which is not described");
        continue;
      }
      BagMessage message;
      message.connection = entry.channel;
      message.time = 1e-9 * static_cast<double>(entry.time);
      message.data = first.records.data() + entry.begin;
      message.size = entry.size;
      message.encoding = encodings_.at(entry.channel);
      return message;
    }
  }

  void Rewind() override {
    open_.clear();
    open_bytes_ = 0;
    next_segment_ = 0;
    read_bytes_ = 0;
    damaged_ = outline_.damaged;
    first_damage_ = outline_.first_damage;
  }

  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return true; }
  bool Truncated() const override { return outline_.truncated; }
  std::uint64_t Damaged() const override { return damaged_; }
  std::string FirstDamage() const override { return first_damage_; }
  double Progress() const override {
    if (next_segment_ == outline_.segments.size()) return 1.0;
    return static_cast<double>(read_bytes_) / static_cast<double>(total_bytes_);
  }

 private:
  void Damage(const std::string& what) {
    if (damaged_++ == 0) first_damage_ = what;
  }

  void Connect(const McapChannel& channel) {
    BagConnection connection;
    connection.topic = channel.topic;
    connection.type = TypeOf(channel, outline_.channels.schemas);
    connection.md5sum = channel.md5sum;
    connections_.emplace(channel.id, std::move(connection));
    encodings_.emplace(channel.id, channel.message_encoding == "ros1" ? MessageEncoding::kRos1
                                                                      : MessageEncoding::kCdr);
  }

  /// Topics are chosen before messages are read.
  void FindChannels() {
    Bytes bytes;
    for (const McapSegment& segment : outline_.segments) {
      if (!segment.is_chunk || !Load(segment, &bytes).empty()) continue;
      McapRecords records(bytes.data(), bytes.size());
      while (const std::optional<McapRecord> record = records.Next()) {
        outline_.channels.Add(*record);
      }
    }
  }

  /// The records of a segment; what is wrong with it, in words.
  std::string Load(const McapSegment& segment, Bytes* records) {
    if (!segment.is_chunk) {
      file_.Read(segment.offset, static_cast<std::size_t>(segment.size), records);
      return "";
    }
    std::size_t found = 0;
    constexpr std::size_t kFieldsSize = 512;
    const unsigned char* fields = file_.At(
        segment.offset,
        static_cast<std::size_t>(std::min<std::uint64_t>(kFieldsSize, segment.size)), &found);
    const std::optional<McapChunk> chunk = ParseMcapChunk(fields, found);
    if (!chunk) return "is malformed";
    const std::uint64_t here = std::min(chunk->packed_size, segment.size - chunk->fields_size);
    file_.Read(segment.offset + chunk->fields_size, static_cast<std::size_t>(here), &packed_);
    return unpacker_.Unpack(*chunk, segment.is_cut, &packed_, records);
  }

  void CloseFinished() {
    for (std::size_t i = open_.size(); i-- > 0;) {
      if (open_[i]->next < open_[i]->messages.size()) continue;
      open_bytes_ -= open_[i]->records.size();
      spare_ = std::move(open_[i]);
      open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (open_.empty()) open_bytes_ = 0;
  }

  /// Opens the segments that may hold the next message.
  void OpenDue() {
    while (next_segment_ < outline_.segments.size()) {
      const McapSegment& segment = outline_.segments[next_segment_];
      const bool is_due = std::all_of(open_.begin(), open_.end(), [&segment](const auto& open) {
        return segment.start_time <= open->messages[open->next].time;
      });
      const bool has_room = open_bytes_ < kMostOpenBytes && open_.size() < kMostOpen;
      if (!open_.empty() && !(is_due && has_room)) return;
      ++next_segment_;
      Open(segment);
    }
  }

  void Open(const McapSegment& segment) {
    std::unique_ptr<OpenSegment> open = std::move(spare_);
    if (!open) open = std::make_unique<OpenSegment>();
    open->offset = segment.offset;
    open->messages.clear();
    open->next = 0;
    read_bytes_ += segment.size;
    const std::string trouble = Load(segment, &open->records);
    if (!trouble.empty()) {
      Damage("the chunk at byte " + std::to_string(segment.offset) + " " + trouble);
      spare_ = std::move(open);
      return;
    }
    ListMessages(segment, open.get());
    if (open->messages.empty()) {
      spare_ = std::move(open);
      return;
    }
    open_bytes_ += open->records.size();
    open_.push_back(std::move(open));
  }

  void ListMessages(const McapSegment& segment, OpenSegment* open) {
    McapRecords records(open->records.data(), open->records.size());
    bool in_order = true;
    while (const std::optional<McapRecord> record = records.Next()) {
      if (record->op != McapOp::kMessage) continue;
      const std::optional<McapMessage> message = ParseMcapMessage(*record);
      if (!message) {
        Damage("a malformed message");
        continue;
      }
      std::vector<OpenSegment::Entry>& messages = open->messages;
      in_order = in_order && (messages.empty() || messages.back().time <= message->log_time);
      messages.push_back({message->log_time,
                          static_cast<std::size_t>(message->data - open->records.data()),
                          message->size, message->channel});
    }
    if (records.left() > 0 && !segment.is_cut) {
      Damage("the chunk at byte " + std::to_string(segment.offset) + " holds a record that is cut");
    }
    if (in_order) return;
    std::stable_sort(open->messages.begin(), open->messages.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
  }

  FileWindow file_;
  McapOutline outline_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::map<std::uint32_t, MessageEncoding> encodings_;
  McapUnpacker unpacker_;
  Bytes packed_;
  std::vector<std::unique_ptr<OpenSegment>> open_;
  std::unique_ptr<OpenSegment> spare_;  ///< for its memory
  std::size_t open_bytes_ = 0;
  std::size_t next_segment_ = 0;
  std::uint64_t read_bytes_ = 0;
  std::uint64_t total_bytes_ = 0;
  std::uint64_t damaged_ = 0;
  std::string first_damage_;
};

}  // namespace

std::unique_ptr<RosBag> OpenMcap(const std::string& path, const std::string& shown_name) {
  return std::make_unique<McapFile>(path, shown_name);
}

}  // namespace masked_mapper
