// SPDX-License-Identifier: BSD-3-Clause
#include "regular_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

RegularFile::RegularFile(const std::string& path, const std::string& shown_name) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw InputError(shown_name + ": is no file that can be read");
  }
  size = static_cast<std::uint64_t>(status.st_size);
  stream.reset(std::fopen(path.c_str(), "rb"));
  if (!stream) throw InputError(shown_name + ": " + std::strerror(errno));
}

}  // namespace masked_mapper
