// SPDX-License-Identifier: BSD-3-Clause
// A stream that can be read but once (a pipe, standard input), kept in a temporary file so that it
// can be read again. The file has no name any more once it is open: whatever ends the program, it
// leaves nothing behind.
#pragma once

#include <string>

namespace masked_mapper {

class Spool {
 public:
  /// Whether a path is such a stream.
  static bool IsStream(const std::string& path);

  /// Reads the stream to its end. Throws InputError: cannot be opened, no room for it.
  explicit Spool(const std::string& path);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Opens the kept bytes from their beginning, as often as need be, as long as this lives.
  const std::string& path() const { return path_; }

 private:
  int file_ = -1;
  std::string path_;
};

}  // namespace masked_mapper
