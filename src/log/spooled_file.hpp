// SPDX-License-Identifier: BSD-3-Clause
// A packed file, unpacked into a temporary one. Bags are read from more than one place, which a
// packed stream does not allow, and may be larger than memory. The temporary file goes with the
// object; who has opened it before may go on reading it.
#pragma once

#include <string>

namespace masked_mapper {

class SpooledFile {
 public:
  /// Throws InputError: unreadable, no room for it, or more than any recording would unpack to.
  explicit SpooledFile(const std::string& path);
  ~SpooledFile();
  SpooledFile(const SpooledFile&) = delete;
  SpooledFile& operator=(const SpooledFile&) = delete;

  const std::string& path() const { return path_; }
  /// The packed file is cut or damaged: this is its good part.
  bool truncated() const { return truncated_; }

 private:
  std::string path_;
  bool truncated_ = false;
};

}  // namespace masked_mapper
