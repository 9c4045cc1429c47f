// SPDX-License-Identifier: BSD-3-Clause
// Unpacking a stream piece by piece: gzip, bzip2, zstd, and frames of lz4, each by its library.
// Memory grows with what a stream really holds, never with what its beginning promises.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace masked_mapper {

enum class Packing { kNone, kGzip, kBzip2, kZstd, kLz4 };

using Bytes = std::vector<unsigned char>;

/// A chunk of a bag is unpacked in memory. Recorders close one at 768 KiB to 4 MiB; one message of
/// many megabytes may make it longer.
inline constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20U;

/// By its first bytes.
Packing PackingOf(const unsigned char* data, std::size_t size);

/// The greatest factor by which a stream can grow: what claims more is not true.
double GreatestRatio(Packing packing);

class Unpacker {
 public:
  enum class State {
    kMore,    ///< goes on when it is given bytes, or room
    kEnd,     ///< of one gzip member, bzip2 stream or frame; Restart() begins the next
    kBroken,  ///< what was written is good, nothing follows
  };

  virtual ~Unpacker() = default;
  /// Takes bytes from the front of `*in`, and fills the front of `*out`; both are moved on.
  virtual State Unpack(const unsigned char** in, std::size_t* in_size, unsigned char** out,
                       std::size_t* out_size) = 0;
  virtual void Restart() = 0;
};

/// Throws std::bad_alloc when the library cannot start.
std::unique_ptr<Unpacker> MakeUnpacker(Packing packing);

/// One stream, at most `limit` bytes of it, into `out`; false when it is not whole: then `out` is
/// its good part.
bool UnpackAll(Unpacker* unpacker, const unsigned char* data, std::size_t size, std::size_t limit,
               Bytes* out);

}  // namespace masked_mapper
