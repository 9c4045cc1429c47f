// SPDX-License-Identifier: BSD-3-Clause
#include "unpacking.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <new>

namespace masked_mapper {
namespace {

/// zlib and bzip2 count in `unsigned`.
unsigned InOneStep(std::size_t size) {
  return static_cast<unsigned>(std::min<std::size_t>(size, std::size_t{1} << 30U));
}

class GzipUnpacker final : public Unpacker {
 public:
  GzipUnpacker() {
    // 16 + 15: a gzip header is demanded, and the largest window allowed.
    if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  ~GzipUnpacker() override { inflateEnd(&stream_); }
  GzipUnpacker(const GzipUnpacker&) = delete;
  GzipUnpacker& operator=(const GzipUnpacker&) = delete;

  State Unpack(const unsigned char** in, std::size_t* in_size, unsigned char** out,
               std::size_t* out_size) override {
    const unsigned in_before = InOneStep(*in_size);
    const unsigned out_before = InOneStep(*out_size);
    stream_.next_in = const_cast<unsigned char*>(*in);
    stream_.avail_in = in_before;
    stream_.next_out = *out;
    stream_.avail_out = out_before;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    *in_size -= in_before - stream_.avail_in;
    *out_size -= out_before - stream_.avail_out;
    *in = stream_.next_in;
    *out = stream_.next_out;
    if (status == Z_STREAM_END) return State::kEnd;
    return status == Z_OK || status == Z_BUF_ERROR ? State::kMore : State::kBroken;
  }
  void Restart() override { inflateReset(&stream_); }

 private:
  z_stream stream_{};
};

class Bzip2Unpacker final : public Unpacker {
 public:
  Bzip2Unpacker() { Begin(); }
  ~Bzip2Unpacker() override { BZ2_bzDecompressEnd(&stream_); }
  Bzip2Unpacker(const Bzip2Unpacker&) = delete;
  Bzip2Unpacker& operator=(const Bzip2Unpacker&) = delete;

  State Unpack(const unsigned char** in, std::size_t* in_size, unsigned char** out,
               std::size_t* out_size) override {
    const unsigned in_before = InOneStep(*in_size);
    const unsigned out_before = InOneStep(*out_size);
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(*in));
    stream_.avail_in = in_before;
    stream_.next_out = reinterpret_cast<char*>(*out);
    stream_.avail_out = out_before;
    const int status = BZ2_bzDecompress(&stream_);
    const std::size_t taken = in_before - stream_.avail_in;
    const std::size_t given = out_before - stream_.avail_out;
    *in += taken;
    *in_size -= taken;
    *out += given;
    *out_size -= given;
    if (status == BZ_STREAM_END) return State::kEnd;
    return status == BZ_OK ? State::kMore : State::kBroken;
  }
  void Restart() override {
    BZ2_bzDecompressEnd(&stream_);
    Begin();
  }

 private:
  void Begin() {
    stream_ = {};
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }

  bz_stream stream_{};
};

class ZstdUnpacker final : public Unpacker {
 public:
  ZstdUnpacker() : stream_(ZSTD_createDStream(), &ZSTD_freeDStream) {
    if (!stream_) throw std::bad_alloc();
    Restart();
  }

  State Unpack(const unsigned char** in, std::size_t* in_size, unsigned char** out,
               std::size_t* out_size) override {
    ZSTD_inBuffer from{*in, *in_size, 0};
    ZSTD_outBuffer to{*out, *out_size, 0};
    const std::size_t status = ZSTD_decompressStream(stream_.get(), &to, &from);
    *in += from.pos;
    *in_size -= from.pos;
    *out += to.pos;
    *out_size -= to.pos;
    if (ZSTD_isError(status) != 0) return State::kBroken;
    return status == 0 ? State::kEnd : State::kMore;
  }
  void Restart() override { ZSTD_DCtx_reset(stream_.get(), ZSTD_reset_session_only); }

 private:
  std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream_;
};

class Lz4Unpacker final : public Unpacker {
 public:
  Lz4Unpacker() {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) {
      throw std::bad_alloc();
    }
    context_.reset(context);
  }

  State Unpack(const unsigned char** in, std::size_t* in_size, unsigned char** out,
               std::size_t* out_size) override {
    std::size_t taken = *in_size;
    std::size_t given = *out_size;
    const std::size_t status = LZ4F_decompress(context_.get(), *out, &given, *in, &taken, nullptr);
    if (LZ4F_isError(status) != 0) return State::kBroken;
    *in += taken;
    *in_size -= taken;
    *out += given;
    *out_size -= given;
    return status == 0 ? State::kEnd : State::kMore;
  }
  void Restart() override { LZ4F_resetDecompressionContext(context_.get()); }

 private:
  struct FreeContext {
    void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
  };
  std::unique_ptr<LZ4F_dctx, FreeContext> context_;
};

}  // namespace

Packing PackingOf(const unsigned char* data, std::size_t size) {
  if (size >= 2 && data[0] == 0x1f && data[1] == 0x8b) return Packing::kGzip;
  // Behind "BZh" and the level stands the magic of a block, or of an empty stream's end.
  if (size >= 5 && data[0] == 'B' && data[1] == 'Z' && data[2] == 'h' && data[3] >= '1' &&
      data[3] <= '9' && (data[4] == 0x31 || data[4] == 0x17)) {
    return Packing::kBzip2;
  }
  if (size < 4) return Packing::kNone;
  if (data[0] == 0x28 && data[1] == 0xb5 && data[2] == 0x2f && data[3] == 0xfd) {
    return Packing::kZstd;
  }
  // A frame to be skipped, with which what was packed in parallel begins.
  if ((data[0] & 0xf0U) == 0x50 && data[1] == 0x2a && data[2] == 0x4d && data[3] == 0x18) {
    return Packing::kZstd;
  }
  if (data[0] == 0x04 && data[1] == 0x22 && data[2] == 0x4d && data[3] == 0x18) {
    return Packing::kLz4;
  }
  return Packing::kNone;
}

double GreatestRatio(Packing packing) {
  switch (packing) {
    case Packing::kNone:
      return 1.0;
    case Packing::kGzip:
      return 1033.0;  // 258 bytes of two bits
    case Packing::kLz4:
      return 256.0;  // a match grows by 255 with each byte
    case Packing::kZstd:
      return 65536.0;  // a block of 128 KiB of one byte takes four
    case Packing::kBzip2:
      break;
  }
  return 2e6;  // runs are counted first, so that a block of 45 MB may take 40 bytes
}

std::unique_ptr<Unpacker> MakeUnpacker(Packing packing) {
  switch (packing) {
    case Packing::kGzip:
      return std::make_unique<GzipUnpacker>();
    case Packing::kBzip2:
      return std::make_unique<Bzip2Unpacker>();
    case Packing::kZstd:
      return std::make_unique<ZstdUnpacker>();
    case Packing::kLz4:
      return std::make_unique<Lz4Unpacker>();
    case Packing::kNone:
      break;
  }
  return nullptr;
}

bool UnpackAll(Unpacker* unpacker, const unsigned char* data, std::size_t size, std::size_t limit,
               Bytes* out) {
  constexpr std::size_t kFirstRoom = std::size_t{1} << 16U;
  constexpr std::size_t kUsualRatio = 8;
  unpacker->Restart();
  // Where all of a frame has room, zstd writes it there at once; else all is copied once more.
  const std::size_t usual = kUsualRatio * std::min(size, limit);
  out->resize(std::max(out->size(), std::min(limit, std::max(kFirstRoom, usual))));
  std::size_t used = 0;
  Unpacker::State state = Unpacker::State::kMore;
  while (state == Unpacker::State::kMore && used < limit) {
    // Also what the buffer had from the last stream is room.
    if (used >= out->size()) out->resize(std::min(limit, std::max(kFirstRoom, 2 * used)));
    unsigned char* to = out->data() + used;
    std::size_t room = std::min(limit, out->size()) - used;
    const std::size_t room_before = room;
    const std::size_t size_before = size;
    state = unpacker->Unpack(&data, &size, &to, &room);
    used += room_before - room;
    if (room == room_before && size == size_before) break;
  }
  out->resize(used);
  return state == Unpacker::State::kEnd || (state == Unpacker::State::kMore && used == limit);
}

}  // namespace masked_mapper
