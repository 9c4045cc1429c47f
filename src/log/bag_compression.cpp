// SPDX-License-Identifier: BSD-3-Clause
#include "bag_compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>
#include <new>

namespace masked_mapper {
namespace {

using Bytes = std::vector<unsigned char>;

/// Grows `out` to hold what a decompressor may write next: at most `limit` in all.
void Grow(std::size_t used, std::size_t limit, Bytes* out) {
  if (used == out->size()) out->resize(std::min(limit, std::max<std::size_t>(1U << 16U, 2 * used)));
}

}  // namespace

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

}  // namespace masked_mapper
