// SPDX-License-Identifier: BSD-3-Clause
#include "bag_file.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "record_file.hpp"
#include "unpacking.hpp"

namespace masked_mapper {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V";
constexpr std::string_view kVersionLine = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLargestConnection = std::uint64_t{4} << 20U;
constexpr std::size_t kMostConnections = 10000;

enum Op : int {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// Seconds and nanoseconds of a field.
std::optional<double> TimeOf(std::string_view field) {
  if (field.size() != 8) return std::nullopt;
  const auto* bytes = reinterpret_cast<const unsigned char*>(field.data());
  return static_cast<double>(LittleEndian(bytes, 4)) +
         1e-9 * static_cast<double>(LittleEndian(bytes + 4, 4));
}

class BagFile final : public RosBag {
 public:
  BagFile(const std::string& path, const std::string& shown_name)
      : name_(shown_name), file_(path, shown_name) {
    CheckVersion();
    first_record_ = file_.position();
    ReadIndex();
    Rewind();
  }

  std::optional<BagMessage> Next() override {
    while (true) {
      if (chunk_position_ < chunk_.size()) {
        if (std::optional<BagMessage> message = NextInChunk()) return message;
      } else if (!at_end_) {
        if (std::optional<BagMessage> message = NextInFile()) return message;
      } else {
        return std::nullopt;
      }
    }
  }

  void Rewind() override {
    file_.Seek(first_record_);
    chunk_.clear();
    chunk_position_ = 0;
    at_end_ = false;
    truncated_ = !is_indexed_;
    damaged_ = 0;
  }

  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return is_indexed_; }
  std::optional<double> EndTime() const override {
    return is_indexed_ && end_time_ > 0.0 ? std::optional<double>(end_time_) : std::nullopt;
  }
  bool Truncated() const override { return truncated_; }
  std::uint64_t Damaged() const override { return damaged_; }
  double Progress() const override {
    return at_end_ ? 1.0
                   : static_cast<double>(file_.position()) / static_cast<double>(file_.size());
  }

 private:
  void CheckVersion() {
    Bytes line;
    file_.Read(std::min<std::uint64_t>(file_.size(), kVersionLine.size()), &line);
    const std::string_view text(reinterpret_cast<const char*>(line.data()), line.size());
    if (text == kVersionLine) return;
    if (text.substr(0, kMagic.size()) != kMagic) throw InputError(name_ + ": is not a ROS bag");
    const std::string version(text.substr(kMagic.size(), 3));
    throw InputError(name_ + ": is a ROS bag of version " + version +
                     ", which is obsolete; convert it to 2.0 with `rosbag fix`");
  }

  /// The connections stand together behind the chunks of a bag that was closed properly.
  void ReadIndex() {
    RecordHeader header;
    std::uint64_t data_size = 0;
    if (!file_.ReadHeader(&header, &data_size) || header.op() != kBagHeader) return;
    if (!header.Find("encryptor").empty()) {
      throw InputError(name_ + ": is an encrypted ROS bag, which cannot be read");
    }
    const std::uint64_t index = header.Number("index_pos", 8).value_or(0);
    const std::uint64_t connections = header.Number("conn_count", 4).value_or(0);
    const std::uint64_t chunks = header.Number("chunk_count", 4).value_or(0);
    if (index <= file_.position() || index >= file_.size()) return;
    file_.Seek(index);
    for (std::uint64_t i = 0; i < connections; ++i) {
      if (!file_.ReadHeader(&header, &data_size) || header.op() != kConnection ||
          !ReadConnection(header, data_size)) {
        return;
      }
    }
    for (std::uint64_t i = 0; i < chunks; ++i) {
      if (!file_.ReadHeader(&header, &data_size) || header.op() != kChunkInfo) return;
      chunk_positions_.insert(header.Number("chunk_pos", 8).value_or(0));
      end_time_ = std::max(end_time_, TimeOf(header.Find("end_time")).value_or(0.0));
      Skip(data_size);
    }
    is_indexed_ = true;
  }

  std::optional<BagMessage> NextInFile() {
    const std::uint64_t record = file_.position();
    RecordHeader header;
    std::uint64_t data_size = 0;
    if (file_.position() == file_.size()) {
      at_end_ = true;
    } else if (!file_.ReadHeader(&header, &data_size)) {
      ResumeBehind(record);
    } else if (header.op() == kChunk) {
      LoadChunk(header, data_size);
    } else if (header.op() == kConnection) {
      if (!ReadConnection(header, data_size)) ResumeBehind(record);
    } else if (header.op() == kMessage) {
      // Of a recorder that died before it closed its chunk.
      if (data_size > std::min(file_.left(), kLargestChunk)) {
        ResumeBehind(record);
        return std::nullopt;
      }
      file_.Read(data_size, &chunk_);
      chunk_position_ = chunk_.size();
      return Message(header, chunk_.data(), chunk_.size());
    } else if (header.op() == kIndex) {
      // The first recorders wrote 12 bytes per entry, but the length of 20.
      const bool is_version_1 = header.Number("ver", 4) == 1U;
      const std::uint64_t entries = header.Number("count", 4).value_or(0);
      Skip(is_version_1 ? 12 * entries : data_size);
    } else if (header.op() == kBagHeader || header.op() == kChunkInfo) {
      Skip(data_size);
    } else {
      ResumeBehind(record);
    }
    return std::nullopt;
  }

  /// A record makes no sense, so that where the next one begins is unknown: the next chunk of the
  /// index is.
  void ResumeBehind(std::uint64_t record) {
    truncated_ = true;
    const auto next = chunk_positions_.upper_bound(record);
    if (next == chunk_positions_.end() || *next >= file_.size()) {
      at_end_ = true;
    } else {
      ++damaged_;
      file_.Seek(*next);
    }
  }

  std::optional<BagMessage> NextInChunk() {
    const unsigned char* const data = chunk_.data();
    const std::size_t size = chunk_.size();
    std::size_t at = chunk_position_;
    RecordHeader header;
    std::size_t data_size = 0;
    const auto take_length = [&](std::size_t* length) {
      if (size - at < 4) return false;
      *length = LittleEndian(data + at, 4);
      at += 4;
      return *length <= size - at;
    };
    std::size_t header_size = 0;
    bool good = take_length(&header_size) && header.Parse(data + at, header_size);
    if (good) {
      at += header_size;
      good = take_length(&data_size);
    }
    if (!good) {
      if (!chunk_is_cut_) ++damaged_;
      chunk_position_ = size;
      return std::nullopt;
    }
    chunk_position_ = at + data_size;
    if (header.op() == kConnection) AddConnection(header, data + at, data_size);
    if (header.op() != kMessage) return std::nullopt;
    return Message(header, data + at, data_size);
  }

  std::optional<BagMessage> Message(const RecordHeader& header, const unsigned char* data,
                                    std::size_t size) {
    const auto connection = header.Number("conn", 4);
    const std::optional<double> time = TimeOf(header.Find("time"));
    if (!connection || !time || connections_.count(static_cast<std::uint32_t>(*connection)) == 0) {
      ++damaged_;
      return std::nullopt;
    }
    return BagMessage{static_cast<std::uint32_t>(*connection), *time, data, size};
  }

  void LoadChunk(const RecordHeader& header, std::uint64_t data_size) {
    const std::string compression(header.Find("compression"));
    const std::uint64_t full_size = header.Number("size", 4).value_or(0);
    chunk_is_cut_ = data_size > file_.left();
    if (chunk_is_cut_) {
      truncated_ = true;
      data_size = file_.left();
    }
    chunk_.clear();
    chunk_position_ = 0;
    if (data_size > kLargestChunk || full_size > kLargestChunk) {
      ++damaged_;
      Skip(data_size);
      return;
    }
    if (compression == "none") {
      file_.Read(data_size, &chunk_);
      return;
    }
    file_.Read(data_size, &packed_);
    const bool whole = Unpack(compression, full_size);
    if (!whole && !chunk_is_cut_) ++damaged_;
    chunk_is_cut_ = chunk_is_cut_ || !whole;  // counted once
  }

  bool Unpack(const std::string& compression, std::uint64_t full_size) {
    if (compression != "bz2" && compression != "lz4") return false;
    std::unique_ptr<Unpacker>& unpacker = unpackers_[compression];
    if (!unpacker) {
      unpacker = MakeUnpacker(compression == "bz2" ? Packing::kBzip2 : Packing::kLz4);
    }
    return UnpackAll(unpacker.get(), packed_.data(), packed_.size(), full_size, &chunk_);
  }

  bool ReadConnection(const RecordHeader& header, std::uint64_t data_size) {
    if (data_size > file_.left()) return false;
    if (data_size > kLargestConnection) {
      ++damaged_;
      Skip(data_size);
      return true;
    }
    // The fields of `header` stay while data is read.
    file_.Read(data_size, &packed_);
    AddConnection(header, packed_.data(), packed_.size());
    return true;
  }

  void AddConnection(const RecordHeader& header, const unsigned char* data, std::size_t size) {
    const auto id = header.Number("conn", 4);
    RecordHeader fields;
    if (!id || !fields.Parse(data, size)) {
      ++damaged_;
      return;
    }
    if (connections_.size() >= kMostConnections) return;
    BagConnection connection;
    connection.topic = header.Find("topic");
    connection.type = fields.Find("type");
    connection.md5sum = fields.Find("md5sum");
    connections_.emplace(static_cast<std::uint32_t>(*id), std::move(connection));
  }

  void Skip(std::uint64_t count) { truncated_ = !file_.Skip(count) || truncated_; }

  std::string name_;
  RecordFile file_;
  std::uint64_t first_record_ = 0;
  std::set<std::uint64_t> chunk_positions_;
  std::map<std::uint32_t, BagConnection> connections_;
  bool is_indexed_ = false;
  double end_time_ = 0.0;  ///< s
  bool at_end_ = false;
  bool truncated_ = false;
  std::uint64_t damaged_ = 0;
  Bytes packed_;
  std::map<std::string, std::unique_ptr<Unpacker>> unpackers_;  ///< by the name of compression
  Bytes chunk_;
  std::size_t chunk_position_ = 0;
  bool chunk_is_cut_ = false;
};

}  // namespace

std::unique_ptr<RosBag> OpenRos1Bag(const std::string& path, const std::string& shown_name) {
  return std::make_unique<BagFile>(path, shown_name);
}

}  // namespace masked_mapper
