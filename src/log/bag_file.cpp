// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/bag_file.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <string_view>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V";
constexpr std::string_view kVersionLine = "#ROSBAG V2.0\n";
constexpr std::uint32_t kLargestHeader = 1U << 20U;
// Recorders close a chunk at 768 kB; one message of many megabytes may make it longer.
constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20U;
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

using Bytes = std::vector<unsigned char>;

std::uint64_t LittleEndian(const unsigned char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = (value << 8U) | bytes[i];
  return value;
}

/// The header of a record: fields `name=value`, each with its length before it.
class RecordHeader {
 public:
  /// False when the lengths do not add up.
  bool Parse(const unsigned char* data, std::size_t size) {
    data_ = data;
    size_ = size;
    std::size_t at = 0;
    while (at < size) {
      if (size - at < 4) return false;
      const std::size_t length = LittleEndian(data + at, 4);
      at += 4;
      if (length > size - at || std::memchr(data + at, '=', length) == nullptr) return false;
      at += length;
    }
    return true;
  }

  /// The value of a field; empty when there is none.
  std::string_view Find(std::string_view name) const {
    std::size_t at = 0;
    while (at < size_) {
      const std::size_t length = LittleEndian(data_ + at, 4);
      const std::string_view field(reinterpret_cast<const char*>(data_ + at + 4), length);
      const std::size_t equals = field.find('=');
      if (field.substr(0, equals) == name) return field.substr(equals + 1);
      at += 4 + length;
    }
    return {};
  }

  /// A number of exactly `size` bytes.
  std::optional<std::uint64_t> Number(std::string_view name, std::size_t size) const {
    const std::string_view value = Find(name);
    if (value.size() != size) return std::nullopt;
    return LittleEndian(reinterpret_cast<const unsigned char*>(value.data()), size);
  }

  int op() const { return static_cast<int>(Number("op", 1).value_or(0)); }

 private:
  const unsigned char* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Grows `out` to hold what a decompressor may write next: at most `limit` in all.
void Grow(std::size_t used, std::size_t limit, Bytes* out) {
  if (used == out->size()) out->resize(std::min(limit, std::max<std::size_t>(1U << 16U, 2 * used)));
}

/// Both give the good part of a damaged stream, and whether it was whole. Memory grows with what
/// the stream really holds, not with what its header promises.
bool DecompressBz2(const Bytes& packed, std::size_t limit, Bytes* out) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(packed.data()));
  stream.avail_in = static_cast<unsigned>(packed.size());
  out->clear();
  std::size_t used = 0;
  int status = BZ_OK;
  while (status == BZ_OK && used < limit) {
    Grow(used, limit, out);
    const auto room = static_cast<unsigned>(out->size() - used);
    const unsigned in_before = stream.avail_in;
    stream.next_out = reinterpret_cast<char*>(out->data() + used);
    stream.avail_out = room;
    status = BZ2_bzDecompress(&stream);
    used += room - stream.avail_out;
    if (stream.avail_out == room && stream.avail_in == in_before) break;
  }
  BZ2_bzDecompressEnd(&stream);
  out->resize(used);
  return status == BZ_STREAM_END || used == limit;
}

bool DecompressLz4(const Bytes& packed, std::size_t limit, Bytes* out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      context, &LZ4F_freeDecompressionContext);
  out->clear();
  std::size_t used = 0;
  std::size_t consumed = 0;
  bool whole = false;
  while (used < limit) {
    Grow(used, limit, out);
    std::size_t in_size = packed.size() - consumed;
    std::size_t out_size = out->size() - used;
    const std::size_t status = LZ4F_decompress(context, out->data() + used, &out_size,
                                               packed.data() + consumed, &in_size, nullptr);
    if (LZ4F_isError(status) != 0) break;
    consumed += in_size;
    used += out_size;
    whole = status == 0;
    if (whole || (in_size == 0 && out_size == 0)) break;
  }
  out->resize(used);
  return whole || used == limit;
}

}  // namespace

class BagFile::Impl {
 public:
  explicit Impl(const std::string& path) : path_(path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
      throw InputError(path + ": is no file that can be read");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) throw InputError(path + ": " + std::strerror(errno));
    CheckVersion();
    first_record_ = position_;
    ReadIndex();
    Rewind();
  }

  std::optional<BagMessage> Next() {
    while (true) {
      if (chunk_position_ < chunk_.size()) {
        if (const std::optional<BagMessage> message = NextInChunk()) return message;
      } else if (!at_end_) {
        if (const std::optional<BagMessage> message = NextInFile()) return message;
      } else {
        return std::nullopt;
      }
    }
  }

  void Rewind() {
    Seek(first_record_);
    chunk_.clear();
    chunk_position_ = 0;
    at_end_ = false;
    truncated_ = !is_indexed_;
    damaged_ = 0;
  }

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  bool is_indexed() const { return is_indexed_; }
  bool truncated() const { return truncated_; }
  std::uint64_t damaged() const { return damaged_; }
  double Progress() const {
    return at_end_ ? 1.0 : static_cast<double>(position_) / static_cast<double>(size_);
  }

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void CheckVersion() {
    Bytes line;
    Read(std::min<std::uint64_t>(size_, kVersionLine.size()), &line);
    const std::string_view text(reinterpret_cast<const char*>(line.data()), line.size());
    if (text == kVersionLine) return;
    if (text.substr(0, kMagic.size()) != kMagic) throw InputError(path_ + ": is not a ROS bag");
    const std::string version(text.substr(kMagic.size(), 3));
    throw InputError(path_ + ": is a ROS bag of version " + version +
                     ", which is obsolete; convert it to 2.0 with `rosbag fix`");
  }

  /// The connections stand together behind the chunks of a bag that was closed properly.
  void ReadIndex() {
    RecordHeader header;
    std::uint64_t data_size = 0;
    if (!ReadHeader(&header, &data_size) || header.op() != kBagHeader) return;
    if (!header.Find("encryptor").empty()) {
      throw InputError(path_ + ": is an encrypted ROS bag, which cannot be read");
    }
    const std::uint64_t index = header.Number("index_pos", 8).value_or(0);
    const std::uint64_t connections = header.Number("conn_count", 4).value_or(0);
    const std::uint64_t chunks = header.Number("chunk_count", 4).value_or(0);
    if (index <= position_ || index >= size_) return;
    Seek(index);
    for (std::uint64_t i = 0; i < connections; ++i) {
      if (!ReadHeader(&header, &data_size) || header.op() != kConnection ||
          !ReadConnection(header, data_size)) {
        return;
      }
    }
    for (std::uint64_t i = 0; i < chunks; ++i) {
      if (!ReadHeader(&header, &data_size) || header.op() != kChunkInfo) return;
      chunk_positions_.insert(header.Number("chunk_pos", 8).value_or(0));
      Skip(data_size);
    }
    is_indexed_ = true;
  }

  std::optional<BagMessage> NextInFile() {
    const std::uint64_t record = position_;
    RecordHeader header;
    std::uint64_t data_size = 0;
    if (position_ == size_) {
      at_end_ = true;
    } else if (!ReadHeader(&header, &data_size)) {
      ResumeBehind(record);
    } else if (header.op() == kChunk) {
      LoadChunk(header, data_size);
    } else if (header.op() == kConnection) {
      if (!ReadConnection(header, data_size)) ResumeBehind(record);
    } else if (header.op() == kMessage) {
      // Of a recorder that died before it closed its chunk.
      if (data_size > std::min(size_ - position_, kLargestChunk)) {
        ResumeBehind(record);
        return std::nullopt;
      }
      Read(data_size, &chunk_);
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
    if (next == chunk_positions_.end() || *next >= size_) {
      at_end_ = true;
    } else {
      ++damaged_;
      Seek(*next);
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
    const std::string_view time = header.Find("time");
    if (!connection || time.size() != 8 ||
        connections_.count(static_cast<std::uint32_t>(*connection)) == 0) {
      ++damaged_;
      return std::nullopt;
    }
    const auto* bytes = reinterpret_cast<const unsigned char*>(time.data());
    BagMessage message;
    message.connection = static_cast<std::uint32_t>(*connection);
    message.time = static_cast<double>(LittleEndian(bytes, 4)) +
                   1e-9 * static_cast<double>(LittleEndian(bytes + 4, 4));
    message.data = data;
    message.size = size;
    return message;
  }

  void LoadChunk(const RecordHeader& header, std::uint64_t data_size) {
    const std::string compression(header.Find("compression"));
    const std::uint64_t full_size = header.Number("size", 4).value_or(0);
    chunk_is_cut_ = data_size > size_ - position_;
    if (chunk_is_cut_) {
      truncated_ = true;
      data_size = size_ - position_;
    }
    chunk_.clear();
    chunk_position_ = 0;
    if (data_size > kLargestChunk || full_size > kLargestChunk) {
      ++damaged_;
      Skip(data_size);
      return;
    }
    if (compression == "none") {
      Read(data_size, &chunk_);
      return;
    }
    Read(data_size, &packed_);
    bool whole = false;
    if (compression == "bz2") whole = DecompressBz2(packed_, full_size, &chunk_);
    if (compression == "lz4") whole = DecompressLz4(packed_, full_size, &chunk_);
    if (!whole && !chunk_is_cut_) ++damaged_;
    chunk_is_cut_ = chunk_is_cut_ || !whole;  // counted once
  }

  bool ReadConnection(const RecordHeader& header, std::uint64_t data_size) {
    if (data_size > size_ - position_) return false;
    if (data_size > kLargestConnection) {
      ++damaged_;
      Skip(data_size);
      return true;
    }
    // The fields of `header` live in header_bytes_, which Read() leaves alone.
    Read(data_size, &packed_);
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

  /// The header of the record at the position, and the length of its data, whose first byte is then
  /// the position.
  bool ReadHeader(RecordHeader* header, std::uint64_t* data_size) {
    std::uint64_t header_size = 0;
    if (!ReadLength(&header_size)) return false;
    if (header_size > std::min<std::uint64_t>(kLargestHeader, size_ - position_)) return false;
    Read(header_size, &header_bytes_);
    return header->Parse(header_bytes_.data(), header_bytes_.size()) && ReadLength(data_size);
  }

  bool ReadLength(std::uint64_t* length) {
    unsigned char bytes[4];
    if (size_ - position_ < 4 || std::fread(bytes, 1, 4, file_.get()) != 4) return false;
    position_ += 4;
    *length = LittleEndian(bytes, 4);
    return true;
  }

  /// `count` is at most what the file still has.
  void Read(std::uint64_t count, Bytes* bytes) {
    bytes->resize(count);
    if (std::fread(bytes->data(), 1, count, file_.get()) != count) {
      throw InputError(path_ + ": cannot be read");
    }
    position_ += count;
  }

  void Skip(std::uint64_t count) {
    if (count > size_ - position_) {
      truncated_ = true;
      count = size_ - position_;
    }
    Seek(position_ + count);
  }

  void Seek(std::uint64_t position) {
    if (::fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) {
      throw InputError(path_ + ": cannot be read");
    }
    position_ = position;
  }

  std::string path_;
  std::unique_ptr<std::FILE, FileCloser> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t first_record_ = 0;
  std::set<std::uint64_t> chunk_positions_;
  std::map<std::uint32_t, BagConnection> connections_;
  bool is_indexed_ = false;
  bool at_end_ = false;
  bool truncated_ = false;
  std::uint64_t damaged_ = 0;
  Bytes header_bytes_;
  Bytes packed_;
  Bytes chunk_;
  std::size_t chunk_position_ = 0;
  bool chunk_is_cut_ = false;
};

bool BagFile::IsBag(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  char beginning[kMagic.size()];
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  const std::size_t count = std::fread(beginning, 1, sizeof(beginning), file);
  std::fclose(file);
  return std::string_view(beginning, count) == kMagic;
}

BagFile::BagFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
BagFile::~BagFile() = default;

std::optional<BagMessage> BagFile::Next() { return impl_->Next(); }
void BagFile::Rewind() { impl_->Rewind(); }
const std::map<std::uint32_t, BagConnection>& BagFile::Connections() const {
  return impl_->connections();
}
bool BagFile::IsIndexed() const { return impl_->is_indexed(); }
bool BagFile::Truncated() const { return impl_->truncated(); }
std::uint64_t BagFile::Damaged() const { return impl_->damaged(); }
double BagFile::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
