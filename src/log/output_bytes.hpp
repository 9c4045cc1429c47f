// SPDX-License-Identifier: BSD-3-Clause
// A binary file as it is written, and the numbers in it: little-endian, as in both kinds of bag.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace masked_mapper {

class OutputBytes {
 public:
  /// Throws std::runtime_error, as all below.
  explicit OutputBytes(const std::string& path);

  void Write(std::string_view bytes);
  /// Over what was written before.
  void WriteAt(std::uint64_t position, std::string_view bytes);
  std::uint64_t position() const { return position_; }
  /// CRC-32 of all that was written in order.
  std::uint32_t checksum() const { return checksum_; }
  void Close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void Fail() const;

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::uint64_t position_ = 0;
  std::uint32_t checksum_ = 0;
};

/// The value's bytes at the end of `*bytes`.
template <typename T>
void AppendNumber(T value, std::string* bytes) {
  // ROS is little-endian, and so is every machine that this is built for.
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// With their length before them.
void AppendString(std::string_view text, std::string* bytes);

}  // namespace masked_mapper
