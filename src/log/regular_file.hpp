// SPDX-License-Identifier: BSD-3-Clause
// A regular file that is open to be read, and its size.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace masked_mapper {

struct RegularFile {
  /// Throws InputError, under the name that is shown, when there is none that can be read.
  RegularFile(const std::string& path, const std::string& shown_name);

  struct Closer {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  std::unique_ptr<std::FILE, Closer> stream;
  std::uint64_t size = 0;
};

}  // namespace masked_mapper
