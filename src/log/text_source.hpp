// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a file, plain or packed (gzip, bzip2, zstd) told apart by content. A damaged or cut
// packed stream gives its good part and says so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace masked_mapper {

class TextSource {
 public:
  /// Throws InputError: no such file, not a regular file, unreadable, named `.gz` without being
  /// gzip.
  explicit TextSource(const std::string& path);
  ~TextSource();

  /// Fills `buffer` as far as the file goes; fewer than `capacity` bytes only at its end.
  /// Throws InputError when the disk refuses.
  std::size_t Read(char* buffer, std::size_t capacity);

  bool IsPacked() const;
  /// The packed stream is cut or damaged; what came before has been handed out.
  bool Truncated() const;
  /// Bytes behind the last packed stream that are none, ignored.
  std::uint64_t TrailingBytes() const;
  /// Share of the file's own bytes consumed, 0 to 1.
  double Progress() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
