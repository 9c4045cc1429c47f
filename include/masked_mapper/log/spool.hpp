// SPDX-License-Identifier: BSD-3-Clause
// A stream that can be read but once (a pipe, standard input), kept in a temporary file so that it
// can be read again. The file has no name any more once it is open: whatever ends the program, it
// leaves nothing behind.
#pragma once

#include <string>
#include <string_view>

namespace masked_mapper {

class Spool {
 public:
  /// Whether a path is such a stream.
  static bool IsStream(const std::string& path);

  /// Nothing is kept yet; `name` is the stream's, as its user knows it. Throws InputError when
  /// there is no room for temporary files.
  explicit Spool(std::string name);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Behind what is kept so far. Throws InputError: no room for it.
  void Add(std::string_view bytes);
  /// Adds the stream at `path`, to its end. Throws InputError: cannot be opened, no room for it.
  void AddAllOf(const std::string& path);

  const std::string& name() const { return name_; }
  /// Opens the kept bytes from their beginning, as often as need be, as long as this lives.
  const std::string& path() const { return path_; }

 private:
  std::string name_;
  int file_ = -1;
  std::string path_;
};

}  // namespace masked_mapper
