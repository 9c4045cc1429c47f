// SPDX-License-Identifier: BSD-3-Clause
// A regular file that is open to be read, and its size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace masked_mapper {

/// Its size is known when it is opened and holds: that the file has less is an error, too. All
/// throw InputError, under the name that is shown.
class RegularFile {
 public:
  RegularFile(const std::string& path, std::string shown_name);

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }

  void Seek(std::uint64_t position);
  /// All of the `count` bytes behind the position.
  void Read(unsigned char* to, std::size_t count);
  /// At most `count` bytes, none only at the end of the file.
  std::size_t ReadSome(unsigned char* to, std::size_t count);
  /// For who has a buffer.
  void LeaveUnbuffered() { std::setvbuf(stream_.get(), nullptr, _IONBF, 0); }

 private:
  [[noreturn]] void Fail() const;

  struct Closer {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  std::string name_;
  std::unique_ptr<std::FILE, Closer> stream_;
  std::uint64_t size_ = 0;
};

}  // namespace masked_mapper
