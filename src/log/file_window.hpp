// SPDX-License-Identifier: BSD-3-Clause
// Bytes of a file at any place, from a window that moves along.
#pragma once

#include <cstdint>
#include <string>

#include "regular_file.hpp"
#include "unpacking.hpp"

namespace masked_mapper {

class FileWindow {
 public:
  /// Throws InputError when the file cannot be read.
  explicit FileWindow(const std::string& path, std::string shown_name);

  std::uint64_t size() const { return file_.size(); }
  const std::string& name() const { return file_.name(); }
  /// At most `count` bytes, as many as the file has there; valid until the next call.
  const unsigned char* At(std::uint64_t offset, std::size_t count, std::size_t* found);
  /// `count` bytes that the file has.
  void Read(std::uint64_t offset, std::size_t count, Bytes* bytes);

 private:
  void Fill(std::uint64_t offset, unsigned char* to, std::size_t count);

  RegularFile file_;
  Bytes window_;
  std::uint64_t window_begin_ = 0;
};

}  // namespace masked_mapper
